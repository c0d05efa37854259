// SPDX-License-Identifier: MIT
// Points of a PLY file.
#include "tools/eval/ply_cloud.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <limits>

#include "tools/common/voxel_grid.hpp"
#include "tools/eval/trajectory.hpp"

namespace unisim::eval {
namespace {

constexpr int64_t kMaxVertices = std::numeric_limits<int32_t>::max();  // rows of an OpenCV matrix

enum class Encoding { kUnknown, kAscii, kLittle, kBig };

struct Property {
  char kind;  // f: float, u: unsigned, i: signed
  size_t bytes;
};

struct Header {
  Encoding encoding = Encoding::kUnknown;
  int64_t vertices = -1;
  std::vector<Property> properties;
  int axis[3] = {-1, -1, -1};  // which property is x, y, z
};

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw InputError(path + ": " + reason + ": give a PLY file with vertices x y z");
}

Property property_of(const std::string& type, const std::string& path) {
  struct Known {
    const char* name;
    const char* alias;
    Property property;
  };
  constexpr Known kKnown[] = {
      {"char", "int8", {'i', 1}},     {"uchar", "uint8", {'u', 1}},    {"short", "int16", {'i', 2}},
      {"ushort", "uint16", {'u', 2}}, {"int", "int32", {'i', 4}},      {"uint", "uint32", {'u', 4}},
      {"float", "float32", {'f', 4}}, {"double", "float64", {'f', 8}},
  };
  for (const Known& known : kKnown) {
    if (type == known.name || type == known.alias) return known.property;
  }
  refuse(path, "vertex property of type '" + type + "'");
}

Encoding encoding_of(const std::string& word) {
  if (word == "ascii") return Encoding::kAscii;
  if (word == "binary_little_endian") return Encoding::kLittle;
  return word == "binary_big_endian" ? Encoding::kBig : Encoding::kUnknown;
}

int64_t vertex_count(std::string_view text, const std::string& path) {
  int64_t count = -1;
  const char* end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, count);
  if (result.ec != std::errc() || result.ptr != end || count < 0 || count > kMaxVertices) {
    refuse(path, "'" + std::string(text) + "' vertices are not a whole number from 0 to " +
                     std::to_string(kMaxVertices));
  }
  return count;
}

void add_property(const std::vector<std::string_view>& words, const std::string& path,
                  Header* header) {
  if (words.size() != 3) refuse(path, "a list among the vertex properties");
  const size_t axis = std::string_view("xyz").find(words[2]);
  if (words[2].size() == 1 && axis < 3)
    header->axis[axis] = static_cast<int>(header->properties.size());
  header->properties.push_back(property_of(std::string(words[1]), path));
}

Header read_header(std::istream& file, const std::string& path) {
  Header header;
  std::string line;
  bool in_vertices = false;
  bool ended = false;
  if (!std::getline(file, line) || line.rfind("ply", 0) != 0) refuse(path, "not a PLY file");
  while (!ended && std::getline(file, line)) {
    const auto words = sequence::split_fields(line);
    if (words.empty()) continue;
    ended = words[0] == "end_header";
    if (words[0] == "format" && words.size() >= 2)
      header.encoding = encoding_of(std::string(words[1]));
    if (words[0] == "element" && words.size() == 3) {
      in_vertices = words[1] == "vertex";
      if (header.vertices < 0 && !in_vertices) refuse(path, "vertices are not the first element");
      if (in_vertices) header.vertices = vertex_count(words[2], path);
    }
    if (words[0] == "property" && in_vertices) add_property(words, path, &header);
  }
  const bool has_axes =
      std::all_of(header.axis, header.axis + 3, [](int axis) { return axis >= 0; });
  if (!ended || header.encoding == Encoding::kUnknown || header.vertices < 0 || !has_axes) {
    refuse(path, "its header is not complete");
  }
  return header;
}

