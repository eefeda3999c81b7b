#include "arfm_vo/mapping/place_recogniser.h"

#include <algorithm>
#include <limits>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

/// Points of a place nearer to each other than this share of their distance are one.
constexpr double kSamePoint = 0.1;
/// What a pose's covariance is at least.
constexpr double kMinSigma_rad = 2e-4, kMinSigma_m = 5e-3;

double Square(double x) { return x * x; }

}  // namespace

void PlaceRecogniserOptions::Check() const {
  Require(max_distance > 0 && max_distance <= 2, "places: max_distance must be in (0, 2]");
  Require(max_ratio > 0 && max_ratio <= 1, "places: max_ratio must be in (0, 1]");
  Require(min_votes >= 1, "places: min_votes must be at least 1");
  Require(max_tries >= 1, "places: max_tries must be at least 1");
  index.Check();
  pose.Check();
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

PlaceRecogniser::PlaceRecogniser(const StereoCamera& camera, const PlaceRecogniserOptions& options)
    : camera_(camera), options_(options), index_(options.index) {
  camera.Check();
  options.Check();
}

void PlaceRecogniser::Add(Place place) {
  const int number = static_cast<int>(places_.size()), size = static_cast<int>(place.size());
  if (size >= options_.pose.min_inliers) {
    if (index_.size() == 0) {
      std::vector<Appearance> appearances;
      for (const PlacePoint& point : place) appearances.push_back(point.appearance);
      index_.Train(appearances);
    }
    for (int i = 0; i < size; ++i) {
      index_.Add(place[i].appearance);
      indexed_.emplace_back(number, i);
    }
  }
  places_.push_back(std::move(place));
}

std::optional<RecognisedPlace> PlaceRecogniser::Find(const std::vector<SeenPoint>& view,
                                                     const Revise& revise) const {
  std::optional<RecognisedPlace> best;
  for (const int place : FindMostAlike(view, revise)) {
    const auto found = Verify(place, view, revise);
    if (found && (!best || found->pose.num_inliers > best->pose.num_inliers)) best = found;
  }
  return best;
}

/// A point seen votes for the places of all those that cannot be told apart from the nearest.
std::vector<int> PlaceRecogniser::FindMostAlike(const std::vector<SeenPoint>& view,
                                                const Revise& revise) const {
  std::vector<int> votes(places_.size(), 0), last_voter(places_.size(), -1);
  for (int seen = 0; seen < static_cast<int>(view.size()); ++seen) {
    std::vector<std::pair<float, int>> alike;
    double allowed = Square(options_.max_distance);
    for (const int candidate : index_.FindCandidates(view[seen].appearance)) {
      const auto [place, point] = indexed_[candidate];
      const float squared =
          places_[place][point].appearance.SquaredDistance(view[seen].appearance);
      if (squared < allowed) alike.emplace_back(squared, candidate);
    }
    std::sort(alike.begin(), alike.end());
    for (const auto& [squared, candidate] : alike) {
      if (squared > allowed) break;
      const auto [place, point] = indexed_[candidate];
      PlacePoint revised = places_[place][point];
      if (last_voter[place] == seen || !revise(place, revised)) continue;
      ++votes[place];
      last_voter[place] = seen;
      allowed = std::min(allowed, squared / Square(options_.max_ratio));
    }
  }
  std::vector<int> most_alike;
  for (int place = 0; place < static_cast<int>(votes.size()); ++place) {
    if (votes[place] >= options_.min_votes) most_alike.push_back(place);
  }
  std::stable_sort(most_alike.begin(), most_alike.end(),
                   [&](int a, int b) { return votes[a] > votes[b]; });
  most_alike.resize(std::min<size_t>(most_alike.size(), options_.max_tries));
  return most_alike;
}

/// (Of the place, of the view): each point seen with the one that it looks like, if it looks like
/// no other that lies elsewhere, and no other point seen looks more like that one.
std::vector<std::pair<int, int>> PlaceRecogniser::Match(const Place& place,
                                                        const std::vector<SeenPoint>& view) const {
  Eigen::MatrixXf squared(place.size(), view.size());
  for (size_t j = 0; j < view.size(); ++j) {
    for (size_t i = 0; i < place.size(); ++i) {
      squared(i, j) = place[i].appearance.SquaredDistance(view[j].appearance);
    }
  }
  const Eigen::VectorXf least = squared.rowwise().minCoeff();
  const double distinct = 1 / Square(options_.max_ratio);
  std::vector<std::pair<int, int>> matches;
  for (int j = 0; j < squared.cols(); ++j) {
    int found = 0;
    const double nearest = squared.col(j).minCoeff(&found);
    if (nearest >= Square(options_.max_distance) || nearest > distinct * least[found]) continue;
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

std::optional<RecognisedPlace> PlaceRecogniser::Verify(int place,
                                                       const std::vector<SeenPoint>& view,
                                                       const Revise& revise) const {
  Place known;
  for (PlacePoint point : places_[place]) {
    if (revise(place, point)) known.push_back(point);
  }
  if (static_cast<int>(known.size()) < options_.pose.min_inliers) return std::nullopt;
  const std::vector<std::pair<int, int>> matches = Match(known, view);
  std::vector<PointObservation> observations;
  for (const auto& [point, seen] : matches) {
    observations.push_back(view[seen].observation);
    observations.back().x_in_world = known[point].x_in_place;
  }
  std::vector<char> is_inlier;
  RecognisedPlace found{place, {}, {}};
  found.pose = EstimatePose(camera_, observations, std::nullopt, options_.pose, &is_inlier);
  if (!found.pose.IsTracked()) return std::nullopt;
  found.pose.covariance.diagonal().head<3>().array() += Square(kMinSigma_rad);
  found.pose.covariance.diagonal().tail<3>().array() += Square(kMinSigma_m);
  for (size_t i = 0; i < matches.size(); ++i) {
    if (is_inlier[i] == 1) found.same.emplace_back(known[matches[i].first].id, matches[i].second);
  }
  return found;
}

}  // namespace arfm_vo
