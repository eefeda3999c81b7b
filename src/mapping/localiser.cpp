#include "arfm_vo/mapping/localiser.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

constexpr double kStatedProbability = 0.99;  ///< that a place agrees with a statement that is right

}  // namespace

void Localiser::Keep(KnownMap known, size_t max_points) {
  max_points_ = max_points;
  map_ = std::move(known);
  first_of_drive_ = map_.keyframes.size();
  if (!map_.keyframes.empty()) {
    finder_.emplace(map_.camera);
    finder_->Add(map_.keyframes, 0);
  }
  BeginEpoch();
}

void Localiser::BeginEpoch() {
  is_localised_ = false;
  stated_.reset();
  if (finder_) finder_->ForgetSightings();
  for (const KnownKeyframe& keyframe : map_.keyframes)
    if (is_kept()) own_frame_ = std::max(own_frame_, keyframe.frame + 1);
}

void Localiser::Close(std::vector<KnownKeyframe> epoch, const StereoCamera& camera) {
  if (epoch.empty()) return;
  const size_t first = map_.keyframes.size();
  if (!finder_ && is_kept()) {
    map_.camera = camera;
    finder_.emplace(camera);
  }
  for (KnownKeyframe& keyframe : epoch) {
    if (!is_kept() || !(camera == map_.camera)) keyframe.points = Place();
    map_.keyframes.push_back(std::move(keyframe));
  }
  if (finder_) {
    KeepDistinct(map_.keyframes, first);
    finder_->Add(map_.keyframes, first);
    if (NumPoints(map_.keyframes) > max_points_) {
      KeepAtMost(max_points_, map_.keyframes);
      finder_.emplace(map_.camera);
      finder_->Add(map_.keyframes, 0);
    }
  }
  BeginEpoch();
}

KnownMap Localiser::WithNewest(std::vector<KnownKeyframe> epoch, const StereoCamera& camera) const {
  KnownMap map = map_;
  if (map.keyframes.empty()) map.camera = camera;
  if (camera == map.camera) {
    for (KnownKeyframe& keyframe : epoch) map.keyframes.push_back(std::move(keyframe));
    KeepDistinct(map.keyframes, map_.keyframes.size());
  }
  std::set<int> seen;  // nothing can be found in others
  for (const KnownKeyframe& keyframe : map.keyframes)
    if (!keyframe.points.empty()) seen.insert(keyframe.frame);
  const auto is_unseen = [&](const KnownKeyframe& keyframe) { return !seen.count(keyframe.frame); };
  map.keyframes.erase(std::remove_if(map.keyframes.begin(), map.keyframes.end(), is_unseen),
                      map.keyframes.end());
  return map;
}

MapState Localiser::state() const {
  if (is_localised_) return MapState::kLocalised;
  return KnowsOtherFrames() ? MapState::kLocalising : MapState::kNewMap;
}

/// Of which something is kept to be recognised by.
bool Localiser::KnowsOtherFrames() const {
  const auto is_other = [this](const KnownKeyframe& keyframe) {
    return !keyframe.points.empty() && keyframe.frame != own_frame_;
  };
  return std::any_of(map_.keyframes.begin(), map_.keyframes.end(), is_other);
}

std::optional<Rigid3> Localiser::Localise(const std::vector<SeenPoint>& view,
                                          const Rigid3& odom_from_camera,
                                          const Rigid3& map_from_odom) {
  const auto place = finder_->Find(view, odom_from_camera, map_.keyframes, own_frame_);
  if (!place) return std::nullopt;
  const Rigid3 other_from_own =
      place->map_from_camera * (map_from_odom * odom_from_camera).Inverse();
  const KnownKeyframe& keyframe = map_.keyframes[place->keyframe];
  const double aside_m =
      (keyframe.map_from_camera.translation - place->map_from_camera.translation).norm();
  found_ = "keyframe " + std::to_string(place->keyframe) + " of the map, " +
           FormatNumber(std::round(100 * aside_m) / 100) + " m from it";
  if (Contradicts(other_from_own * map_from_odom)) {
    found_ += ": not taken, it contradicts where the rover is stated to stand";
    return std::nullopt;
  }
  const int older = std::min(keyframe.frame, own_frame_);
  const int newer = std::max(keyframe.frame, own_frame_);
  const bool moves = newer == own_frame_;
  is_localised_ = true;
  MoveFrame(newer, older, moves ? other_from_own : other_from_own.Inverse());
  if (!moves) return std::nullopt;
  return other_from_own;
}

bool Localiser::Contradicts(const Rigid3& map_from_odom) const {
  if (!stated_ || stated_->covariance.isZero(0)) return false;
  const Rigid3 found = map_from_odom * stated_->odom_from_base;
  const Eigen::Vector3d moved = found.translation - stated_->map_from_base.translation;
  const double turned = LogSO3(found.rotation * stated_->map_from_base.rotation.conjugate()).z();
  const Eigen::Vector3d error(moved.x(), moved.y(), turned);
  return SquaredMahalanobis(error, stated_->covariance) > ChiSquareQuantile(3, kStatedProbability);
}

void Localiser::MoveFrame(int from, int to, const Rigid3& to_from_from) {
  for (KnownKeyframe& keyframe : map_.keyframes) {
    if (keyframe.frame != from) continue;
    keyframe.frame = to;
    keyframe.map_from_camera = to_from_from * keyframe.map_from_camera;
  }
  if (finder_) finder_->ForgetSightings();
  if (own_frame_ == from) own_frame_ = to;
}

void Localiser::Move(const Rigid3& new_from_old, const StatedPose& stated) {
  BeginEpoch();
  stated_ = stated;
  MoveFrame(own_frame_, own_frame_, new_from_old);
}

}  // namespace arfm_vo
