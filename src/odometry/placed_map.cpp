#include "arfm_vo/odometry/placed_map.h"

#include <iterator>

namespace arfm_vo {
namespace {

constexpr int kMaxSettledLandmarks = 20000;  ///< for display

}  // namespace

bool PlacedMap::IsRestarted(const PlacedKeyframe& keyframe) const {
  if (places_.empty()) return false;
  const auto& [newest_id, newest] = *places_.rbegin();
  return keyframe.epoch < epoch_ || keyframe.keyframe.stamp_s < newest.stamp_s ||
         (keyframe.epoch == epoch_ && keyframe.keyframe.id <= newest_id);
}

bool PlacedMap::Add(const PlacedKeyframe& keyframe) {
  const bool is_restarted = IsRestarted(keyframe);
  if (is_restarted) {
    PlacedMap anew(options_);
    if (correction_) anew.SetCorrection(camera_, *correction_);
    *this = std::move(anew);
  }
  if (!global_ || keyframe.epoch != epoch_) StartEpoch(keyframe);
  const Keyframe& seen = keyframe.keyframe;
  global_->Add(seen, keyframe.landmarks);
  places_[seen.id] = {seen.stamp_s, seen.camera_from_world, keyframe.base_from_camera};
  for (const Landmark& landmark : keyframe.landmarks)
    first_depths_m_[landmark.id] =
        static_cast<float>((seen.camera_from_world * landmark.x_in_world).z());
  return !is_restarted;
}

void PlacedMap::StartEpoch(const PlacedKeyframe& keyframe) {
  closed_landmarks_ = Landmarks();
  closed_places_ = Places();
  places_.clear();
  first_depths_m_.clear();
  adjusted_.clear();
  epoch_ = keyframe.epoch;
  if (!correction_ || !(camera_ == keyframe.camera)) {
    SetCorrection(keyframe.camera, options_.learn_correction
                                       ? CorrectionBelief::OfCalibration(keyframe.camera)
                                       : CorrectionBelief::OfExactCalibration());
  }
  global_.emplace(keyframe.camera, options_, *correction_);
  frame_.StartEpoch(keyframe.odom_from_world);
}

std::optional<MapUpdate> PlacedMap::Adjust(const BundleCallback& progress) {
  if (!global_) return std::nullopt;
  std::optional<MapUpdate> update = global_->Adjust(progress);
  if (!update) return std::nullopt;
  correction_ = update->correction;
  frame_.Adjust(global_->MapFromOdom());
  for (const MapUpdate::KeyframePose& keyframe : update->keyframes) {
    Place& place = places_.at(keyframe.id);
    place.camera_from_world = keyframe.camera_from_world;
    place.is_adjusted = true;
  }
  TakeLandmarks(*update);
  return update;
}

/// Landmarks that the global map has forgotten stay where it left them; too many, and every second
/// one goes.
void PlacedMap::TakeLandmarks(const MapUpdate& update) {
  int num_settled = 0;
  for (auto landmark = adjusted_.begin(); landmark != adjusted_.end();) {
    const bool is_known = global_->Knows(landmark->first);
    num_settled += !is_known;
    landmark = is_known ? adjusted_.erase(landmark) : std::next(landmark);
  }
  if (num_settled > kMaxSettledLandmarks) {
    bool is_second = false;
    for (auto landmark = adjusted_.begin(); landmark != adjusted_.end(); is_second = !is_second)
      landmark = is_second ? adjusted_.erase(landmark) : std::next(landmark);
  }
  for (const MapUpdate::LandmarkPosition& landmark : update.landmarks)
    adjusted_[landmark.id] = landmark.x_in_world;
  for (auto depth = first_depths_m_.begin(); depth != first_depths_m_.end();) {
    const bool is_needed = global_->Knows(depth->first) || adjusted_.count(depth->first) > 0;
    depth = is_needed ? std::next(depth) : first_depths_m_.erase(depth);
  }
}

std::vector<PlacedMap::ClosedPlace> PlacedMap::Places() const {
  const Rigid3 world_from_adjusted = AdjustedFromWorld().Inverse();
  std::vector<ClosedPlace> places = closed_places_;
  for (const auto& [id, place] : places_) {
    const Rigid3 camera_from_adjusted =
        place.is_adjusted ? place.camera_from_world : place.camera_from_world * world_from_adjusted;
    places.push_back({place.stamp_s, frame_.map_from_world() * camera_from_adjusted.Inverse(),
                      place.base_from_camera});
  }
  return places;
}

std::vector<MapPose> PlacedMap::BasePoses() const {
  std::vector<MapPose> poses;
  for (const ClosedPlace& place : Places())
    poses.push_back({place.stamp_s, place.map_from_camera * place.base_from_camera.Inverse()});
  return poses;
}

std::vector<LandmarkPoint> PlacedMap::Landmarks() const {
  std::vector<LandmarkPoint> points = closed_landmarks_;
  for (const auto& [id, x_in_world] : adjusted_)
    points.push_back({frame_.map_from_world() * x_in_world, first_depths_m_.at(id)});
  return points;
}

Trajectory PlacedMap::MakeTrajectory() const {
  Trajectory trajectory;
  const std::vector<ClosedPlace> places = Places();
  for (const ClosedPlace& place : places)
    trajectory.push_back(
        {place.stamp_s, places.front().map_from_camera.Inverse() * place.map_from_camera, true});
  return trajectory;
}

}  // namespace arfm_vo
