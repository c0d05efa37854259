// SPDX-License-Identifier: MIT
// Files of camera poses: TUM, KITTI and EuRoC, one pose per line.
#include "drivers/sequence/pose_file.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

constexpr double kRotationTolerance = 1e-2;
constexpr double kLargestSeconds = 1e11;  // of a clock, some 3000 years

struct Fields {
  double number[17];
  size_t count;
};

bool all_finite(const double* values, size_t count) {
  return std::all_of(values, values + count, [](double v) { return std::isfinite(v); });
}

bool parse_fields(const std::vector<std::string_view>& texts, Fields* fields) {
  fields->count = std::min<size_t>(texts.size(), 17);
  for (size_t k = 0; k < fields->count; ++k) {
    if (!parse_number(texts[k], &fields->number[k])) return false;
  }
  return true;
}

// EuRoC's csv counts nanoseconds: eight columns of it whose time is a fraction, and no number of
// our century's nanoseconds, are a TUM file with commas, qw last. A line of words says nothing.
PoseFormat guess_with_commas(const std::string& line) {
  const auto texts = split_fields(line, true);
  double time = 0;
  if (texts.empty() || !parse_number(texts.front(), &time)) return PoseFormat::kAuto;
  const bool fraction = texts.front().find('.') != std::string_view::npos;
  const bool tum = texts.size() == 8 && fraction && std::abs(time) < kLargestSeconds;
  return tum ? PoseFormat::kTum : PoseFormat::kEuroc;
}

PoseFormat guess_format(const std::string& line) {
  if (line.find(',') != std::string::npos) return guess_with_commas(line);
  const size_t count = split_fields(line).size();
  if (count == 8) return PoseFormat::kTum;
  if (count == 12 || count == 13) return PoseFormat::kKitti;
  return PoseFormat::kAuto;
}

// q: x y z w of any length but zero.
bool set_rotation(const double q[4], FilePose* pose) {
  const double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (!(n > 1e-12)) return false;
  const double s = 2.0 / n;
  const double xx = s * q[0] * q[0], yy = s * q[1] * q[1], zz = s * q[2] * q[2];
  const double xy = s * q[0] * q[1], xz = s * q[0] * q[2], yz = s * q[1] * q[2];
  const double xw = s * q[0] * q[3], yw = s * q[1] * q[3], zw = s * q[2] * q[3];
  const double rows[9] = {1 - yy - zz, xy - zw, xz + yw, xy + zw,    1 - xx - zz,
                          yz - xw,     xz - yw, yz + xw, 1 - xx - yy};
  std::copy(rows, rows + 9, pose->rotation);
  return true;
}

bool read_time(std::string_view text, double number, TimeUnit unit, FilePose* pose) {
  pose->time_s = number / units_per_second(unit);
  return parse_time(text, unit, &pose->timestamp_ns);
}

bool read_tum(const std::vector<std::string_view>& texts, TimeUnit unit, FilePose* pose) {
  Fields f{};
  if (texts.size() != 8 || !parse_fields(texts, &f) || !all_finite(f.number, 8)) return false;
  if (!read_time(texts[0], f.number[0], unit, pose)) return false;
  std::copy(f.number + 1, f.number + 4, pose->translation);
  return set_rotation(f.number + 4, pose);
}

bool read_euroc(const std::vector<std::string_view>& texts, TimeUnit unit, FilePose* pose) {
  Fields f{};
  if (texts.size() < 8) return false;
  if (!parse_fields({texts.begin(), texts.begin() + 8}, &f) || !all_finite(f.number, 8))
    return false;
  if (!read_time(texts[0], f.number[0], unit, pose)) return false;
  std::copy(f.number + 1, f.number + 4, pose->translation);
  const double q[4] = {f.number[5], f.number[6], f.number[7], f.number[4]};
  return set_rotation(q, pose);
}

bool read_kitti(const std::vector<std::string_view>& texts, int64_t position, FilePose* pose) {
  Fields f{};
  if (texts.size() != 12 && texts.size() != 13) return false;
  if (!parse_fields(texts, &f) || !all_finite(f.number, f.count)) return false;
  const bool numbered = f.count == 13;
  if (!pose_from_matrix(f.number + (numbered ? 1 : 0), pose)) return false;
  const double frame = numbered ? f.number[0] : static_cast<double>(position);
  if (std::abs(frame) > 1e9) return false;
  pose->time_s = frame;
  pose->timestamp_ns = static_cast<int64_t>(std::llround(frame * 1e9));
  return true;
}

