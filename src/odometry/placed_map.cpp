#include "arfm_vo/odometry/placed_map.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "arfm_vo/base/number_rows.h"
#include "corrected_frame.h"

namespace arfm_vo {
namespace {

constexpr size_t kMaxSettledLandmarks = 20000;  ///< for display
constexpr int kLookInterval = 3;                ///< keyframes, between looking for further frames

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
    if (localiser_.is_kept()) anew.Keep(MakeKnownMap(), options_.max_settled_points);
    *this = std::move(anew);
  }
  if (!global_ || keyframe.epoch != epoch_) StartEpoch(keyframe);
  odom_from_world_ = keyframe.odom_from_world;
  const Keyframe& seen = keyframe.keyframe;
  global_->Add(seen, keyframe.landmarks);
  LandmarkId first_landmark = places_.empty() ? 0 : places_.rbegin()->second.first_landmark;
  if (!keyframe.landmarks.empty()) first_landmark = keyframe.landmarks.front().id;
  places_[seen.id] = {seen.stamp_s, seen.camera_from_world, keyframe.base_from_camera,
                      first_landmark};
  if (localiser_.state() == MapState::kLocalised && num_keyframes() % kLookInterval == 1)
    Localise(global_->store().NewestView(camera_, global_->correction().mean),
             keyframe.odom_from_world * seen.camera_from_world.Inverse());
  return !is_restarted;
}

