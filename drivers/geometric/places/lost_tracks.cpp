// SPDX-License-Identifier: MIT
// Tracks that Lucas-Kanade lost between two keyframes are looked for by what the images look like.
#include "drivers/geometric/places/lost_tracks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "drivers/geometric/image/frame_tracker.hpp"

namespace unisim::geometric {

namespace {

// Where Lucas-Kanade keeps enough, features only bring in points that are measured less well: those
// that are left must be few in share and in number.
constexpr double kFewShare = 0.5;
constexpr double kFewOfMost = 0.375;
constexpr float kSameCorner = 4.0F;    // pixels: one corner, at several scales
constexpr double kEpipolarGate = 1.5;  // pixels at the reference diagonal
constexpr int kMotionRounds = 1000;
constexpr size_t kLeastPairs = 15;  // pairs that one motion explains
constexpr size_t kNearSeeds = 6;    // features that say how the image around a point has moved
constexpr double kMostZoom = 3.0;
constexpr double kLostReach = 16.0;  // pixels at the reference diagonal from where it should be

/// Numbers features so that those of one corner share a number: that of the first.
void number_corners(const std::vector<cv::Point2f>& points, std::vector<int32_t>* corners) {
  corners->resize(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    (*corners)[i] = static_cast<int32_t>(i);
    for (size_t k = 0; k < i; ++k) {
      const cv::Point2f away = points[i] - points[k];
      if ((*corners)[k] != static_cast<int32_t>(k)) continue;
      if (away.dot(away) > kSameCorner * kSameCorner) continue;
      (*corners)[i] = static_cast<int32_t>(k);
      break;
    }
  }
}

cv::Point2f straight(const CameraModel& camera, const cv::Point2f& p) {
  const Eigen::Vector2d at = camera.undistort({p.x, p.y});
  return {static_cast<float>(at.x()), static_cast<float>(at.y())};
}

/// From the pixels of a tile, with `from` in its middle, to those of the image it is cut from.
cv::Matx23d out_of_tile(const cv::Matx23d& motion, const cv::Point2f& from) {
  const cv::Matx22d back = motion.get_minor<2, 2>(0, 0).inv();
  const cv::Vec2d middle = back * cv::Vec2d(kPatchSide / 2, kPatchSide / 2);
  return {back(0, 0), back(0, 1), from.x - middle[0], back(1, 0), back(1, 1), from.y - middle[1]};
}

}  // namespace

void LostTracks::reserve(int most, size_t tracks) {
  most_ = most;
  points_.reserve(tracks);
  landmarks_.reserve(tracks);
  generations_.reserve(tracks);
}

void LostTracks::note_keyframe(const State& state) {
  points_ = state.tracks.point;
  landmarks_ = state.tracks.landmark;
  generations_.clear();
  for (const int32_t slot : landmarks_) {
    generations_.push_back(state.map.landmark(slot).generation);
  }
  before_known_ = now_known_;
  now_known_ = false;
}

bool LostTracks::many(const Tracks& tracks) const {
  const auto left =
      static_cast<double>(std::count(tracks.sealed.begin(), tracks.sealed.end(), uint8_t{1}));
  return left < kFewShare * static_cast<double>(points_.size()) && left < kFewOfMost * most_;
}

/// Features of the two images that look like each other and like no other corner.
void LostTracks::find_seeds(const PreparedImage& keyframe, const PreparedImage& current) {
  if (before_known_) {
    std::swap(before_, now_);
  } else {
    orb_->describe(keyframe.gray, &before_);
  }
  orb_->describe(current.gray, &now_);
  now_known_ = true;
  number_corners(before_.point, &corners_);
  descriptors_.resize(before_.point.size());
  for (size_t i = 0; i < descriptors_.size(); ++i) {
    const auto* row = before_.descriptor.ptr<uint8_t>(static_cast<int>(i));
    std::copy(row, row + kOrbBytes, descriptors_[i].begin());
  }
  match_features(now_, descriptors_, corners_, before_.point.size(), kOrbFeatures, &matches_);
  seeds_.clear();
  for (const FeaturePair& match : matches_) {
    seeds_.push_back({0, before_.point[static_cast<size_t>(match.group)],
                      now_.point[static_cast<size_t>(match.feature)]});
  }
}

/// Keeps those of `pairs` that one motion of the camera explains together with the surviving
/// tracks, and marks the surviving tracks that it does not explain. @return false: too few to tell
bool LostTracks::explain(const State& state, std::vector<Pair>* pairs) {
  const CameraModel& camera = state.intrinsics.camera;
  const Tracks& tracks = state.tracks;
  from_.clear();
  to_.clear();
  for (const Pair& pair : *pairs) {
    from_.push_back(straight(camera, pair.from));
    to_.push_back(straight(camera, pair.to));
  }
  for (size_t i = 0; i < tracks.size(); ++i) {
    if (!tracks.sealed[i]) continue;
    from_.push_back(straight(camera, tracks.keyframe_point[i]));
    to_.push_back(straight(camera, tracks.point[i]));
  }
  bad_.assign(tracks.size(), 0);
  if (from_.size() < kLeastPairs) return false;
  cv::Mat explained;
  cv::findFundamentalMat(from_, to_, cv::USAC_MAGSAC, kEpipolarGate * state.pixel_scale, 0.999,
                         kMotionRounds, explained);
  if (explained.total() != from_.size()) return false;
  if (cv::countNonZero(explained) < static_cast<int>(kLeastPairs)) return false;
  int next = 0;
  size_t kept = 0;
  for (const Pair& pair : *pairs) {
    if (explained.at<uint8_t>(next++)) (*pairs)[kept++] = pair;
  }
  pairs->resize(kept);
  for (size_t i = 0; i < tracks.size(); ++i) {
    if (tracks.sealed[i]) bad_[i] = explained.at<uint8_t>(next++) ? 0 : 1;
  }
  return true;
}

/// How the image near a point has moved, been turned and scaled: the similarity that fits the
/// nearest features best. @return false: not known
bool LostTracks::motion_near(const cv::Point2f& from, cv::Matx23d* motion) const {
  if (seeds_.size() < kNearSeeds) return false;
  std::array<std::pair<float, size_t>, kNearSeeds> near;
  near.fill({std::numeric_limits<float>::max(), 0});
  for (size_t s = 0; s < seeds_.size(); ++s) {
    const cv::Point2f away = seeds_[s].from - from;
    if (away.dot(away) >= near.back().first) continue;
    near.back() = {away.dot(away), s};
    std::sort(near.begin(), near.end());
  }
  cv::Point2d mean_from;
  cv::Point2d mean_to;
  for (const auto& [distance, s] : near) {
    mean_from += cv::Point2d(seeds_[s].from) / static_cast<double>(kNearSeeds);
    mean_to += cv::Point2d(seeds_[s].to) / static_cast<double>(kNearSeeds);
  }
  double along = 0;
  double across = 0;
  double spread = 0;
  for (const auto& [distance, s] : near) {
    const cv::Point2d a = cv::Point2d(seeds_[s].from) - mean_from;
    const cv::Point2d b = cv::Point2d(seeds_[s].to) - mean_to;
    along += a.dot(b);
    across += a.cross(b);
    spread += a.dot(a);
  }
  if (!(spread > 0)) return false;
  const double c = along / spread;
  const double s = across / spread;
  const double zoom = std::hypot(c, s);
  if (zoom > kMostZoom || zoom < 1 / kMostZoom) return false;
  *motion = {c, -s, mean_to.x - c * mean_from.x + s * mean_from.y,
             s, c,  mean_to.y - s * mean_from.x - c * mean_from.y};
  return true;
}

/// Tracks that are lost and whose landmarks are still there, where they should be now.
void LostTracks::expect_lost(const State& state) {
  alive_.assign(static_cast<size_t>(state.map.landmark_capacity()), 0);
  for (const int32_t slot : state.tracks.landmark) alive_[static_cast<size_t>(slot)] = 1;
  expected_.clear();
  motions_.clear();
  for (size_t i = 0; i < points_.size(); ++i) {
    const Landmark& mark = state.map.landmark(landmarks_[i]);
    if (alive_[static_cast<size_t>(landmarks_[i])] || mark.state == LandmarkState::kFree) continue;
    cv::Matx23d motion;
    if (mark.generation != generations_[i] || !motion_near(points_[i], &motion)) continue;
    const cv::Vec2d at = motion * cv::Vec3d(points_[i].x, points_[i].y, 1);
    const cv::Point2f to(static_cast<float>(at[0]), static_cast<float>(at[1]));
    if (!inside_image(to, state.size, kTrackMargin)) continue;
    expected_.push_back({i, points_[i], to});
    motions_.push_back(motion);
  }
}

void LostTracks::find_patches(const PreparedImage& keyframe, const PreparedImage& current,
                              const State& state) {
  found_.clear();
  const cv::Point2f middle(kPatchSide / 2, kPatchSide / 2);
  const auto draw = [&](size_t i, size_t j) {
    cv::Mat tile = atlas_->tile(j);
    cv::warpAffine(keyframe.gray, tile, out_of_tile(motions_[i], expected_[i].from), tile.size(),
                   cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
    atlas_->add(cv::Point2f(atlas_->corner(j)) + middle, expected_[i].to);
  };
  const auto take = [&](size_t i, size_t j) {
    if (!atlas_->found(j, current, kLostReach * state.pixel_scale, kTrackMargin)) return;
    found_.push_back({expected_[i].track, expected_[i].from, atlas_->found_at(j)});
  };
  atlas_->look_for(expected_.size(), current, kMinTexture, draw, [] {}, take);
}

int LostTracks::run(const PreparedImage& keyframe, const PreparedImage& current,
                    const cv::Point2f& flow, State* state) {
  find_seeds(keyframe, current);
  if (!explain(*state, &seeds_)) return 0;
  expect_lost(*state);
  find_patches(keyframe, current, *state);
  if (!explain(*state, &found_)) return 0;
  state->tracks.remove(bad_);
  for (const Pair& pair : found_) state->tracks.add(pair.to, flow, landmarks_[pair.track]);
  return static_cast<int>(found_.size());
}

int64_t LostTracks::bytes() const {
  const size_t track = sizeof(cv::Point2f) + sizeof(int32_t) + sizeof(uint32_t) + 3 * sizeof(Pair) +
                       sizeof(cv::Matx23d);
  const size_t feature = 2 * (sizeof(cv::Point2f) + kOrbBytes) + kOrbBytes + sizeof(Pair);
  return static_cast<int64_t>(points_.capacity() * track + kOrbFeatures * feature);
}

}  // namespace unisim::geometric