// Finds the unit of the first column.
void set_unit(const std::vector<TextLine>& lines, PoseFile* file) {
  if (file->format == PoseFormat::kKitti) return;
  std::vector<double> times;
  for (const TextLine& line : lines) {
    double time = 0;
    const auto texts = split_fields(line.text, true);
    if (!texts.empty() && parse_number(texts.front(), &time)) times.push_back(time);
  }
  const bool euroc = file->format == PoseFormat::kEuroc;
  const TimeUnit own = euroc ? TimeUnit::kNanoseconds : TimeUnit::kSeconds;
  file->unit = guess_unit(std::move(times), own, kLongestPoseStepS);
  file->foreign_unit = file->unit != own;
}

}  // namespace

const char* pose_format_name(PoseFormat format) {
  switch (format) {
    case PoseFormat::kTum:
      return "tum";
    case PoseFormat::kKitti:
      return "kitti";
    case PoseFormat::kEuroc:
      return "euroc";
    case PoseFormat::kAuto:
      break;
  }
  return "auto";
}

bool pose_from_matrix(const double* rows, FilePose* pose) {
  if (!all_finite(rows, 12)) return false;
  double* r = pose->rotation;
  for (int i = 0; i < 3; ++i) {
    std::copy(rows + 4 * i, rows + 4 * i + 3, r + 3 * i);
    pose->translation[i] = rows[4 * i + 3];
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      const double dot =
          r[3 * i] * r[3 * j] + r[3 * i + 1] * r[3 * j + 1] + r[3 * i + 2] * r[3 * j + 2];
      if (std::abs(dot - (i == j ? 1.0 : 0.0)) > kRotationTolerance) return false;
    }
  }
  return true;
}

PoseFile read_pose_file(const std::string& path, PoseFormat format) {
  const std::vector<TextLine> lines = read_lines(path);
  if (lines.empty()) throw InputError(path + ": no poses in it: empty file");
  PoseFile file;
  file.format = format;
  for (size_t k = 0; k < lines.size() && file.format == PoseFormat::kAuto; ++k) {
    file.format = guess_format(lines[k].text);
  }
  set_unit(lines, &file);
  for (size_t k = 0; k < lines.size(); ++k) {
    const auto texts = split_fields(lines[k].text, true);
    FilePose pose{};
    bool good = false;
    if (file.format == PoseFormat::kTum) good = read_tum(texts, file.unit, &pose);
    if (file.format == PoseFormat::kEuroc) good = read_euroc(texts, file.unit, &pose);
    if (file.format == PoseFormat::kKitti) good = read_kitti(texts, static_cast<int64_t>(k), &pose);
    if (good) {
      file.numbered = file.numbered || (file.format == PoseFormat::kKitti && texts.size() == 13);
      file.poses.push_back(pose);
    }
  }
  file.skipped = static_cast<int64_t>(lines.size() - file.poses.size());
  if (file.poses.empty()) {
    throw InputError(
        path + ":" + std::to_string(lines.front().number) +
        ": no line is a pose: expected TUM (time and 7 numbers), KITTI (12 numbers) or "
        "EuRoC csv (ns and 7 numbers)");
  }
  return file;
}

unisim_stamped_pose to_stamped_pose(const FilePose& pose) {
  const double* r = pose.rotation;
  // The largest of the four is found first: its square root is then far from zero.
  const double four_q2[4] = {1 + r[0] - r[4] - r[8], 1 - r[0] + r[4] - r[8], 1 - r[0] - r[4] + r[8],
                             1 + r[0] + r[4] + r[8]};
  double q[4];
  switch (std::max_element(four_q2, four_q2 + 4) - four_q2) {
    case 0:
      q[0] = four_q2[0], q[1] = r[1] + r[3], q[2] = r[2] + r[6], q[3] = r[7] - r[5];
      break;
    case 1:
      q[0] = r[1] + r[3], q[1] = four_q2[1], q[2] = r[5] + r[7], q[3] = r[2] - r[6];
      break;
    case 2:
      q[0] = r[2] + r[6], q[1] = r[5] + r[7], q[2] = four_q2[2], q[3] = r[3] - r[1];
      break;
    default:
      q[0] = r[7] - r[5], q[1] = r[2] - r[6], q[2] = r[3] - r[1], q[3] = four_q2[3];
  }
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  unisim_stamped_pose out{};
  out.timestamp_ns = pose.timestamp_ns;
  for (int i = 0; i < 4; ++i) out.T_world_cam.q[i] = q[i] / length;
  std::copy(pose.translation, pose.translation + 3, out.T_world_cam.t);
  out.T_world_cam.s = 1.0;
  return out;
}

}  // namespace unisim::sequence