template <typename T>
double value_as(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

// Bytes are in this machine's order, little-endian on all we build for.
double decode(const Property& property, const unsigned char* bytes) {
  if (property.kind == 'f')
    return property.bytes == 4 ? value_as<float>(bytes) : value_as<double>(bytes);
  const bool is_signed = property.kind == 'i';
  switch (property.bytes) {
    case 1:
      return is_signed ? value_as<int8_t>(bytes) : value_as<uint8_t>(bytes);
    case 2:
      return is_signed ? value_as<int16_t>(bytes) : value_as<uint16_t>(bytes);
    default:
      return is_signed ? value_as<int32_t>(bytes) : value_as<uint32_t>(bytes);
  }
}

bool read_ascii_vertex(std::istream& file, const Header& header, Eigen::Vector3d* point) {
  std::string line;
  std::vector<std::string_view> fields;
  while (fields.empty() && std::getline(file, line)) fields = sequence::split_fields(line);
  if (fields.size() < header.properties.size()) return false;
  for (int i = 0; i < 3; ++i) {
    if (!sequence::parse_number(fields[static_cast<size_t>(header.axis[i])], &(*point)(i)))
      return false;
  }
  return true;
}

bool read_binary_vertex(std::istream& file, const Header& header, std::vector<unsigned char>* row,
                        Eigen::Vector3d* point) {
  if (!file.read(reinterpret_cast<char*>(row->data()), static_cast<std::streamsize>(row->size()))) {
    return false;
  }
  unsigned char* at = row->data();
  for (size_t k = 0; k < header.properties.size(); ++k) {
    const Property& property = header.properties[k];
    if (header.encoding == Encoding::kBig) std::reverse(at, at + property.bytes);
    for (int i = 0; i < 3; ++i) {
      if (header.axis[i] == static_cast<int>(k)) (*point)(i) = decode(property, at);
    }
    at += property.bytes;
  }
  return true;
}

}  // namespace

bool is_near(const Eigen::Vector3d& point) { return (point.cwiseAbs().array() <= kFarthest).all(); }

Cloud read_ply(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot read: " + std::strerror(errno));
  const Header header = read_header(file, path);
  size_t row_bytes = 0;
  for (const Property& property : header.properties) row_bytes += property.bytes;
  std::vector<unsigned char> row(row_bytes);
  Cloud cloud{path, {}, 0};
  for (int64_t k = 0; k < header.vertices; ++k) {
    Eigen::Vector3d point;
    const bool good = header.encoding == Encoding::kAscii
                          ? read_ascii_vertex(file, header, &point)
                          : read_binary_vertex(file, header, &row, &point);
    if (!good) {
      refuse(path, "cut off or not numbers at vertex " + std::to_string(k) + " of " +
                       std::to_string(header.vertices));
    }
    if (is_near(point)) {
      cloud.points.push_back(point);
    } else {
      ++cloud.skipped;
    }
  }
  if (cloud.points.empty()) refuse(path, "no points in it");
  return cloud;
}

bool write_ply(const std::string& path, const Cloud& cloud) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << cloud.points.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  for (const Eigen::Vector3d& point : cloud.points) {
    const Eigen::Vector3f rounded = point.cast<float>();
    file.write(reinterpret_cast<const char*>(rounded.data()), sizeof(float) * 3);
  }
  file.close();
  return static_cast<bool>(file);
}

Cloud thinned(const Cloud& cloud, double* side) {
  tools::VoxelGrid grid(*side, kMostThinned);
  for (const Eigen::Vector3d& p : cloud.points) grid.add({p.x(), p.y(), p.z()}, {}, 0.0, 1.0);
  *side = grid.side();
  Cloud thin{cloud.name, {}, cloud.skipped};
  thin.points.reserve(grid.size());
  for (size_t k = 0; k < grid.size(); ++k) thin.points.emplace_back(grid.point(k).position.data());
  return thin;
}

}  // namespace unisim::eval
