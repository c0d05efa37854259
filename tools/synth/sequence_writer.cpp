// SPDX-License-Identifier: MIT
// Writing of a TUM-style folder.
#include "tools/synth/sequence_writer.hpp"

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "drivers/common/format.hpp"
#include "tools/common/failure.hpp"

namespace unisim::synth {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "# written by unisim-synth\n";

using drivers::format;

std::string depth_name(double time_s) { return "depth/" + format("%.6f", time_s) + ".png"; }

bool is_our_sequence(const fs::path& folder) {
  std::ifstream file(folder / "camera.toml");
  std::string line;
  return std::getline(file, line) && line + "\n" == kMark;
}

void remove_sequence(const fs::path& folder) {
  for (const char* name : {"rgb", "depth", "rgb.txt", "depth.txt", "associations.txt",
                           "groundtruth.txt", "camera.toml"}) {
    fs::remove_all(folder / name);
  }
}

}  // namespace

SequenceWriter::SequenceWriter(const std::string& folder, bool force, bool jpeg)
    : folder_(folder), jpeg_(jpeg) {
  try {
    if (fs::exists(folder) && !fs::is_directory(folder)) {
      throw tools::Failure(tools::kExitUsage, folder + " is a file; name a folder");
    }
    fs::create_directories(folder);
    lock_ = std::make_unique<tools::FolderLock>(folder);
    if (!fs::is_empty(folder)) {
      if (!force) {
        throw tools::Failure(tools::kExitUsage,
                             folder + " is not empty; choose another folder or add --force");
      }
      if (!is_our_sequence(folder)) {
        throw tools::Failure(
            tools::kExitUsage,
            folder + " holds files that unisim-synth did not write; " + "choose another folder");
      }
      remove_sequence(folder);
    }
    fs::create_directories(fs::path(folder) / "rgb");
    fs::create_directories(fs::path(folder) / "depth");
  } catch (const fs::filesystem_error& error) {
    throw tools::Failure(tools::kExitLimit,
                         "cannot write to " + folder + ": " + error.code().message());
  }
}

std::string SequenceWriter::image_name(double time_s) const {
  return "rgb/" + format("%.6f", time_s) + (jpeg_ ? ".jpg" : ".png");
}

void SequenceWriter::write_text(const std::string& name, const std::string& text) const {
  const fs::path path = fs::path(folder_) / name;
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) {
    throw tools::Failure(tools::kExitLimit,
                         "cannot write " + path.string() + "; is the disk full?");
  }
}

void SequenceWriter::write_camera(const std::string& text) const {
  write_text("camera.toml", kMark + text);
}

void SequenceWriter::write_frame(double time_s, const cv::Mat& image, const cv::Mat& depth) const {
  // Fastest settings, which for textured images also give the smallest files.
  const std::vector<int> png = {cv::IMWRITE_PNG_COMPRESSION, 1, cv::IMWRITE_PNG_STRATEGY,
                                cv::IMWRITE_PNG_STRATEGY_RLE};
  const std::vector<int> depth_png = {cv::IMWRITE_PNG_COMPRESSION, 1, cv::IMWRITE_PNG_STRATEGY,
                                      cv::IMWRITE_PNG_STRATEGY_DEFAULT};
  const std::vector<int> jpeg = {cv::IMWRITE_JPEG_QUALITY, 95};
  const std::string image_path = (fs::path(folder_) / image_name(time_s)).string();
  const std::string depth_path = (fs::path(folder_) / depth_name(time_s)).string();
  if (!cv::imwrite(image_path, image, jpeg_ ? jpeg : png) ||
      !cv::imwrite(depth_path, depth, depth_png)) {
    throw tools::Failure(tools::kExitLimit,
                         "cannot write " + image_path + " or its depth; is the disk full?");
  }
}

void SequenceWriter::write_lists(const std::vector<StampedPose>& poses) const {
  std::string rgb = "# color images\n# timestamp filename\n";
  std::string depth = "# depth images, 5000 per metre, 0: none\n# timestamp filename\n";
  std::string associations;
  std::string truth = "# ground truth, camera-to-world, metres\n# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& pose : poses) {
    const std::string stamp = format("%.6f", pose.time_s);
    const std::string image_line = stamp + " " + image_name(pose.time_s);
    const std::string depth_line = stamp + " " + depth_name(pose.time_s);
    rgb.append(image_line).append("\n");
    depth.append(depth_line).append("\n");
    associations.append(image_line).append(" ").append(depth_line).append("\n");
    truth += stamp;
    const Eigen::Quaterniond q(pose.T_world_cam.linear());
    const Eigen::Vector3d t = pose.T_world_cam.translation();
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      truth += format(" %.9f", value);
    }
    truth += "\n";
  }
  write_text("rgb.txt", rgb);
  write_text("depth.txt", depth);
  write_text("associations.txt", associations);
  write_text("groundtruth.txt", truth);
}

}  // namespace unisim::synth
