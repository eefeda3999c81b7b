#include "arfm_vo/mapping/place_finder.h"

#include <algorithm>

#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/geometry/linear_algebra.h"
#include "arfm_vo/pose/carry_covariance.h"

namespace arfm_vo {
namespace {

constexpr size_t kMaxSightings = 8;
constexpr double kSightingProbability = 0.99;  ///< that sightings of one map agree

/// How sure the motion between two views is, and that between two places of the map: 1 % of the
/// way, and the directions of ways in proportion.
constexpr double kSigma_rad = 2e-3, kSigma_m = 1e-2, kSigmaShare = 1e-2;

}  // namespace

void PlaceFinder::Add(const std::vector<KnownKeyframe>& known, size_t first) {
  for (size_t i = first; i < known.size(); ++i) {
    if (known[i].points.empty()) continue;
    recogniser_.Add(known[i].points);
    places_.push_back(i);
  }
}

bool PlaceFinder::Agree(const Sighting& earlier, const Sighting& newest) {
  if (earlier.frame != newest.frame) return false;
  const Rigid3 newest_from_earlier = newest.odom_from_camera.Inverse() * earlier.odom_from_camera;
  // The error is in the newest camera's frame; that of the earlier sighting is carried there.
  const Rigid3 error =
      newest.camera_from_map * (newest_from_earlier * earlier.camera_from_map).Inverse();
  Eigen::Matrix<double, 6, 1> step;
  step << LogSO3(error.rotation), error.translation;
  Matrix6 covariance = newest.covariance + CarryCovariance(newest_from_earlier, earlier.covariance);
  const double sigma_m = kSigma_m + kSigmaShare * newest_from_earlier.translation.norm();
  covariance.diagonal().head<3>().array() += kSigma_rad * kSigma_rad;
  covariance.diagonal().tail<3>().array() += sigma_m * sigma_m;
  return SquaredMahalanobis(step, covariance) < ChiSquareQuantile(6, kSightingProbability);
}

std::optional<FoundPlace> PlaceFinder::Find(const std::vector<SeenPoint>& view,
                                            const Rigid3& odom_from_camera,
                                            const std::vector<KnownKeyframe>& known,
                                            int own_frame) {
  const auto found = recogniser_.Find(
      view, [&](int place, PlacePoint&) { return known[places_[place]].frame != own_frame; });
  // The views that agree say so together, each an equal share.
  has_recognised_ = found && found->log_false_alarms <= kSureLogFalseAlarms / (num_agreeing_ + 1);
  if (!has_recognised_) return std::nullopt;
  const size_t keyframe = places_[found->place];
  const KnownKeyframe& place = known[keyframe];
  const Sighting newest{odom_from_camera, place.frame,
                        found->pose.camera_from_world * place.map_from_camera.Inverse(),
                        found->pose.covariance};
  const auto num_agreeing =
      std::count_if(sightings_.begin(), sightings_.end(),
                    [&](const Sighting& earlier) { return Agree(earlier, newest); });
  sightings_.push_back(newest);
  if (sightings_.size() > kMaxSightings) sightings_.pop_front();
  if (num_agreeing < num_agreeing_) return std::nullopt;
  return FoundPlace{keyframe, newest.camera_from_map.Inverse(), found->pose.camera_from_world,
                    found->pose.covariance};
}

}  // namespace arfm_vo