void PlacedMap::StartEpoch(const PlacedKeyframe& keyframe) {
  CloseEpoch();
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

void PlacedMap::Keep(KnownMap known, size_t max_points) {
  options_.max_settled_points = max_points;
  if (known.correction && !correction_ && options_.learn_correction)
    SetCorrection(known.camera, *known.correction);
  localiser_.Keep(std::move(known), max_points);
}

void PlacedMap::CloseEpoch() {
  if (!localiser_.is_kept()) closed_landmarks_ = Landmarks();
  if (global_) localiser_.Close(NewestPlaces(localiser_.is_kept()), global_->camera());
  places_.clear();
}

KnownMap PlacedMap::MakeKnownMap() const {
  KnownMap map = localiser_.WithNewest(NewestPlaces(true), camera_);
  if (map.camera == camera_) map.correction = correction_;
  return map;
}

void PlacedMap::Localise(const StereoFrame& frame, const Rigid3& odom_from_camera) {
  if (!global_ || localiser_.state() != MapState::kLocalising) return;
  const StereoCorrection& correction = global_->correction().mean;
  Localise(PointsSeen(camera_, correction, Corrected(frame, camera_, correction, Rigid3())),
           odom_from_camera);
}

void PlacedMap::Localise(const std::vector<SeenPoint>& view, const Rigid3& odom_from_camera) {
  if (!localiser_.MayLocalise(camera_)) return;
  const auto new_from_old = localiser_.Localise(view, odom_from_camera, map_from_odom());
  if (!localiser_.found().empty()) news_ = localiser_.found();
  if (new_from_old) frame_.Move(*new_from_old);
}

void PlacedMap::Move(const Rigid3& new_from_old, const StatedPose& stated) {
  localiser_.Move(new_from_old, stated);
  frame_.Move(new_from_old);
  for (LandmarkPoint& point : closed_landmarks_) point.x_in_map = new_from_old * point.x_in_map;
}

std::optional<MapUpdate> PlacedMap::Adjust(const BundleCallback& progress) {
  if (!global_) return std::nullopt;
  const bool is_bent = global_->IsToBeBent();
  std::optional<MapUpdate> update = global_->Adjust(progress);
  if (!update) return std::nullopt;
  correction_ = update->correction;
  const auto newest_place = [&] { return BasePoses().back().map_from_base.translation; };
  const Eigen::Vector3d before = is_bent ? newest_place() : Eigen::Vector3d::Zero();
  frame_.Adjust(global_->MapFromOdom(), odom_from_world_);
  if (is_bent) MoveSettled(*update);
  for (const MapUpdate::KeyframePose& keyframe : update->keyframes) {
    Place& place = places_.at(keyframe.id);
    place.camera_from_world = keyframe.camera_from_world;
    place.is_adjusted = true;
  }
  TakeLandmarks(*update);
  if (is_bent) {
    const double moved_m = (newest_place() - before).norm();
    news_ = "a loop is closed, and the rover's place in the map moved by " +
            FormatNumber(std::round(100 * moved_m) / 100) + " m";
  }
  return update;
}

/// Landmarks that the global map has forgotten stay where the keyframe sees them that saw them
/// first.
void PlacedMap::MoveSettled(const MapUpdate& update) {
  const auto first_from = [&](LandmarkId id) {
    return std::lower_bound(
        adjusted_.begin(), adjusted_.end(), id,
        [](const auto& landmark, LandmarkId other) { return landmark.id < other; });
  };
  auto moved = update.keyframes.begin();
  for (auto place = places_.begin(); place != places_.end(); ++place) {
    while (moved != update.keyframes.end() && moved->id < place->first) ++moved;
    if (moved == update.keyframes.end() || moved->id != place->first) continue;
    if (!place->second.is_adjusted) continue;
    const auto next = std::next(place);
    const Rigid3 shift = moved->camera_from_world.Inverse() * place->second.camera_from_world;
    const auto end =
        next == places_.end() ? adjusted_.end() : first_from(next->second.first_landmark);
    for (auto seen = first_from(place->second.first_landmark); seen != end; ++seen)
      seen->x_in_world = shift * seen->x_in_world;
  }
}

/// Landmarks that the global map has forgotten stay where it left them; too many, and every second
/// one goes.
void PlacedMap::TakeLandmarks(const MapUpdate& update) {
  std::vector<MapUpdate::LandmarkPosition> settled;
  std::copy_if(adjusted_.begin(), adjusted_.end(), std::back_inserter(settled),
               [&](const auto& landmark) { return !global_->Knows(landmark.id); });
  if (settled.size() > kMaxSettledLandmarks) {
    bool is_second = true;
    settled.erase(std::remove_if(settled.begin(), settled.end(),
                                 [&](const auto&) { return is_second = !is_second; }),
                  settled.end());
  }
  std::vector<MapUpdate::LandmarkPosition> all(settled.size() + update.landmarks.size());
  std::merge(settled.begin(), settled.end(), update.landmarks.begin(), update.landmarks.end(),
             all.begin(), [](const auto& a, const auto& b) { return a.id < b.id; });
  adjusted_ = std::move(all);
}

std::vector<KnownKeyframe> PlacedMap::NewestPlaces(bool with_points) const {
  std::vector<KnownKeyframe> places;
  for (const auto& [id, place] : places_) {
    KnownKeyframe& keyframe = places.emplace_back();
    keyframe.stamp_s = place.stamp_s;
    keyframe.map_from_camera = frame_.map_from_world() * CameraFromAdjusted(place).Inverse();
    keyframe.base_from_camera = place.base_from_camera;
    keyframe.frame = localiser_.own_frame();
    if (with_points)
      keyframe.SetPoints(global_->store().PlaceOf(static_cast<int>(places.size()) - 1));
  }
  return places;
}

std::vector<MapPose> PlacedMap::BasePoses() const {
  std::vector<MapPose> poses;
  const auto add = [&](const std::vector<KnownKeyframe>& places) {
    for (const KnownKeyframe& place : places)
      if (place.frame == localiser_.own_frame())
        poses.push_back({place.stamp_s, place.map_from_camera * place.base_from_camera.Inverse()});
  };
  add(localiser_.keyframes());
  add(NewestPlaces(false));
  return poses;
}

std::vector<LandmarkPoint> PlacedMap::Landmarks() const {
  std::vector<LandmarkPoint> points = closed_landmarks_;
  const size_t stride = 1 + NumPoints(localiser_.keyframes()) / kMaxSettledLandmarks;
  for (const KnownKeyframe& keyframe : localiser_.keyframes()) {
    if (keyframe.frame != localiser_.own_frame()) continue;
    for (size_t i = 0; i < keyframe.points.size(); i += stride) {
      const Eigen::Vector3d& x = keyframe.points[i].x_in_place;
      points.push_back({keyframe.map_from_camera * x, static_cast<float>(x.z())});
    }
  }
  auto place = places_.begin(), next = place;  // that saw the landmark first
  for (const auto& [id, x_in_world] : adjusted_) {
    for (; next != places_.end() && next->second.first_landmark <= id; ++next) {
      if (next->second.first_landmark > place->second.first_landmark) place = next;
    }
    const double depth_m = (CameraFromAdjusted(place->second) * x_in_world).z();
    points.push_back({frame_.map_from_world() * x_in_world, static_cast<float>(depth_m)});
  }
  return points;
}

Trajectory PlacedMap::MakeTrajectory() const {
  const std::vector<KnownKeyframe>& closed = localiser_.keyframes();
  const std::vector<KnownKeyframe> places = NewestPlaces(false);
  Trajectory trajectory;
  const auto add = [&](const KnownKeyframe& place) {
    trajectory.push_back({place.stamp_s, place.map_from_camera, true});
  };
  std::for_each(closed.begin() + static_cast<std::ptrdiff_t>(localiser_.first_of_drive()),
                closed.end(), add);
  std::for_each(places.begin(), places.end(), add);
  if (trajectory.empty()) return trajectory;
  const Rigid3 first_from_map = trajectory.front().world_from_camera.Inverse();
  for (TrajectoryPose& pose : trajectory)
    pose.world_from_camera = first_from_map * pose.world_from_camera;
  return trajectory;
}

}  // namespace arfm_vo
