#include "arfm_vo/odometry/keyframe_archive.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "arfm_vo/mapping/known_map.h"
#include "arfm_vo/pose/carry_covariance.h"

namespace arfm_vo {

void KeyframeArchive::Add(const Keyframe& keyframe, const LocalMap& map,
                          const Eigen::Matrix<double, 6, 6>& covariance) {
  View view{keyframe.id, keyframe.camera_from_world, covariance, 0, {}};
  for (const LandmarkObservation& observation : keyframe.observations) {
    const auto found = map.landmarks().find(observation.landmark);
    if (found == map.landmarks().end() || found->second.num_keyframes < 2) continue;
    const Landmark& landmark = found->second;
    view.place.push_back({landmark.id,
                          keyframe.camera_from_world * landmark.x_in_world,
                          {landmark.descriptor.data(), landmark.keypoint.laplacian_sign}});
  }
  if (static_cast<int>(view.place.size()) < RecognitionPose().min_inliers) return;
  view.distance_m = std::max(MedianDistance(view.place), camera_.baseline_m);
  views_.push_back(std::move(view));
  if (size() > max_keyframes_) DropLeastMissed();
  recogniser_.reset();
}

double KeyframeArchive::Difference(const View& a, const View& b) {
  return ViewDifference(b.camera_from_world * a.camera_from_world.Inverse(),
                        std::min(a.distance_m, b.distance_m));
}

/// The one that another resembles most, for its age: what is long past may be kept more sparsely.
void KeyframeArchive::DropLeastMissed() {
  double least = std::numeric_limits<double>::infinity();
  size_t least_missed = 0;
  for (size_t i = 0; i < views_.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t j = 0; j < views_.size(); ++j) {
      if (i != j) nearest = std::min(nearest, Difference(views_[i], views_[j]));
    }
    const double age = views_.back().keyframe - views_[i].keyframe + max_keyframes_;
    if (nearest / age >= least) continue;
    least = nearest / age;
    least_missed = i;
  }
  views_.erase(views_.begin() + static_cast<std::ptrdiff_t>(least_missed));
}

std::optional<ArchivedPlace> KeyframeArchive::Find(const StereoFrame& frame,
                                                   const StereoCorrection& correction) {
  if (!recogniser_) {
    recogniser_.emplace(camera_);
    for (const View& view : views_) recogniser_->Add(view.place);
  }
  const auto found = recogniser_->Find(PointsSeen(camera_, correction, frame));
  if (!found) return std::nullopt;
  const View& view = views_[found->place];
  ArchivedPlace place{found->pose, found->log_false_alarms, found->pose.covariance};
  place.covariance_from_start += CarryCovariance(found->pose.camera_from_world, view.covariance);
  place.pose.camera_from_world = found->pose.camera_from_world * view.camera_from_world;
  return place;
}

}  // namespace arfm_vo
