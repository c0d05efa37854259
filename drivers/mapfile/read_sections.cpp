// SPDX-License-Identifier: MIT
// Reads a file of named parts; what is damaged is refused by the name of the part.
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "drivers/mapfile/format.hpp"
#include "drivers/mapfile/sections.hpp"
#include "drivers/recorded/crc32c.hpp"

namespace unisim::mapfile {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& why) {
  throw Error(Error::Kind::kInput, path + ": " + why);
}

uint64_t get(const uint8_t* from, size_t bytes) {
  uint64_t value = 0;
  for (size_t k = 0; k < bytes; ++k) value |= static_cast<uint64_t>(from[k]) << (8 * k);
  return value;
}

struct Entry {
  std::string name;
  uint64_t size;
  uint32_t sum;
};

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {
    std::error_code problem;
    const auto status = std::filesystem::status(path, problem);
    if (!std::filesystem::exists(status)) fail(path_, "there is no such map");
    if (!std::filesystem::is_regular_file(status)) fail(path_, "is no file");
    size_ = std::filesystem::file_size(path, problem);
    file_.open(path, std::ios::binary);
    if (problem || !file_) fail(path_, std::string("cannot be read: ") + std::strerror(errno));
  }

  std::vector<Section> read() {
    const std::vector<Entry> entries = read_head();
    std::vector<Section> sections;
    uint64_t at = head_bytes(entries.size());
    // Before anything is asked of the memory.
    for (const Entry& entry : entries) {
      if (entry.size > size_ - at) {
        fail(path_, "part " + entry.name + " is cut off: " + std::to_string(size_ - at) + " of " +
                        std::to_string(entry.size) + " bytes are there");
      }
      at += entry.size;
    }
    if (at != size_) {
      fail(path_, std::to_string(size_ - at) + " bytes after its last part are none of a map");
    }
    for (const Entry& entry : entries) {
      sections.push_back({entry.name, take(entry.size, "part " + entry.name)});
      const Bytes& bytes = sections.back().bytes;
      if (recorded::crc32c(bytes.data(), bytes.size()) != entry.sum) {
        fail(path_, "part " + entry.name + " is damaged: its checksum is another one");
      }
    }
    return sections;
  }

 private:
  Bytes take(uint64_t size, const std::string& what) {
    Bytes bytes(static_cast<size_t>(size));
    file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (static_cast<uint64_t>(file_.gcount()) != size) fail(path_, what + " cannot be read");
    return bytes;
  }

  std::vector<Entry> read_head() {
    if (size_ < kFixedBytes) fail_if_foreign(take(size_, "its head"));
    Bytes head = take(kFixedBytes, "its head");
    fail_if_foreign(head);
    const uint64_t version = get(head.data() + sizeof kMagic, 4);
    if (version > kVersion) {
      fail(path_, "its head says version " + std::to_string(version) +
                      ", this program reads up to " + std::to_string(kVersion) +
                      "; use a newer program, or the file is damaged");
    }
    const uint64_t count = get(head.data() + sizeof kMagic + 4, 4);
    if (version != kVersion || count > kMostSections) fail(path_, "its head is damaged");
    const uint64_t rest = head_bytes(static_cast<size_t>(count)) - kFixedBytes;
    if (rest > size_ - kFixedBytes) fail(path_, "its head is cut off");
    const Bytes more = take(rest, "its head");
    head.insert(head.end(), more.begin(), more.end());
    const size_t summed = head.size() - kSumBytes;
    if (recorded::crc32c(head.data(), summed) != get(head.data() + summed, kSumBytes)) {
      fail(path_, "its head is damaged: its checksum is another one");
    }
    std::vector<Entry> entries;
    for (const uint8_t* from = head.data() + kFixedBytes; from != head.data() + summed;
         from += kEntryBytes) {
      const auto* name = reinterpret_cast<const char*>(from);
      entries.push_back({std::string(name, std::find(name, name + kNameBytes, '\0')),
                         get(from + kNameBytes, 8),
                         static_cast<uint32_t>(get(from + kNameBytes + 8, 4))});
    }
    return entries;
  }

  void fail_if_foreign(const Bytes& head) const {
    const size_t known = std::min(head.size(), sizeof kMagic);
    if (known == 0) fail(path_, "is empty");
    if (std::memcmp(head.data(), kMagic, known) != 0) fail(path_, "is no map of libunisim");
    if (head.size() < kFixedBytes) fail(path_, "its head is cut off");
  }

  std::string path_;
  std::ifstream file_;
  uint64_t size_ = 0;
};

}  // namespace

std::vector<Section> read_sections(const std::string& path) { return Reader(path).read(); }

}  // namespace unisim::mapfile
