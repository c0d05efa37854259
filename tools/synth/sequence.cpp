// SPDX-License-Identifier: MIT
// Rendering of a whole sequence, frames in parallel.
#include "tools/synth/sequence.hpp"

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <sstream>
#include <thread>

#include "tools/common/failure.hpp"
#include "tools/synth/encoding.hpp"
#include "tools/synth/random.hpp"
#include "tools/synth/renderer.hpp"
#include "tools/synth/sensor.hpp"

namespace unisim::synth {
namespace {

/// TUM time stamps are seconds of some epoch; this one keeps them short and not at zero.
constexpr double kFirstTime = 1000;
/// Views summed for a blurred frame and the share of the frame time they span.
constexpr int kBlurViews = 9;
constexpr double kShutterShare = 0.5;

SceneKind scene_kind(const SequenceOptions& options) {
  SceneKind kind = SceneKind::kRoom;
  if (!parse_scene_kind(options.scene, &kind)) {
    throw tools::Failure(tools::kExitUsage,
                         "--scene " + options.scene +
                             " is unknown; known are room, corridor, desk, rotation, " +
                             "lowtexture, static");
  }
  return kind;
}

void require(bool fine, const std::string& message) {
  if (!fine) {
    throw tools::Failure(tools::kExitUsage, message);
  }
}

std::string describe(const SequenceOptions& options, const Camera& camera) {
  std::ostringstream text;
  const auto boolean = [](bool value) { return value ? "true" : "false"; };
  text.precision(17);
  text << "version = \"" << UNISIM_SYNTH_VERSION << "\"\n"
       << "scene = \"" << options.scene << "\"\n"
       << "frames = " << options.frames << "\nfps = " << options.fps
       << "\nloops = " << options.loops << "\nseed = " << options.seed
       << "\nblur = " << boolean(options.blur) << "\nnoise = " << boolean(options.noise)
       << "\nreadout_ms = " << options.readout_ms
       << "\nexposure = " << boolean(options.exposure_jumps) << "\njpeg = " << boolean(options.jpeg)
       << "\nencode = " << boolean(options.encode) << "\nunit_spread = " << options.unit_spread
       << "\ndepth_factor = " << kDepthFactor << "\n\n[camera]  # pixel centres at whole numbers; "
       << "undistorted = distorted (1 + k1 r^2), r in focal lengths\n"
       << "width = " << camera.width << "\nheight = " << camera.height
       << "\nfx = " << camera.focal_px << "\nfy = " << camera.focal_px
       << "\ncx = " << camera.center_x() << "\ncy = " << camera.center_y()
       << "\nk1 = " << camera.radial_k1 << "\n";
  return text.str();
}

class FrameMaker {
 public:
  FrameMaker(const SequenceOptions& options, const Scene& scene, const SequenceWriter& writer)
      : options_(options),
        camera_(make_camera(options)),
        path_(make_path(options)),
        renderer_(scene, camera_, options.readout_ms != 0),
        writer_(writer),
        sensor_{options.noise, options.exposure_jumps, options.fps, options.seed} {}

  StampedPose make(int frame) const {
    const auto pixels = static_cast<size_t>(camera_.width) * static_cast<size_t>(camera_.height);
    ColorImage colors(pixels, Color::Zero());
    DepthImage depth(pixels, 0);
    const double time_s = frame / options_.fps;
    const int views = options_.blur ? kBlurViews : 1;
    for (int view = 0; view < views; ++view) {
      const double share = (view + 0.5) / views - 0.5;
      const bool middle = view == views / 2;
      const double open_s = time_s + share * kShutterShare / options_.fps;
      const auto pose_of_row = [&](int row) {
        const double late = (row + 0.5) / camera_.height - 0.5;
        return path_.T_world_cam(open_s + 1e-3 * options_.readout_ms * late);
      };
      renderer_.render(pose_of_row, &colors, middle ? &depth : nullptr);
    }
    const double stamp = frame_time_s(options_, frame);
    const cv::Mat image =
        options_.encode ? encode_frame(depth, camera_, header(frame))
                        : expose(colors, camera_, 1 / static_cast<float>(views), sensor_, frame);
    writer_.write_frame(stamp, image, encode_depth(depth, camera_, kDepthFactor));
    return {stamp, path_.T_world_cam(time_s)};
  }

