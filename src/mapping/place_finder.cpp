#include "arfm_vo/mapping/place_finder.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "arfm_vo/pose/carry_covariance.h"
#include "arfm_vo/pose/chi_square.h"

namespace arfm_vo {
namespace {

constexpr size_t kMaxSightings = 8;
constexpr int kMinAgreeing = 2;        ///< sightings before the newest
constexpr double kProbability = 0.99;  ///< that sightings of one map agree

/// How sure the motion between two keyframes is, and that between two places of the map: 1 % of the
/// way, and the directions of ways in proportion.
constexpr double kSigma_rad = 2e-3, kSigma_m = 1e-2, kSigmaShare = 1e-2;

}  // namespace

void PlaceFinder::Add(const std::vector<KnownKeyframe>& keyframes, size_t first) {
  for (size_t i = first; i < keyframes.size(); ++i) {
    const KnownKeyframe& keyframe = keyframes[i];
    if (keyframe.points.empty()) continue;
    recogniser_.Add(keyframe.points);
    places_.push_back({i, keyframe.frame, keyframe.map_from_camera});
  }
}

bool PlaceFinder::KnowsOtherThan(int frame) const {
  return std::any_of(places_.begin(), places_.end(),
                     [&](const KnownPlace& place) { return place.frame != frame; });
}

void PlaceFinder::MoveFrame(int from, int to, const Rigid3& to_from_from) {
  for (KnownPlace& place : places_) {
    if (place.frame != from) continue;
    place.frame = to;
    place.map_from_camera = to_from_from * place.map_from_camera;
  }
  ForgetSightings();
}

bool PlaceFinder::Agree(const Sighting& earlier, const Sighting& newest,
                        const Rigid3& newest_from_earlier) const {
  if (places_[earlier.place].frame != places_[newest.place].frame) return false;
  // The error is in the newest camera's frame; that of the earlier sighting is carried there.
  const Rigid3 error =
      newest.camera_from_map * (newest_from_earlier * earlier.camera_from_map).Inverse();
  Eigen::Matrix<double, 6, 1> step;
  step << LogSO3(error.rotation), error.translation;
  Matrix6 covariance = newest.covariance + CarryCovariance(newest_from_earlier, earlier.covariance);
  const double sigma_m = kSigma_m + kSigmaShare * newest_from_earlier.translation.norm();
  covariance.diagonal().head<3>().array() += kSigma_rad * kSigma_rad;
  covariance.diagonal().tail<3>().array() += sigma_m * sigma_m;
  return step.dot(covariance.ldlt().solve(step)) < ChiSquareQuantile(6, kProbability);
}

std::optional<FoundPlace> PlaceFinder::Find(const std::vector<SeenPoint>& view, int number,
                                            const std::function<Rigid3(int)>& camera_from_world,
                                            int own_frame) {
  const auto found = recogniser_.Find(
      view, [&](int place, PlacePoint&) { return places_[place].frame != own_frame; });
  if (!found) return std::nullopt;
  const KnownPlace& place = places_[found->place];
  const Sighting newest{number, found->place,
                        found->pose.camera_from_world * place.map_from_camera.Inverse(),
                        found->pose.covariance};
  const Rigid3 newest_from_world = camera_from_world(number);
  const auto num_agreeing =
      std::count_if(sightings_.begin(), sightings_.end(), [&](const Sighting& earlier) {
        return Agree(earlier, newest,
                     newest_from_world * camera_from_world(earlier.number).Inverse());
      });
  sightings_.push_back(newest);
  if (sightings_.size() > kMaxSightings) sightings_.pop_front();
  if (num_agreeing < kMinAgreeing) return std::nullopt;
  return FoundPlace{place.keyframe, newest.camera_from_map.Inverse()};
}

}  // namespace arfm_vo
