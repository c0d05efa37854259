// SPDX-License-Identifier: MIT
// Ids at their end: a session that has used them up says so and stays readable.
#include <memory>
#include <vector>

#include "core/session.hpp"
#include "tests/support/catch.hpp"

using unisim::DepthMap;
using unisim::kLastId;
using unisim::Session;
using unisim::SessionConfig;
using unisim::Sim3;
using unisim::Span;
using unisim::Status;

namespace {

SessionConfig config_of(int32_t window_submaps) {
  SessionConfig config;
  config.window_size = 4;
  config.window_overlap = 1;
  config.max_keyframes = 400;
  config.window_submaps = window_submaps;
  config.skeleton_capacity = 8;
  return config;
}

/// A straight walk with the same view everywhere.
class Walk {
 public:
  explicit Walk(const SessionConfig& config)
      : arena_(new unsigned char[Session::measure(config).required_bytes()]),
        pixels_(64, 2.0F),
        map_{pixels_.data(), nullptr, 8, 8} {
    const size_t bytes = Session::measure(config).required_bytes();
    REQUIRE(Session::create(config, arena_.get(), bytes, &session_) == Status::kOk);
  }
  Session& session() { return *session_; }

  Status add_keyframe() {
    int32_t id = -1;
    const Status status = session_->add_keyframe(++time_, &id);
    if (status != Status::kOk) return status;
    unisim::Request request;
    while (session_->next_request(unisim::kRequestPair, &request) == Status::kOk) {
      unisim::TwoViewInput pair;
      pair.i = request.keyframes.first;
      pair.j = request.keyframes.last();
      pair.T_i_j.t = {0.0, 0.0, 0.1};
      pair.depth_i = pair.depth_j = map_;
      REQUIRE(session_->add_two_view(pair) == Status::kOk);
    }
    return status;
  }

  Status add_submap(int32_t first, int32_t count, bool is_loop) {
    std::vector<int32_t> ids;
    std::vector<Sim3> poses(static_cast<size_t>(count));
    const std::vector<DepthMap> maps(static_cast<size_t>(count), map_);
    for (int32_t k = 0; k < count; ++k) {
      ids.push_back(first + k);
      poses[static_cast<size_t>(k)].t = {0.0, 0.0, 0.1 * k};
    }
    int32_t id = -1;
    const Status status = session_->add_submap(
        {{ids.data(), count}, {poses.data(), count}, {maps.data(), count}, 0}, is_loop, &id);
    if (status == Status::kOk) newest_submap_ = id;
    return status;
  }

  Status answer_window() {
    unisim::Request request;
    const Status open = session_->next_request(unisim::kRequestWindow, &request);
    if (open != Status::kOk) return open;
    return add_submap(request.keyframes.first, request.keyframes.count, false);
  }
  void optimize() {
    unisim::OptimizeReport report;
    REQUIRE(session_->optimize(0, &report) == Status::kOk);
  }
  int32_t newest_submap() const { return newest_submap_; }

 private:
  std::unique_ptr<unsigned char[]> arena_;
  std::vector<float> pixels_;
  DepthMap map_;
  Session* session_ = nullptr;
  int64_t time_ = 0;
  int32_t newest_submap_ = -1;
};

}  // namespace

TEST_CASE("keyframe ids end at capacity, what is there stays readable") {
  SessionConfig config = config_of(GENERATE(0, 2));
  config.first_keyframe_id = kLastId - 120;
  Walk walk(config);
  Status status = Status::kOk;
  for (int32_t k = 0; status == Status::kOk && k < 400; ++k) {
    status = walk.add_keyframe();
    if (walk.answer_window() == Status::kOk) walk.optimize();
    unisim::Retired retired;
    while (walk.session().next_retired(&retired) == Status::kOk) CHECK(retired.submap >= 0);
  }
  CHECK(status == Status::kCapacity);
  CHECK(walk.session().keyframes().size() == kLastId + 1);
  CHECK(walk.session().close_window() != Status::kInternal);
  unisim::PoseOutput pose;
  REQUIRE(walk.session().pose(kLastId, &pose) == Status::kOk);
  CHECK(pose.T_world_kf.t[2] == Approx(12.0));
  CHECK_FALSE(walk.session().broken());
}

TEST_CASE("submap ids end at capacity, for windows, loops and keyframes alike") {
  SessionConfig config = config_of(GENERATE(0, 2));
  config.first_submap_id = kLastId - 5;
  Walk walk(config);
  Status status = Status::kOk;
  for (int32_t k = 0; status == Status::kOk && k < 100; ++k) {
    status = walk.add_keyframe();
    if (walk.answer_window() == Status::kOk) walk.optimize();
  }
  CHECK(status == Status::kCapacity);
  CHECK(walk.newest_submap() == kLastId);
  CHECK(walk.add_submap(walk.session().keyframes().size() - 4, 4, true) == Status::kCapacity);
  unisim::PoseOutput pose;
  CHECK(walk.session().pose(walk.session().keyframes().size() - 1, &pose) == Status::kOk);
  CHECK_FALSE(walk.session().broken());
}

TEST_CASE("counters without bound stay at the largest number") {
  unisim::Counter counter(std::numeric_limits<int32_t>::max() - 1);
  ++counter;
  CHECK(counter == std::numeric_limits<int32_t>::max());
  ++counter;
  CHECK(counter == std::numeric_limits<int32_t>::max());
}
