#include "arfm_vo/mapping/place_recogniser.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/pose/false_alarms.h"
#include "arfm_vo/pose/reprojection.h"

namespace arfm_vo {
namespace {

constexpr double kMaxDistance = 0.6;  ///< of the descriptors of one point
constexpr double kMaxRatio = 0.85;  ///< distance of the nearest over that of the nearest elsewhere
constexpr int kMinVotes = 12;       ///< points of a view that look like those of a place
constexpr int kMaxTries = 3;        ///< places, those with most votes first, that are verified
/// Points of a place nearer to each other than this share of their distance are one.
constexpr double kSamePoint = 0.1;
/// What a pose's covariance is at least.
constexpr double kMinSigma_rad = 2e-4, kMinSigma_m = 5e-3;

double Square(double x) { return x * x; }

/// (Of the place, of the view): each point seen with the one that it looks like, if it looks like
/// no other that lies elsewhere, and no other point seen looks more like that one.
std::vector<std::pair<int, int>> Match(const Place& place, const std::vector<SeenPoint>& view) {
  Eigen::MatrixXf squared(place.size(), view.size());
  for (size_t j = 0; j < view.size(); ++j) {
    for (size_t i = 0; i < place.size(); ++i) {
      squared(i, j) = place[i].appearance.SquaredDistance(view[j].appearance);
    }
  }
  const Eigen::VectorXf least = squared.rowwise().minCoeff();
  const double distinct = 1 / Square(kMaxRatio);
  std::vector<std::pair<int, int>> matches;
  for (int j = 0; j < squared.cols(); ++j) {
    int found = 0;
    const double nearest = squared.col(j).minCoeff(&found);
    if (nearest >= Square(kMaxDistance) || nearest > distinct * least[found]) continue;
    const Eigen::Vector3d& x = place[found].x_in_place;
    bool is_unique = true;
    for (int i = 0; i < squared.rows() && is_unique; ++i) {
      is_unique = squared(i, j) >= distinct * nearest ||
                  (place[i].x_in_place - x).norm() <= kSamePoint * x.norm();
    }
    if (is_unique) matches.emplace_back(found, j);
  }
  return matches;
}

/// RecognisedPlace::log_false_alarms.
double LogFalseAlarmsOf(const StereoCamera& camera, const std::vector<PointObservation>& matches,
                        const PoseEstimate& pose) {
  const int num_matches = static_cast<int>(matches.size());
  double num_alike = 1;
  for (const PointObservation& match : matches) {
    const Eigen::Vector3d x = pose.camera_from_world * match.x_in_world;
    if (x.z() <= kMinDepth) continue;
    for (const PointObservation& other : matches) {
      const double error = ReprojectionError(camera, other, x).squaredNorm();
      num_alike +=
          &other != &match && error < InlierBound(other.NumCoordinates()) * Square(other.sigma_px);
    }
  }
  return LogFalseAlarms(num_matches, pose.num_inliers, std::log(num_alike / Square(num_matches)));
}

}  // namespace

PoseEstimatorOptions RecognitionPose() {
  PoseEstimatorOptions options;
  options.min_inliers = 25;
  options.min_inlier_share = 0.25;
  options.ransac.max_iterations = 450;  // finds a quarter that agrees at a probability of 0.999
  return options;
}

std::vector<SeenPoint> PointsSeen(const StereoCamera& camera, const StereoCorrection& correction,
                                  const StereoFrame& frame) {
  const std::vector<const StereoPoint*> stereo = frame.PointsByKeypoint();
  std::vector<SeenPoint> view(stereo.size());
  for (int i = 0; i < frame.features.size(); ++i) {
    const Keypoint& keypoint = frame.features.keypoints[i];
    view[i].appearance = {frame.features.descriptors.ptr<float>(i), keypoint.laplacian_sign};
    PointObservation& observation = view[i].observation;
    observation.pixels << NominalLeftPixel(camera, correction, {keypoint.x, keypoint.y}), 0;
    observation.has_right = stereo[i] != nullptr;
    if (stereo[i]) observation.pixels.z() = camera.ProjectStereo(stereo[i]->x_in_camera).z();
    observation.sigma_px = kKeypointSigma * keypoint.scale;
  }
  return view;
}

void PlaceRecogniser::Add(Place place) {
  if (!index_ && static_cast<int>(place.size()) >= RecognitionPose().min_inliers) {
    std::vector<Appearance> training;
    for (const PlacePoint& point : place) training.push_back(point.appearance);
    index_.emplace(training);
  }
  for (size_t i = 0; index_ && i < place.size(); ++i) {
    index_->Add(static_cast<int>(indexed_.size()), place[i].appearance);
    indexed_.emplace_back(places_.size(), i);
  }
  places_.push_back(std::move(place));
}

std::optional<RecognisedPlace> PlaceRecogniser::Find(const std::vector<SeenPoint>& view,
                                                     const Revise& revise) const {
  std::optional<RecognisedPlace> best;
  if (!index_) return best;
  std::vector<int> votes = CountVotes(view, revise);
  for (int tries = 0; tries < kMaxTries; ++tries) {
    const auto most = std::max_element(votes.begin(), votes.end());
    if (*most < kMinVotes) break;
    const auto found = Verify(static_cast<int>(most - votes.begin()), view, revise);
    if (found && (!best || found->pose.num_inliers > best->pose.num_inliers)) best = found;
    *most = 0;
  }
  return best;
}

/// [places] A point seen votes for the places of all those that cannot be told apart from the
/// nearest.
std::vector<int> PlaceRecogniser::CountVotes(const std::vector<SeenPoint>& view,
                                             const Revise& revise) const {
  std::vector<int> votes(places_.size(), 0);
  for (const SeenPoint& seen : view) {
    std::vector<std::pair<float, int>> alike;
    for (const int candidate : index_->FindCandidates(seen.appearance)) {
      const auto& [place, point] = indexed_[candidate];
      const float squared = places_[place][point].appearance.SquaredDistance(seen.appearance);
      if (squared < Square(kMaxDistance)) alike.emplace_back(squared, candidate);
    }
    std::sort(alike.begin(), alike.end());
    double allowed = Square(kMaxDistance);
    std::vector<int> voted;
    for (const auto& [squared, candidate] : alike) {
      if (squared > allowed) break;
      const auto& [place, point] = indexed_[candidate];
      PlacePoint revised = places_[place][point];
      if (std::count(voted.begin(), voted.end(), place) || !revise(place, revised)) continue;
      voted.push_back(place);
      ++votes[place];
      allowed = std::min(allowed, squared / Square(kMaxRatio));
    }
  }
  return votes;
}

std::optional<RecognisedPlace> PlaceRecogniser::Verify(int place,
                                                       const std::vector<SeenPoint>& view,
                                                       const Revise& revise) const {
  Place known;
  for (PlacePoint point : places_[place]) {
    if (revise(place, point)) known.push_back(point);
  }
  if (known.empty()) return std::nullopt;
  const std::vector<std::pair<int, int>> matches = Match(known, view);
  std::vector<PointObservation> observations;
  for (const auto& [point, seen] : matches) {
    observations.push_back(view[seen].observation);
    observations.back().x_in_world = known[point].x_in_place;
  }
  std::vector<char> is_inlier;
  RecognisedPlace found{place, {}, 0, {}};
  found.pose = EstimatePose(camera_, observations, std::nullopt, pose_, &is_inlier);
  if (!found.pose.IsTracked()) return std::nullopt;
  found.log_false_alarms = LogFalseAlarmsOf(camera_, observations, found.pose);
  found.pose.covariance.diagonal().head<3>().array() += Square(kMinSigma_rad);
  found.pose.covariance.diagonal().tail<3>().array() += Square(kMinSigma_m);
  for (size_t i = 0; i < matches.size(); ++i) {
    const auto& [point, seen] = matches[i];
    if (is_inlier[i] == 1) found.same.emplace_back(known[point].id, view[seen].id);
  }
  return found;
}

}  // namespace arfm_vo
