// SPDX-License-Identifier: MIT
// How far keyframe poses may be off when their segment is laid over the truth.
#include "tools/replay/pose_sigmas.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace unisim::replay {
namespace {

using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Gradient = Eigen::Matrix<double, 3, 7>;  // of a position by the seven of a similarity

// What is taken out: a similarity, then a turn of the camera in its mounting.
constexpr int kTakenOut = 10;
using Taken = Eigen::Matrix<double, kTakenOut, 7>;
using Given = Eigen::Matrix<double, 7, kTakenOut>;
using MatrixT = Eigen::Matrix<double, kTakenOut, kTakenOut>;

// Moments of positions below this share of the largest: on a line, the turn about it is open.
constexpr double kStraight = 1e-9;
constexpr size_t kLeastPoses = 3;

struct AlignedPose {
  size_t index;  // among the poses handed in
  int32_t keyframe;
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
  double s = 1.0;
  Gradient of_alignment;  // d position
  Given moved;            // d tangent of the pose by what is taken out
  Taken part;             // of the pose's error in what is taken out
  Matrix7 covariance;
};

AlignedPose read(const unisim_pose& pose, size_t index) {
  const unisim_sim3& T = pose.T_world_kf;
  AlignedPose out;
  out.index = index;
  out.keyframe = pose.keyframe_id;
  out.R = Eigen::Quaterniond(T.q[3], T.q[0], T.q[1], T.q[2]).toRotationMatrix();
  out.t = Eigen::Vector3d(T.t[0], T.t[1], T.t[2]);
  out.s = T.s;
  return out;
}

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d out;
  out << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return out;
}

/// Of a symmetric matrix, directions that nothing says anything about left out.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& moments) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(moments);
  Eigen::VectorXd values = solver.eigenvalues();
  const double least = kStraight * values.maxCoeff();
  for (double& value : values) value = value > least ? 1.0 / value : 0.0;
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

/// A similarity moves p by t + phi x (p - c) + sigma (p - c), c the mean of the positions. What of
/// the rotations it leaves has a mean, as seen from the camera.
void describe_alignment(std::vector<AlignedPose>* poses) {
  const double share = 1.0 / static_cast<double>(poses->size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const AlignedPose& pose : *poses) mean += share * pose.t;
  Matrix7 moments = Matrix7::Zero();
  Gradient mean_turn = Gradient::Zero();  // by the similarity
  for (AlignedPose& pose : *poses) {
    const Eigen::Vector3d arm = pose.t - mean;
    pose.of_alignment << Eigen::Matrix3d::Identity(), -cross(arm), arm;
    moments += pose.of_alignment.transpose() * pose.of_alignment;
    mean_turn.block<3, 3>(0, 3) += share * pose.R.transpose();
  }
  Matrix7 inverse = Matrix7::Zero();
  inverse.topLeftCorner<3, 3>() = moments.topLeftCorner<3, 3>().inverse();
  inverse.block<3, 3>(3, 3) = pseudo_inverse(moments.block<3, 3>(3, 3));
  inverse(6, 6) = 1.0 / moments(6, 6);
  for (AlignedPose& pose : *poses) {
    pose.part.setZero();
    pose.part.topLeftCorner<7, 3>() = inverse * pose.of_alignment.transpose() * (pose.s * pose.R);
    pose.part.block<3, 3>(7, 3) = share * Eigen::Matrix3d::Identity();
    pose.moved.setZero();
    pose.moved.topLeftCorner<3, 7>() = pose.R.transpose() / pose.s * pose.of_alignment;
    pose.moved.block<3, 3>(3, 3) = pose.R.transpose();
    pose.moved.block<3, 7>(3, 0) -= mean_turn;
    pose.moved.block<3, 3>(3, 7) = Eigen::Matrix3d::Identity();
    pose.moved(6, 6) = 1.0;
  }
}

/// Takes it out of covariances in the frame of the first keyframe.
bool take_out_alignment(unisim_session* session, std::vector<AlignedPose>* poses) {
  const int32_t first = poses->front().keyframe;
  const int32_t count = poses->back().keyframe - first + 1;
  Eigen::MatrixXd weights(7, count);
  Eigen::MatrixXd products(7, count);
  std::vector<Taken> with_taken(poses->size());  // covariance of what is taken out with each error
  MatrixT of_taken = MatrixT::Zero();
  for (int k = 0; k < kTakenOut; ++k) {
    weights.setZero();
    for (const AlignedPose& pose : *poses) weights.col(pose.keyframe - first) = pose.part.row(k);
    if (unisim_multiply_covariance(session, first, count, weights.data(), products.data()) !=
        UNISIM_OK) {
      return false;
    }
    for (size_t i = 0; i < poses->size(); ++i) {
      const AlignedPose& pose = (*poses)[i];
      const Eigen::Matrix<double, 7, 1> product = products.col(pose.keyframe - first);
      with_taken[i].row(k) = product.transpose();
      of_taken.row(k) += (pose.part * product).transpose();
    }
  }
  for (size_t i = 0; i < poses->size(); ++i) {
    AlignedPose& pose = (*poses)[i];
    const Matrix7 shared = pose.moved * with_taken[i];
    pose.covariance += pose.moved * of_taken * pose.moved.transpose() - shared - shared.transpose();
  }
  return true;
}

double root(double variance) { return std::sqrt(std::max(variance, 0.0)); }

void add_segment(unisim_session* session, std::vector<AlignedPose> poses,
                 std::vector<PoseSigma>* out) {
  if (poses.size() < kLeastPoses) return;
  describe_alignment(&poses);
  for (const AlignedPose& pose : poses) {
    if (!pose.part.allFinite()) return;  // it does not move
  }
  if (!take_out_alignment(session, &poses)) return;
  for (const AlignedPose& pose : poses) {
    (*out)[pose.index] = {pose.s * root(pose.covariance.topLeftCorner<3, 3>().trace()),
                          root(pose.covariance.block<3, 3>(3, 3).trace())};
  }
}

}  // namespace

std::vector<PoseSigma> pose_sigmas(unisim_session* session, const std::vector<unisim_pose>& poses) {
  std::vector<PoseSigma> out(poses.size());
  std::vector<int32_t> segments;
  for (const unisim_pose& pose : poses) segments.push_back(pose.segment);
  std::sort(segments.begin(), segments.end());
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
  for (const int32_t segment : segments) {
    std::vector<AlignedPose> kept;
    for (size_t i = 0; i < poses.size(); ++i) {
      if (poses[i].segment != segment || poses[i].confidence == 0) continue;
      AlignedPose pose = read(poses[i], i);
      if (unisim_get_covariance(session, pose.keyframe, pose.covariance.data()) == UNISIM_OK) {
        kept.push_back(pose);
      }
    }
    add_segment(session, std::move(kept), &out);
  }
  return out;
}

}  // namespace unisim::replay
