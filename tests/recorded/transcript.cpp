// SPDX-License-Identifier: MIT
// Runs a predictor as the pipeline does and writes down every answer.
#include "tests/recorded/transcript.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "drivers/recorded/recorded.h"
#include "tests/recorded/scripted_predictor.hpp"

namespace unisim::test {
namespace {

class Line {
 public:
  explicit Line(const std::string& name, int status) {
    text_ = name + " " + std::to_string(status);
  }
  void add(double value) {
    char number[40];
    std::snprintf(number, sizeof number, " %a", value);
    text_ += number;
  }
  void add(const unisim_sim3& pose) {
    for (double value : pose.q) add(value);
    for (double value : pose.t) add(value);
    add(pose.s);
  }
  void add(const unisim_depth_map& map) {
    text_ += " map " + std::to_string(map.width) + "x" + std::to_string(map.height);
    const int count = map.width * map.height;
    for (int k = 0; k < count; ++k) add(static_cast<double>(map.depth[k]));
    if (map.confidence == nullptr) text_ += " no-confidence";
    for (int k = 0; map.confidence != nullptr && k < count; ++k) {
      add(static_cast<double>(map.confidence[k]));
    }
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

class Runner {
 public:
  Runner(unisim_predictor* predictor, const RunOptions& options)
      : predictor_(predictor), options_(options) {}

  Transcript run() {
    for (int k = 0; k < options_.frames; ++k) step(options_.first_frame + k);
    predictor_->finish(predictor_);
    ask_all();
    return transcript_;
  }

 private:
  void step(int index) {
    unisim_frame frame{};
    frame.index = index;
    frame.timestamp_ns = 1000000007LL * index;
    frame.image = {nullptr, 640, 480, 640, UNISIM_PIXEL_GRAY8};
    unisim_motion motion{};
    const int status = predictor_->observe(predictor_, &frame, &motion);
    Line line("frame " + std::to_string(index), status);
    line.add(motion.flow);
    line.add(motion.tracked);
    line.add(motion.reason);
    note(line, status);
    transcript_.advice.push_back(motion.keyframe_advice);
    if (status != UNISIM_PREDICTION_OK) return;
    if (predictor_->frame_pose != nullptr) ask_frame_pose();
    if (index % options_.stride != 0) return;
    const int taken = predictor_->keyframe(predictor_, &frame, next_id_++);
    note(Line("keyframe", taken), taken);
    ask_all();
  }

  void note(const Line& line, int status, bool of_windows = false) {
    transcript_.answers.push_back(line.text());
    if (status == UNISIM_PREDICTION_FAILED) ++transcript_.failed;
    if (status == UNISIM_PREDICTION_REJECTED || status == UNISIM_PREDICTION_FAILED) {
      const bool own = of_windows && predictor_->window_message != nullptr;
      transcript_.messages.emplace_back(own ? predictor_->window_message(predictor_)
                                            : predictor_->message(predictor_));
    }
  }

  void ask_frame_pose() {
    unisim_frame_pose pose{};
    const int status = predictor_->frame_pose(predictor_, &pose);
    Line line("frame_pose", status);
    if (status == UNISIM_PREDICTION_OK) {
      line.add(pose.T_kf_frame);
      line.add(pose.keyframe_id);
    }
    note(line, status);
  }

  void ask_all() {
    while (next_pair_ + 1 < next_id_ && ask_pair()) ++next_pair_;
    while (next_window_ + options_.window <= next_id_ && ask_window()) ++next_window_;
    while (ask_revision()) {
    }
    while (ask_wide_window()) {
    }
  }

  bool ask_pair() {
    unisim_pair_prediction pair{};
    const int status = predictor_->two_view(predictor_, next_pair_, next_pair_ + 1, &pair);
    Line line("pair " + std::to_string(next_pair_), status);
    if (status == UNISIM_PREDICTION_OK) {
      line.add(pair.T_i_j);
      line.add(pair.depth_i);
      line.add(pair.depth_j);
      line.add(pair.focal_px);
      line.add(pair.center_sigma);
      line.add(static_cast<double>(pair.gap));
      line.add(pair.log_scale_sigma);
    }
    note(line, status);
    return status != UNISIM_PREDICTION_PENDING;
  }

  bool ask_window() {
    std::vector<int32_t> ids;
    for (int k = 0; k < options_.window; ++k) ids.push_back(next_window_ + k);
    unisim_window_prediction window{};
    const int status = predictor_->multi_view(predictor_, ids.data(), options_.window, &window);
    note_window("window " + std::to_string(next_window_), window, status);
    return status != UNISIM_PREDICTION_PENDING;
  }

  bool ask_wide_window() {
    unisim_window_prediction window{};
    const int status = predictor_->next_wide_window(predictor_, options_.window, &window);
    note_window("wide window", window, status);
    return status == UNISIM_PREDICTION_OK;
  }

  void note_window(const std::string& what, const unisim_window_prediction& window, int status) {
    Line line(what, status);
    for (int k = 0; status == UNISIM_PREDICTION_OK && k < window.count; ++k) {
      line.add(window.keyframe_ids[k]);
      line.add(window.T_window_kf[k]);
      line.add(window.depth[k]);
    }
    if (status == UNISIM_PREDICTION_OK) {
      line.add(window.focal_px);
      line.add(window.center_sigma);
      line.add(static_cast<double>(window.token));
      line.add(window.metres_per_unit);
      line.add(window.metres_sigma);
      line.add(window.metres_common_sigma);
    }
    note(line, status, true);
  }

  bool ask_revision() {
    unisim_window_revision revision{};
    const int status = predictor_->next_revision(predictor_, &revision);
    Line line("revision", status);
    for (int k = 0; status == UNISIM_PREDICTION_OK && k < revision.count; ++k) {
      line.add(revision.T_window_kf[k]);
      line.add(revision.log_depth_ratio[k]);
    }
    if (status == UNISIM_PREDICTION_OK) {
      line.add(revision.center_sigma);
      line.add(static_cast<double>(revision.scale_settled));
      line.add(static_cast<double>(revision.token));
    }
    note(line, status, true);
    return status == UNISIM_PREDICTION_OK;
  }

  unisim_predictor* predictor_;
  RunOptions options_;
  Transcript transcript_;
  int next_id_ = 0;
  int next_pair_ = 0;
  int next_window_ = 0;
};

}  // namespace

Transcript run_predictor(unisim_predictor* predictor, const RunOptions& options) {
  return Runner(predictor, options).run();
}

TempFolder::TempFolder() {
  path_ = (std::filesystem::temp_directory_path() / "unisim-recorded-XXXXXX").string();
  if (mkdtemp(path_.data()) == nullptr) throw std::runtime_error("no temporary folder: " + path_);
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

Transcript record_scripted(const std::string& path, const RunOptions& options) {
  char message[200];
  unisim_predictor* recorder = unisim_recorder_create(make_scripted_predictor(), path.c_str(),
                                                      "a sequence", message, sizeof message);
  if (recorder == nullptr) throw std::runtime_error(message);
  Transcript transcript = run_predictor(recorder, options);
  recorder->destroy(recorder);
  return transcript;
}

}  // namespace unisim::test