 private:
  EncodedHeader header(int frame) const {
    const uint64_t index = 0x2000000u + static_cast<uint64_t>(frame);
    const double share = Random(derive_seed(options_.seed, index)).uniform();
    return {path_.T_world_cam(frame / options_.fps), share, options_.unit_spread};
  }

  const SequenceOptions& options_;
  Camera camera_;
  CameraPath path_;
  Renderer renderer_;
  const SequenceWriter& writer_;
  SensorOptions sensor_;
};

/// Hands frame numbers to threads until all are made or one fails.
class FrameQueue {
 public:
  FrameQueue(const FrameMaker& maker, int frames)
      : maker_(maker), frames_(frames), poses_(static_cast<size_t>(frames)) {}

  void work() {
    for (int frame = next_++; frame < frames_; frame = next_++) {
      try {
        poses_[static_cast<size_t>(frame)] = maker_.make(frame);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!error_) {
          error_ = std::current_exception();
        }
        next_ = frames_;
      }
      ++done_;
    }
    ++finished_threads_;
  }

  int done() const { return done_; }
  int finished_threads() const { return finished_threads_; }

  /// After all threads are joined.
  const std::vector<StampedPose>& result() const {
    if (error_) {
      std::rethrow_exception(error_);
    }
    return poses_;
  }

 private:
  const FrameMaker& maker_;
  int frames_;
  std::vector<StampedPose> poses_;
  std::atomic<int> next_{0};
  std::atomic<int> done_{0};
  std::atomic<int> finished_threads_{0};
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace

void check_options(const SequenceOptions& options) {
  scene_kind(options);
  require(options.width >= 32 && options.height >= 32 && options.width <= 8192 &&
              options.height <= 8192,
          "--size must be between 32x32 and 8192x8192");
  require(options.focal_px == 0 ||
              (options.focal_px >= 0.2 * options.width && options.focal_px <= 10.0 * options.width),
          "--focal must be 0.2 to 10 times the width, in pixels");
  require(!options.encode || !(options.blur || options.noise || options.exposure_jumps ||
                               options.jpeg || options.radial_k1 != 0 || options.readout_ms != 0),
          "--encode writes numbers, not light: it goes with none of --blur --noise --exposure "
          "--jpg --radial --readout-ms");
  require(options.encode || options.unit_spread == 0, "--unit-spread goes with --encode");
}

Camera make_camera(const SequenceOptions& options) {
  const double focal = options.focal_px > 0 ? options.focal_px : 0.82 * options.width;
  return {options.width, options.height, focal, options.radial_k1};
}

CameraPath make_path(const SequenceOptions& options) {
  const SceneKind kind = scene_kind(options);
  const int usual = kind == SceneKind::kCorridor ? 0 : 1;
  const int loops = options.loops < 0 ? usual : options.loops;
  return CameraPath({kind, options.frames / options.fps, loops, options.seed});
}

double frame_time_s(const SequenceOptions& options, int frame) {
  return kFirstTime + frame / options.fps;
}

void write_sequence(const SequenceOptions& options, const std::function<void(int)>& progress) {
  check_options(options);
  const SequenceWriter writer(options.folder, options.force, options.jpeg);
  writer.write_camera(describe(options, make_camera(options)));
  const Scene scene = make_scene(scene_kind(options), options.seed);
  const FrameMaker maker(options, scene, writer);
  FrameQueue queue(maker, options.frames);
  const auto cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int count = std::min(options.threads > 0 ? options.threads : cores, options.frames);
  std::vector<std::thread> threads;
  threads.reserve(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    threads.emplace_back([&queue] { queue.work(); });
  }
  while (queue.finished_threads() < count) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    progress(queue.done());
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  writer.write_lists(queue.result());
}

}  // namespace unisim::synth
