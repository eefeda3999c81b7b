#include "arfm_vo/mapping/local_map.h"

#include <algorithm>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/pixel_scale.h"
#include "neighbour_evidence.h"
#include "occupancy_grid.h"

namespace arfm_vo {
namespace {

/// What a match that no pose explains counts against a landmark: it is wrong as a rule.
constexpr double kMismatch = 0.3;

}  // namespace

void LocalMapOptions::Check() const {
  Require(max_keyframes >= 2, "local_map.max_keyframes must be at least 2");
  Require(max_missed_frames >= 1, "local_map.max_missed_frames must be at least 1");
  Require(max_landmarks_in_view >= 10, "local_map.max_landmarks_in_view must be at least 10");
  Require(grid_cell_px >= 8, "local_map.grid_cell_px must be at least 8");
  Require(min_separation_px > 0 && min_separation_px <= grid_cell_px,
          "local_map.min_separation_px must be in (0, grid_cell_px]");
}

LocalMap::LocalMap(const StereoCamera& camera, const LocalMapOptions& options)
    : camera_(camera), options_(options) {
  camera.Check();
  options.Check();
}

const Keyframe& LocalMap::AddKeyframe(const StereoFrame& frame, const cv::Mat& left,
                                      const Rigid3& camera_from_world,
                                      const LandmarkObservations& tracked,
                                      const LandmarkObservations& contradicting) {
  Keyframe keyframe;
  keyframe.id = next_keyframe_++;
  keyframe.stamp_s = frame.stamp_s;
  keyframe.camera_from_world = camera_from_world;
  keyframe.first_landmark = next_landmark_;
  left.copyTo(spare_image_);
  keyframe.left = std::move(spare_image_);
  keyframe.left_halved = Halve(left);
  for (const LandmarkObservation& observation : tracked) {
    const auto landmark = landmarks_.find(observation.landmark);
    if (landmark == landmarks_.end()) continue;
    ++landmark->second.num_keyframes;
    keyframe.observations.push_back(observation);
  }
  AddNewLandmarks(frame, contradicting, keyframe);
  keyframes_.push_back(std::move(keyframe));
  if (static_cast<int>(keyframes_.size()) > options_.max_keyframes) RemoveOldestKeyframe();
  return keyframes_.back();
}

void LocalMap::AddNewLandmarks(const StereoFrame& frame, const LandmarkObservations& contradicting,
                               Keyframe& keyframe) {
  const auto cell_px = static_cast<int>(options_.grid_cell_px * PixelScale(camera_.width));
  OccupancyGrid grid(camera_.width, camera_.height, cell_px, options_.min_separation_px);
  for (const LandmarkObservation& known : keyframe.observations) {
    grid.Add(known.pixels.x(), known.pixels.y());
  }
  const Keyframe* before = keyframes_.empty() ? nullptr : &keyframes_.back();
  const NeighbourEvidence neighbours(camera_, landmarks_, keyframe, before, contradicting, cell_px);
  arrived_ = 1 - (1 - arrived_) * (1 - neighbours.arrived());
  std::vector<const StereoPoint*> candidates;
  for (const StereoPoint& point : frame.points) candidates.push_back(&point);
  std::stable_sort(candidates.begin(), candidates.end(), [&](const auto* a, const auto* b) {
    return frame.features.keypoints[a->keypoint].response >
           frame.features.keypoints[b->keypoint].response;
  });
  // Emptier cells first: each round allows one point more in a cell.
  int room = options_.max_landmarks_in_view - static_cast<int>(keyframe.observations.size());
  for (int allowed = 1; room > 0 && !candidates.empty(); ++allowed) {
    std::vector<const StereoPoint*> later;
    for (const StereoPoint* point : candidates) {
      const double u = point->observation.x(), v = point->observation.y();
      if (!grid.IsFree(u, v)) continue;
      if (room == 0 || grid.Count(u, v) >= allowed) {
        later.push_back(point);
        continue;
      }
      grid.Add(u, v);
      Landmark& landmark = AddLandmark(frame, *point, keyframe);
      landmark.num_beside = neighbours.NumBeside(u, v);
      landmark.num_contradicted = neighbours.NumContradicted(u, v);
      landmark.doubt = neighbours.Doubt(u, v);
      --room;
    }
    candidates = std::move(later);
  }
}

Landmark& LocalMap::AddLandmark(const StereoFrame& frame, const StereoPoint& point,
                                Keyframe& keyframe) {
  const Rigid3 world_from_camera = keyframe.camera_from_world.Inverse();
  const Eigen::Matrix3d rotation = world_from_camera.RotationMatrix();
  Landmark landmark;
  landmark.id = next_landmark_++;
  landmark.x_in_world = world_from_camera * point.x_in_camera;
  landmark.covariance = rotation * PointCovariance(camera_, point) * rotation.transpose();
  landmark.normal_in_world = rotation * SurfaceNormal(camera_, point);
  landmark.reference = keyframe.id;
  landmark.keypoint = frame.features.keypoints[point.keypoint];
  landmark.keypoint.x = static_cast<float>(point.observation.x());
  landmark.keypoint.y = static_cast<float>(point.observation.y());
  std::copy_n(frame.features.descriptors.ptr<float>(point.keypoint), 64,
              landmark.descriptor.begin());
  landmark.num_keyframes = 1;

  LandmarkObservation observation;
  observation.landmark = landmark.id;
  observation.pixels << point.observation.cast<float>(),
      static_cast<float>(point.observation.y() + point.row_residual_px);
  observation.has_right = point.has_right;
  observation.sigma_px = static_cast<float>(point.sigma_px);
  keyframe.observations.push_back(observation);
  return landmarks_.emplace_hint(landmarks_.end(), landmark.id, landmark)->second;
}

void LocalMap::RemoveOldestKeyframe() {
  Keyframe removed = std::move(keyframes_.front());
  keyframes_.pop_front();
  if (!removed.left.u || removed.left.u->refcount == 1) spare_image_ = std::move(removed.left);
  for (const LandmarkObservation& observation : removed.observations) {
    const auto found = landmarks_.find(observation.landmark);
    if (found == landmarks_.end()) continue;
    if (--found->second.num_keyframes > 0 && found->second.reference == removed.id) {
      MoveReference(found->second, removed.camera_from_world);
    }
  }
  Landmarks::sequence_type all = landmarks_.extract_sequence();  // removes many in one go
  const auto is_unseen = [](const auto& entry) { return entry.second.num_keyframes == 0; };
  all.erase(std::remove_if(all.begin(), all.end(), is_unseen), all.end());
  landmarks_.adopt_sequence(boost::container::ordered_unique_range, std::move(all));
}

void LocalMap::MoveReference(Landmark& landmark, const Rigid3& old_from_world) const {
  for (const Keyframe& keyframe : keyframes_) {
    const auto* observation = FindObservation(keyframe.observations, landmark.id);
    if (observation == nullptr) continue;
    landmark.reference = keyframe.id;
    const double old_z = (old_from_world * landmark.x_in_world).z();
    const double z = (keyframe.camera_from_world * landmark.x_in_world).z();
    if (old_z > 0 && z > 0) landmark.keypoint.scale *= static_cast<float>(old_z / z);
    landmark.keypoint.x = static_cast<float>(observation->pixels.x());
    landmark.keypoint.y = static_cast<float>(observation->pixels.y());
    return;
  }
}

std::vector<const Landmark*> LocalMap::LandmarksInView(const Rigid3& camera_from_world,
                                                       double border_px) const {
  std::vector<const Landmark*> in_view;
  for (const auto& [id, landmark] : landmarks_) {
    if (landmark.num_missed >= options_.max_missed_frames) continue;
    const Eigen::Vector3d x = camera_from_world * landmark.x_in_world;
    if (x.z() <= camera_.baseline_m) continue;
    if (camera_.Contains(camera_.Project(x), border_px)) in_view.push_back(&landmark);
  }
  return in_view;
}

void LocalMap::CountSightings(const std::vector<LandmarkId>& expected,
                              const LandmarkObservations& tracked, double probability) {
  for (const LandmarkId id : expected) {
    const auto found = landmarks_.find(id);
    if (found == landmarks_.end()) continue;
    Landmark& landmark = found->second;
    const bool is_seen = FindObservation(tracked, id) != nullptr;
    landmark.num_missed = is_seen ? 0 : landmark.num_missed + 1;
    if (is_seen) landmark.CountAgreed(probability);
  }
}

void LocalMap::CountContradictions(const LandmarkObservations& contradicting,
                                   const LandmarkObservations& of_rival,
                                   const LandmarkObservations& tracked, double probability) {
  for (const LandmarkObservation& other : contradicting) {
    const auto found = landmarks_.find(other.landmark);
    if (found == landmarks_.end() || FindObservation(tracked, other.landmark)) continue;
    const double weight = FindObservation(of_rival, other.landmark) ? 1 : kMismatch;
    found->second.CountContradicted(probability, weight);
  }
}

std::vector<Landmark> LocalMap::NewestLandmarks() const {
  std::vector<Landmark> newest;
  const auto first = landmarks_.lower_bound(keyframes_.back().first_landmark);
  for (auto found = first; found != landmarks_.end(); ++found) newest.push_back(found->second);
  return newest;
}

const Keyframe* LocalMap::FindKeyframe(KeyframeId id) const {
  for (const Keyframe& keyframe : keyframes_) {
    if (keyframe.id == id) return &keyframe;
  }
  return nullptr;
}

void LocalMap::MoveKeyframe(KeyframeId id, const Rigid3& camera_from_world) {
  for (Keyframe& keyframe : keyframes_) {
    if (keyframe.id == id) keyframe.camera_from_world = camera_from_world;
  }
}

void LocalMap::MoveLandmark(LandmarkId id, const Eigen::Vector3d& x_in_world,
                            const Eigen::Matrix3d& covariance) {
  const auto found = landmarks_.find(id);
  if (found == landmarks_.end()) return;
  found->second.x_in_world = x_in_world;
  found->second.covariance = covariance;
}

void LocalMap::RemoveObservation(KeyframeId keyframe_id, LandmarkId landmark_id) {
  const auto landmark = landmarks_.find(landmark_id);
  if (landmark == landmarks_.end()) return;
  for (Keyframe& keyframe : keyframes_) {
    if (keyframe.id != keyframe_id) continue;
    const auto* observation = FindObservation(keyframe.observations, landmark_id);
    if (observation == nullptr) return;
    keyframe.observations.erase(keyframe.observations.begin() +
                                (observation - keyframe.observations.data()));
    if (--landmark->second.num_keyframes == 0) {
      landmarks_.erase(landmark);
    } else if (landmark->second.reference == keyframe_id) {
      MoveReference(landmark->second, keyframe.camera_from_world);
    }
  }
}

void LocalMap::ForgetRight(KeyframeId before) {
  for (Keyframe& keyframe : keyframes_) {
    if (keyframe.id >= before) break;
    for (LandmarkObservation& observation : keyframe.observations) observation.has_right = false;
  }
}

void LocalMap::Transform(const Rigid3& new_from_old) {
  const Rigid3 old_from_new = new_from_old.Inverse();
  const Eigen::Matrix3d rotation = new_from_old.RotationMatrix();
  for (Keyframe& keyframe : keyframes_) {
    keyframe.camera_from_world = keyframe.camera_from_world * old_from_new;
  }
  for (auto& [id, landmark] : landmarks_) {
    landmark.x_in_world = new_from_old * landmark.x_in_world;
    landmark.covariance = rotation * landmark.covariance * rotation.transpose();
    landmark.normal_in_world = rotation * landmark.normal_in_world;
  }
}

void LocalMap::Clear() {
  keyframes_.clear();
  landmarks_.clear();
  arrived_ = 0;
}

}  // namespace arfm_vo
