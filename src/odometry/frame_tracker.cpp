#include "arfm_vo/odometry/frame_tracker.h"

#include <algorithm>
#include <opencv2/core/utility.hpp>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/median.h"
#include "arfm_vo/base/pixel_scale.h"
#include "right_turn.h"
#include "still_keypoints.h"

namespace arfm_vo {

namespace {

/// Log odds of a landmark of the ground below which it is not looked for where its match disagrees.
constexpr double kMoves = -1.5;

/// How far a keypoint may be from its patch.
constexpr double kMaxSigmas = 3;

/// Log odds that a pose is the ground's from which no rival is looked for.
constexpr double kSure = 2;

/// Where some points stand still in the picture and others do not: on so many more rigs something
/// is fixed before the camera (one in a hundred) than something passes a resting camera just now.
constexpr double kFixedNotPassing = 1.2;

/// Whether by this pose nothing has moved in the picture since `before`.
bool IsAtRest(const StereoCamera& camera, const Correspondences& correspondences,
              const Rigid3& pose, const Rigid3& before) {
  constexpr double kRest_px = 0.5;
  std::vector<double> flow_px;
  for (const Landmark* landmark : correspondences.landmarks) {
    const Eigen::Vector3d now = pose * landmark->x_in_world, then = before * landmark->x_in_world;
    if (now.z() > 0 && then.z() > 0) {
      flow_px.push_back((camera.Project(now) - camera.Project(then)).norm());
    }
  }
  return !flow_px.empty() && Median(std::move(flow_px)) < kRest_px * PixelScale(camera.width);
}

std::vector<LandmarkId> Ids(const std::vector<const Landmark*>& landmarks) {
  std::vector<LandmarkId> ids;
  for (const Landmark* landmark : landmarks) ids.push_back(landmark->id);
  return ids;
}

}  // namespace

void FrameTrackerOptions::Check() const {
  Require(min_guided_inliers >= 4, "tracker.min_guided_inliers must be at least 4");
  matching.Check();
  pose.Check();
  alignment.Check();
  refinement.Check();
}

FrameTracker::FrameTracker(const StereoCamera& camera, const FrameTrackerOptions& options)
    : camera_(camera),
      options_(options),
      matcher_(camera, options.matching),
      aligner_(camera, options.alignment) {
  options.Check();
}

void FrameTracker::SetCorrection(const StereoCorrection& correction) {
  correction_ = correction;
  matcher_.SetCorrection(correction);
  aligner_.SetCorrection(correction);
}

TrackedFrame FrameTracker::Track(const StereoFrame& frame, const StereoImages& images,
                                 const LocalMap& map, const Expectation& expected) const {
  TrackedFrame tracked;
  if (frame.features.size() == 0) return tracked;
  if (!options_.guided) {
    tracked = Localise(matcher_.MatchAsImages(frame, map), frame, map, expected);
  } else if (expected.predicted) {
    tracked = Localise(matcher_.MatchNear(frame, map, expected.predicted->camera_from_world), frame,
                       map, expected);
  }
  if (!tracked.pose.HasPose() || tracked.pose.num_inliers < options_.min_guided_inliers) {
    const TrackedFrame found = Localise(matcher_.MatchAll(frame, map), frame, map, expected);
    const bool is_better =
        found.pose.HasPose() && (!tracked.pose.HasPose() || found.pose.votes > tracked.pose.votes);
    if (is_better || !tracked.pose.HasPose()) tracked = found;
  }
  if (!tracked.pose.HasPose()) return tracked;
  if (options_.align_patches) Align(images, map, expected, tracked);
  Weigh(frame, map, expected, tracked);
  Sort(tracked);
  return tracked;
}

TrackedFrame FrameTracker::Localise(Correspondences matches, const StereoFrame& frame,
                                    const LocalMap& map, const Expectation& expected) const {
  TrackedFrame tracked;
  tracked.matches = std::move(matches);
  tracked.matches.ShareVotes(camera_.width);
  const auto estimate = [&](const PoseEstimatorOptions& options) {
    tracked.pose =
        EstimatePose(camera_, tracked.matches.points, expected.predicted, options, &tracked.agrees);
    if (tracked.pose.HasPose()) Weigh(frame, map, expected, tracked);
  };
  estimate(expected.is_wary ? options_.pose.Wary() : options_.pose);
  if (!expected.is_wary && (tracked.log_odds < kSure || tracked.is_odd_rest)) {
    estimate(options_.pose.Wary());
  }
  if (!tracked.pose.HasPose()) return tracked;
  if (tracked.pose.rival && tracked.log_odds_of_rival > tracked.log_odds) PreferRival(tracked);
  tracked.observations = tracked.matches.Select(tracked.agrees, 1);
  for (const auto& observation : tracked.observations) {
    tracked.expected.push_back(observation.landmark);
  }
  return tracked;
}

void FrameTracker::Weigh(const StereoFrame& frame, const LocalMap& map, const Expectation& expected,
                         TrackedFrame& tracked) const {
  // Nothing where the pose has moved.
  const auto find_rest = [&](const Rigid3& pose, char flag) -> std::optional<double> {
    const Rigid3& before = map.keyframes().back().camera_from_world;
    if (!IsAtRest(camera_, tracked.matches, pose, before)) return std::nullopt;
    return RestLogRatio(camera_, frame, tracked.matches, tracked.agrees, flag);
  };
  const auto motion = [&](const Rigid3& pose) {
    return expected.predicted ? expected.predicted->LogOdds(pose) : 0;
  };
  // What moves on its own goes on as smoothly, unless it has hidden the ground just now.
  double smoothest = motion(tracked.pose.camera_from_world);
  if (tracked.pose.rival) smoothest = std::max(smoothest, motion(*tracked.pose.rival));
  const auto weigh = [&](const Rigid3& pose, char flag, const std::optional<double>& rest) {
    const auto likely = [&](double probability, const GroundPrior& prior) {
      const double hidden_before = 1 - prior.ground - prior.just_hidden;
      const double if_not = hidden_before * std::exp(smoothest) + prior.just_hidden;
      return LogLikelihoods{std::log(probability * prior.ground) + motion(pose) + rest.value_or(0),
                            std::log(probability * if_not)};
    };
    GroundBelief ground = tracked.matches.Weigh(camera_, tracked.agrees, flag,
                                                likely(1 - map.arrived(), expected.if_none),
                                                likely(map.arrived(), expected.if_come));
    ground.log_odds -= std::log(expected.if_none.ground / (1 - expected.if_none.ground));
    return ground;
  };
  const Rigid3& pose = tracked.pose.camera_from_world;
  const auto rest = find_rest(pose, 1);
  tracked.is_odd_rest = rest && *rest <= 0;
  const GroundBelief ground = weigh(pose, 1, rest);
  tracked.log_odds = ground.log_odds;
  tracked.arrived = ground.arrived;
  if (!tracked.pose.rival) return;
  const auto rival_rest = find_rest(*tracked.pose.rival, kAgreesWithRival);
  tracked.log_odds_of_rival = weigh(*tracked.pose.rival, kAgreesWithRival, rival_rest).log_odds +
                              (tracked.is_odd_rest ? kFixedNotPassing : 0);
}

void FrameTracker::Sort(TrackedFrame& tracked) {
  std::vector<char> agrees = tracked.agrees;
  // What stands still in the picture though the camera moves has a motion of its own too.
  for (size_t i = 0; i < agrees.size(); ++i) {
    if (agrees[i] == 0 && tracked.matches.is_still[i]) agrees[i] = kAgreesWithRival;
  }
  tracked.of_rival = tracked.matches.Select(agrees, kAgreesWithRival);
  for (char& flag : agrees) flag = flag == 1;
  tracked.contradicting = tracked.matches.Select(agrees, 0);
}

void FrameTracker::PreferRival(TrackedFrame& tracked) const {
  std::vector<char>& agrees = tracked.agrees;
  std::vector<char> of_rival(agrees.size());
  for (size_t i = 0; i < agrees.size(); ++i) of_rival[i] = agrees[i] == kAgreesWithRival;
  const PoseRefinement refined = RefinePose(camera_, tracked.matches.points, *tracked.pose.rival,
                                            options_.refinement, of_rival);
  if (refined.status != RefinementStatus::kConverged) return;
  for (size_t i = 0; i < agrees.size(); ++i) {
    agrees[i] = refined.is_inlier[i] ? 1 : agrees[i] == 1 ? kAgreesWithRival : 0;
  }
  tracked.pose.rival = tracked.pose.camera_from_world;
  tracked.pose.camera_from_world = refined.camera_from_world;
  tracked.pose.covariance = refined.covariance;
  tracked.pose.num_inliers = refined.num_inliers;
  tracked.pose.rms_px = refined.rms_px;
  std::swap(tracked.log_odds, tracked.log_odds_of_rival);
}

std::vector<std::optional<LandmarkObservation>> FrameTracker::Measure(
    const StereoImages& images, const LocalMap& map, const std::vector<const Landmark*>& landmarks,
    const Rigid3& camera_from_world, bool use_right) const {
  std::vector<std::optional<LandmarkObservation>> observations(landmarks.size());
  const cv::Range all(0, static_cast<int>(landmarks.size()));
  cv::parallel_for_(all, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const Keyframe* reference = map.FindKeyframe(landmarks[i]->reference);
      if (reference == nullptr) continue;
      observations[i] =
          aligner_.Align(*landmarks[i], *reference, images, camera_from_world, use_right);
    }
  });
  return observations;
}

