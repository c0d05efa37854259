// SPDX-License-Identifier: MIT
// Figures of evo 1.38.1 on recorded pairs, to 1e-6.
#include "tests/support/catch.hpp"
#include "tests/support/recorded_data.hpp"
#include "tools/eval/ate.hpp"
#include "tools/eval/rpe.hpp"

using namespace unisim::eval;

namespace {

constexpr double kTolerance = 1e-6;
constexpr double kMaxDt_s = 0.01;

const std::string kXyz = "eval_pairs/evo/freiburg1_xyz-";
const std::string kTruth = kXyz + "groundtruth.txt", kRgbdSlam = kXyz + "rgbdslam.txt";
const std::string kDrift = kXyz + "rgbdslam_drift.txt", kShort = kXyz + "rgbdslam_drift_short.txt";
const std::string kOrb = kXyz + "ORB_kf_mono.txt";
const std::string kSfm = "7scenes_redkitchen/groundtruth_sfm.txt";
const std::string kFusion = "7scenes_redkitchen/groundtruth_original.txt";
const std::string kKitti = "trajectories_gt/kitti_odometry_poses/09.txt";
const std::string kDeepVo = "eval_pairs/kitti_odom_eval/example_1/09.txt";

struct AteFigure {
  std::string truth, estimate;
  Alignment alignment;
  size_t pairs;
  double rmse;
};

struct RpeFigure {
  std::string truth, estimate;
  Alignment alignment;
  RpeStep step;
  size_t pairs;
  double translation_rmse, rotation_rmse_deg;
};

}  // namespace

TEST_CASE("ate equals evo") {
  const AteFigure figure = GENERATE(values<AteFigure>({
      {kTruth, kRgbdSlam, Alignment::kNone, 785, 0.020079418},
      {kTruth, kRgbdSlam, Alignment::kSe3, 785, 0.013470089},
      {kTruth, kDrift, Alignment::kSe3, 785, 0.013470119},
      {kTruth, kShort, Alignment::kSim3, 40, 0.006756675},
      {kTruth, kOrb, Alignment::kSim3, 32, 0.009754582},
      {kSfm, kFusion, Alignment::kSim3, 500, 0.037642549},
      {kKitti, kDeepVo, Alignment::kNone, 1591, 17.919054845},
      {kKitti, kDeepVo, Alignment::kSim3, 1591, 10.729499519},
  }));
  const std::string truth = recorded_data(figure.truth);
  const std::string estimate = recorded_data(figure.estimate);
  UNISIM_SKIP_WITHOUT(truth);
  UNISIM_SKIP_WITHOUT(estimate);
  INFO(estimate);
  const Ate ate = absolute_trajectory_error(read_trajectory(truth), read_trajectory(estimate),
                                            figure.alignment, kMaxDt_s);
  REQUIRE(ate.pairs.size() == figure.pairs);
  REQUIRE(ate.error.rmse == Approx(figure.rmse).margin(kTolerance).epsilon(0));
}

TEST_CASE("rpe equals evo") {
  const RpeFigure figure = GENERATE(values<RpeFigure>({
      {kTruth,
       kRgbdSlam,
       Alignment::kNone,
       {1, StepUnit::kFrames, false},
       784,
       0.005764371,
       0.353613161},
      {kTruth,
       kRgbdSlam,
       Alignment::kNone,
       {30, StepUnit::kFrames, true},
       755,
       0.021700579,
       0.936586149},
      {kTruth,
       kRgbdSlam,
       Alignment::kNone,
       {0.1, StepUnit::kMetres, false},
       80,
       0.014305009,
       0.684269046},
      {kTruth,
       kDrift,
       Alignment::kNone,
       {0.5, StepUnit::kMetres, true},
       697,
       0.024811032,
       1.048278902},
      {kTruth, kOrb, Alignment::kSim3, {1, StepUnit::kFrames, false}, 31, 0.013834918, 0.884848960},
      {kSfm,
       kFusion,
       Alignment::kSim3,
       {30, StepUnit::kFrames, false},
       16,
       0.037058715,
       1.256921962},
      {kKitti,
       kDeepVo,
       Alignment::kNone,
       {100, StepUnit::kMetres, false},
       16,
       4.816778353,
       0.445064682},
      {kKitti,
       kDeepVo,
       Alignment::kSim3,
       {10, StepUnit::kFrames, true},
       1581,
       0.616818196,
       0.123200822},
  }));
  const std::string truth = recorded_data(figure.truth);
  const std::string estimate = recorded_data(figure.estimate);
  UNISIM_SKIP_WITHOUT(truth);
  UNISIM_SKIP_WITHOUT(estimate);
  INFO(estimate);
  const Rpe rpe = relative_pose_error(read_trajectory(truth), read_trajectory(estimate),
                                      figure.alignment, kMaxDt_s, figure.step);
  REQUIRE(rpe.translation_error.size() == figure.pairs);
  REQUIRE(rpe.translation.rmse == Approx(figure.translation_rmse).margin(kTolerance).epsilon(0));
  REQUIRE(rpe.rotation_deg.rmse == Approx(figure.rotation_rmse_deg).margin(kTolerance).epsilon(0));
}

TEST_CASE("a published KITTI figure comes out") {
  // 7-DoF ATE of sequence 09 in kitti-odom-eval: 8.386619; its estimate begins at frame 2.
  const std::string estimate = recorded_data("eval_pairs/kitti_odom_eval/example_0/09.txt");
  UNISIM_SKIP_WITHOUT(estimate);
  const Ate ate = absolute_trajectory_error(read_trajectory(recorded_data(kKitti)),
                                            read_trajectory(estimate), Alignment::kSim3, kMaxDt_s);
  REQUIRE(ate.pairs.size() == 1589);
  REQUIRE(ate.pairs.front().ground_truth == 2);
  REQUIRE(ate.error.rmse == Approx(8.386619).margin(1e-5));
}
