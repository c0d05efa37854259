// SPDX-License-Identifier: MIT
// Small parts: nearest rotation, confidence by quantile, the memory budget, the ring of views.
#include <cmath>
#include <limits>
#include <vector>

#include "drivers/onnx/error.hpp"
#include "drivers/onnx/predict/nearest_rotation.hpp"
#include "drivers/onnx/predict/quantile.hpp"
#include "drivers/onnx/predict/refused_pairs.hpp"
#include "drivers/onnx/predict/view_store.hpp"
#include "drivers/onnx/runtime/cost.hpp"
#include "drivers/onnx/runtime/memory_use.hpp"
#include "drivers/onnx/runtime/peak_memory.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::onnx;

TEST_CASE("the rotation inside a stretched matrix is found") {
  const Eigen::Quaterniond truth(Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, -2, 0.5).normalized()));
  Eigen::Matrix3d stretch;
  stretch << 1.2, 0.1, 0.0, 0.1, 0.8, -0.2, 0.0, -0.2, 1.1;
  Eigen::Quaterniond found;
  REQUIRE(nearest_rotation(truth.toRotationMatrix() * stretch, &found));
  CHECK(found.angularDistance(truth) < 1e-9);
}

TEST_CASE("a reflection has a nearest rotation, a rank-one matrix has none") {
  Eigen::Quaterniond found;
  REQUIRE(nearest_rotation(Eigen::Vector3d(1, 1, -0.5).asDiagonal(), &found));
  CHECK(found.angularDistance(Eigen::Quaterniond::Identity()) < 1e-9);
  CHECK_FALSE(nearest_rotation(Eigen::Vector3d(1, 0, 0).asDiagonal(), &found));
  CHECK_FALSE(nearest_rotation(Eigen::Matrix3d::Zero(), &found));
}

TEST_CASE("confidence becomes its rank, equal values the mean of theirs") {
  std::vector<float> values = {10, -3, 10, 0.5f, -0.0f, 0.0f};
  QuantileRanker ranker(values.size());
  ranker.rank(values.data(), values.size());
  const std::vector<float> expected = {0.9f, 0, 0.9f, 0.6f, 0.3f, 0.3f};
  for (size_t i = 0; i < values.size(); ++i) CHECK(values[i] == Approx(expected[i]));
}

TEST_CASE("as many views are taken as the budget allows, and none is tried beyond it") {
  int64_t largest = 0;
  const auto quadratic = [&](int32_t views) {
    const int64_t bytes = 10 * int64_t{views} * views;
    largest = std::max(largest, bytes);
    return bytes;
  };
  CHECK(views_within(2560, 2, 16, quadratic) == 16);
  CHECK(largest == 2560);
  largest = 0;
  CHECK(views_within(1500, 2, 16, quadratic) == 12);
  CHECK(largest <= 1500);
  const auto linear = [&](int32_t views) { return int64_t{100} * views; };
  CHECK(views_within(1000, 2, 16, linear) == 8);
  CHECK(views_within(100, 2, 16, linear) == 2);
}

TEST_CASE("the ring keeps the newest views and knows the others are gone") {
  ViewStore store(3, 2);
  for (int32_t id = 0; id < 5; ++id) store.add(id)[1] = static_cast<float>(id);
  CHECK(store.find(1) == nullptr);
  CHECK(store.find(5) == nullptr);
  for (int32_t id = 2; id < 5; ++id) CHECK(store.find(id)[1] == static_cast<float>(id));
}

TEST_CASE("memory between the stated numbers of views is on the line, beyond them on the square") {
  const auto peaks = read_peaks(" 2:1000 4:3000\t16:9000 ");
  REQUIRE(peaks.has_value());
  CHECK(peak_bytes(*peaks, 1) == 1000);
  CHECK(peak_bytes(*peaks, 2) == 1000);
  CHECK(peak_bytes(*peaks, 3) == 2000);
  CHECK(peak_bytes(*peaks, 4) == 3000);
  CHECK(peak_bytes(*peaks, 10) == 6000);
  CHECK(peak_bytes(*peaks, 32) == 36000);
}

TEST_CASE("a statement of memory that is none is not read") {
  for (const char* text : {"", "2", "2:", ":5", "2:1000,16:9000", "2:1000 2:2000", "16:9 2:1",
                           "2:-5", "0:5", "2:1e6", "2:1000 x", "2:99999999999999999999"}) {
    INFO(text);
    CHECK_FALSE(read_peaks(text).has_value());
  }
}

TEST_CASE("what is kept of the keyframes counts in the budget") {
  MemoryBudget budget;
  budget.bytes = 100 << 20;
  budget.kept_bytes = 10 << 20;
  budget.kept_bytes_per_view = 5 << 20;
  CHECK_NOTHROW(require_fit("m.onnx", {16, 0, 10 << 20}, budget));
  try {
    require_fit("m.onnx", {17, 0, 10 << 20}, budget);
    FAIL("fits");
  } catch (const OnnxError& error) {
    CHECK(error.problem() == UNISIM_ONNX_NO_MEMORY);
    CHECK(std::string(error.what()).find("17 view(s) take 106 MB, more than the 100 MB") !=
          std::string::npos);
  }
}

TEST_CASE("a mark of memory that is reset is not forgotten") {
  constexpr int64_t kBytes = int64_t{64} << 20;
  {
    const std::vector<char> block(kBytes, 1);
  }
  const int64_t growth = peak_growth_bytes([] {});
  CHECK(peak_before_reset_bytes() > kBytes);
  CHECK(growth < kBytes);
}

TEST_CASE("of refused pairs in a row the keyframes in the middle are blamed first") {
  using Blame = RefusedPairs::Blame;
  RefusedPairs pairs(8);
  for (int32_t j = 1; j <= 6; ++j) pairs.settle(j, j == 3 || j == 4 || j == 6);
  const auto blamed = [&](Blame blame) {
    std::vector<int32_t> ids;
    for (int32_t id = 0; id <= 7; ++id) {
      if (pairs.blamed(id, blame, 14)) ids.push_back(id);
    }
    return ids;
  };
  CHECK(blamed(Blame::kBothPairs) == std::vector<int32_t>{3});
  CHECK(blamed(Blame::kFirst) == std::vector<int32_t>{2, 3, 5});
  CHECK(blamed(Blame::kSecond) == std::vector<int32_t>{3, 4, 6});
  for (int32_t j = 7; j <= 12; ++j) pairs.settle(j, false);
  CHECK(blamed(Blame::kSecond) == std::vector<int32_t>{6});
  pairs.settle(14, false);
  CHECK(blamed(Blame::kSecond).empty());
}

TEST_CASE("what a pair after the window says does not count") {
  RefusedPairs pairs(8);
  for (int32_t j = 1; j <= 6; ++j) pairs.settle(j, j == 5);
  CHECK(pairs.blamed(4, RefusedPairs::Blame::kFirst, 5));
  CHECK_FALSE(pairs.blamed(4, RefusedPairs::Blame::kFirst, 4));
}