void FrameTracker::Align(const StereoImages& images, const LocalMap& map,
                         const Expectation& expected, TrackedFrame& tracked) const {
  const Rigid3 coarse_pose = tracked.pose.camera_from_world;
  auto landmarks = map.LandmarksInView(coarse_pose, 8);
  const auto moves = [&](const Landmark* landmark) {
    return landmark->LogOddsOfGround(map.arrived()) < kMoves &&
           FindObservation(tracked.observations, landmark->id) == nullptr;
  };
  landmarks.erase(std::remove_if(landmarks.begin(), landmarks.end(), moves), landmarks.end());
  tracked.expected = Ids(landmarks);
  const std::vector<std::optional<LandmarkObservation>> observations =
      Measure(images, map, landmarks, coarse_pose, expected.use_right);
  Correspondences correspondences;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    if (observations[i]) {
      correspondences.Add(camera_, correction_, *landmarks[i], *observations[i]);
    }
  }
  const PoseRefinement refined =
      RefinePose(camera_, correspondences.points, coarse_pose, options_.refinement);
  const double enough = std::max<double>(
      options_.pose.min_inliers,
      options_.pose.min_inlier_share * static_cast<double>(correspondences.points.size()));
  if (refined.status != RefinementStatus::kConverged || refined.num_inliers < enough) {
    return;  // too few patches are no better than the keypoints that agreed
  }
  if (expected.may_turn && expected.use_right) {
    tracked.turn_against_map =
        FindTurnAgainstMap(camera_, correction_, correspondences.landmarks,
                           correspondences.observed, refined.camera_from_world);
  }
  tracked.pose.camera_from_world = refined.camera_from_world;
  tracked.pose.covariance = refined.covariance;
  tracked.pose.num_matches = static_cast<int>(correspondences.points.size());
  tracked.pose.num_inliers = refined.num_inliers;
  tracked.pose.rms_px = refined.rms_px;
  tracked.observations = correspondences.Select(refined.is_inlier, 1);
  // Keypoints whose patches agree do too, unless the texture repeats and they are elsewhere.
  for (size_t i = 0; i < tracked.agrees.size(); ++i) {
    const LandmarkObservation& match = tracked.matches.observed[i];
    const auto* seen = FindObservation(tracked.observations, match.landmark);
    if (seen == nullptr) continue;
    const double off_px = (seen->pixels - match.pixels).head<2>().norm();
    if (off_px < kMaxSigmas * match.sigma_px) tracked.agrees[i] = 1;
  }
}

}  // namespace arfm_vo
