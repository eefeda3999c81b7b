#include "arfm_vo/tracking/patch_tracker.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/utility.hpp>
#include <utility>

#include "arfm_vo/base/median.h"
#include "arfm_vo/pose/false_alarms.h"
#include "arfm_vo/tracking/fixed_points.h"
#include "arfm_vo/tracking/ground_weighing.h"
#include "arfm_vo/tracking/right_turn.h"
#include "arfm_vo/tracking/still_keypoints.h"

namespace arfm_vo {
namespace {

/// Log odds of a landmark of the ground below which it is not looked for where its match disagrees.
constexpr double kMoves = -1.5;

/// Landmarks nearer to the border of the image are not looked for.
constexpr double kBorder_px = 8;

/// So many landmarks tell the pose coarsely.
constexpr size_t kEnoughCoarse = 100;

/// A prediction that errs by so many standard deviations must not put patches out of reach.
constexpr double kReachSigmas = 2;

/// How far from where it is expected a patch is found in an image halved so often, px.
double ReachOf(int level) { return std::ldexp(PatchAlignmentLimits().max_shift_px, level); }

template <class Condition>
void EraseIf(std::vector<const Landmark*>& landmarks, const Condition& condition) {
  landmarks.erase(std::remove_if(landmarks.begin(), landmarks.end(), condition), landmarks.end());
}

/// Those that were not found.
std::vector<const Landmark*> Without(std::vector<const Landmark*> landmarks,
                                     const Correspondences& found) {
  const auto is_found = [&, next = found.landmarks.begin()](const Landmark* landmark) mutable {
    if (next == found.landmarks.end() || *next != landmark) return false;
    ++next;
    return true;
  };
  EraseIf(landmarks, is_found);
  return landmarks;
}

}  // namespace

PatchTracker::PatchTracker(const StereoCamera& camera, const PatchTrackerOptions& options)
    : camera_(camera), options_(options), aligner_(camera, options.alignment) {}

void PatchTracker::SetCorrection(const StereoCorrection& correction) {
  correction_ = correction;
  aligner_.SetCorrection(correction);
}

std::optional<int> PatchTracker::LevelFor(const LocalMap& map,
                                          const PredictedPose& predicted) const {
  std::vector<double> depths;
  for (const auto& [id, landmark] : map.landmarks()) {
    const Eigen::Vector3d x = predicted.camera_from_world * landmark.x_in_world;
    if (x.z() > camera_.baseline_m && camera_.Contains(camera_.Project(x), 0)) {
      depths.push_back(x.z());
    }
  }
  if (depths.empty()) return std::nullopt;
  const double sigma_px =
      camera_.fx * (predicted.sigma_turn_rad + predicted.sigma_shift_m / Median(std::move(depths)));
  for (int level = 0; level <= kMostHalved; ++level) {
    if (kReachSigmas * sigma_px < ReachOf(level)) return level;
  }
  return std::nullopt;
}

MeasuredPatches PatchTracker::MeasureInView(const StereoImages& images, const LocalMap& map,
                                            const Expectation& expected,
                                            TrackedFrame& tracked) const {
  const Rigid3& pose = tracked.pose.camera_from_world;
  MeasuredPatches measured;
  measured.landmarks = map.LandmarksInView(pose, kBorder_px);
  const auto moves = [&](const Landmark* landmark) {
    return landmark->LogOddsOfGround(map.arrived()) < kMoves &&
           FindObservation(tracked.observations, landmark->id) == nullptr;
  };
  EraseIf(measured.landmarks, moves);
  tracked.expected.clear();
  for (const Landmark* landmark : measured.landmarks) tracked.expected.push_back(landmark->id);
  measured.patches = Measure(images, map, measured.landmarks, pose, expected.use_right);
  return measured;
}

/// What is off by less than a keypoint may err does not contradict.
void PatchTracker::AllowForKeypoints(TrackedFrame& tracked) const {
  for (size_t i = 0; i < tracked.agrees.size(); ++i) {
    const Landmark& landmark = *tracked.matches.landmarks[i];
    const Eigen::Vector2d there =
        camera_.Project(tracked.pose.camera_from_world * landmark.x_in_world);
    const double off_px = (there - tracked.matches.points[i].pixels.head<2>()).norm();
    if (off_px < Reach(landmark.keypoint)) tracked.agrees[i] = 1;
  }
}

std::optional<TrackedFrame> PatchTracker::Track(const StereoImages& images, const LocalMap& map,
                                                const Expectation& expected, int level) const {
  Rigid3 pose = expected.predicted->camera_from_world;
  if (level > 0 && !Approach(images.left, map, level, pose)) return std::nullopt;
  return At(images, map, expected, pose);
}

bool PatchTracker::Decides(const TrackedFrame& tracked, const LocalMap& map,
                           const Expectation& expected) const {
  if (tracked.pose.num_inliers < options_.min_deciding || tracked.is_odd_rest) return false;
  int num_seen_before = 0, num_seen = 0;
  for (const LandmarkId landmark : tracked.expected) {
    if (map.landmarks().at(landmark).num_missed > 0) continue;
    ++num_seen_before;
    num_seen += FindObservation(tracked.observations, landmark) != nullptr;
  }
  if (2 * num_seen < num_seen_before) return false;
  // Of swapped images the left one fits a pose at the right camera, and the right one none.
  if (expected.use_right && ShareWithRight(tracked.observations) < 0.5) return false;
  // Where poses before may not have been the ground's there is more to weigh.
  const double ground = expected.if_none.ground;
  return std::min(0., std::log(ground / (1 - ground))) + tracked.log_odds >= kSure;
}

std::optional<TrackedFrame> PatchTracker::At(const StereoImages& images, const LocalMap& map,
                                             const Expectation& expected,
                                             const Rigid3& camera_from_world) const {
  TrackedFrame tracked;
  tracked.pose.status = PoseStatus::kTracked;
  tracked.fixed_log_odds = expected.fixed_log_odds;
  Rigid3& pose = tracked.pose.camera_from_world;
  pose = camera_from_world;
  MeasuredPatches measured = MeasureInView(images, map, expected, tracked);
  std::vector<const Landmark*>& seen_before = measured.landmarks;
  Correspondences& patches = measured.patches;
  tracked.agrees = Refine(patches, expected, tracked);
  if (!IsSame(camera_, seen_before, pose, camera_from_world)) {
    // What was out of reach may be in reach now: near points as a rule.
    const auto missed = Without(seen_before, patches);
    patches.Append(Measure(images, map, missed, pose, expected.use_right));
    tracked.agrees = Refine(patches, expected, tracked);
  }
  if (tracked.agrees.empty() || AgreesByChance(camera_, patches.points, tracked.agrees, pose)) {
    return std::nullopt;
  }
  TellTurn(patches, expected, tracked);
  tracked.matches = std::move(patches);
  EraseIf(seen_before, [](const Landmark* landmark) { return landmark->num_missed > 0; });
  AllowForKeypoints(tracked);
  const auto rest_log_ratio = [&](char) {
    return RestLogRatio(camera_, seen_before, pose, tracked.observations);
  };
  WeighGround(camera_, map, expected, rest_log_ratio, tracked);
  SortMatches(tracked);
  return tracked;
}

bool PatchTracker::Approach(const cv::Mat& left, const LocalMap& map, int level,
                            Rigid3& camera_from_world) const {
  const HalvedImages left_halved = Halve(left);
  for (; level > 0; --level) {
    std::vector<const Landmark*> landmarks = map.LandmarksInView(camera_from_world, kBorder_px);
    // (Those of a keyframe are spread over the image, in any order.)
    const size_t every = 1 + landmarks.size() / kEnoughCoarse;
    std::vector<const Landmark*> some;
    for (size_t i = 0; i < landmarks.size(); i += every) some.push_back(landmarks[i]);
    const Correspondences patches =
        Measure(map, some, level, [&](const auto& landmark, const auto& seen) {
          return aligner_.AlignCoarsely(landmark, seen, left_halved, level, camera_from_world);
        });
    const PoseRefinement refined =
        RefinePose(camera_, patches.points, camera_from_world, options_.refinement);
    if (refined.status != RefinementStatus::kConverged ||
        AgreesByChance(camera_, patches.points, refined.is_inlier, refined.camera_from_world)) {
      return false;
    }
    camera_from_world = refined.camera_from_world;
  }
  return true;
}

Correspondences PatchTracker::Measure(const LocalMap& map,
                                      const std::vector<const Landmark*>& landmarks, int level,
                                      const AlignLandmark& align) const {
  std::vector<std::optional<LandmarkObservation>> observations(landmarks.size());
  const cv::Range all(0, static_cast<int>(landmarks.size()));
  cv::parallel_for_(all, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const Keyframe* reference = map.FindKeyframe(landmarks[i]->reference);
      if (reference != nullptr) observations[i] = align(*landmarks[i], *reference);
    }
  });
  Correspondences correspondences;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    if (!observations[i]) continue;
    correspondences.Add(camera_, correction_, *landmarks[i], *observations[i]);
    correspondences.points.back().reach_px = ReachOf(level);
  }
  return correspondences;
}

Correspondences PatchTracker::Measure(const StereoImages& images, const LocalMap& map,
                                      const std::vector<const Landmark*>& landmarks,
                                      const Rigid3& camera_from_world, bool use_right) const {
  return Measure(map, landmarks, 0, [&](const Landmark& landmark, const Keyframe& reference) {
    return aligner_.Align(landmark, reference, images, camera_from_world, use_right);
  });
}

std::vector<char> PatchTracker::Refine(const Correspondences& patches, const Expectation& expected,
                                       TrackedFrame& tracked) const {
  PoseRefinement refined =
      RefinePose(camera_, patches.points, tracked.pose.camera_from_world, options_.refinement);
  const int num_patches = static_cast<int>(patches.points.size());
  if (refined.status != RefinementStatus::kConverged ||
      refined.num_inliers < options_.min_inlier_share * num_patches) {
    return {};
  }
  auto found = FindPoseWithoutFixed(camera_, patches, refined.is_inlier, refined.camera_from_world,
                                    options_.refinement);
  const double fixed_log_odds =
      found ? found->LogOdds(tracked.fixed_log_odds, expected.another_log_odds) : 0;
  if (fixed_log_odds > 0) {
    refined = std::move(found->refined);
    tracked.fixed_log_odds = fixed_log_odds;
  }
  tracked.pose.Set(refined);
  tracked.pose.num_matches = num_patches;
  tracked.observations = patches.Select(refined.is_inlier, 1);
  return std::move(refined.is_inlier);
}

void PatchTracker::TellTurn(const Correspondences& patches, const Expectation& expected,
                            TrackedFrame& tracked) const {
  if (!expected.may_turn || !expected.use_right) return;
  tracked.turn_against_map = FindTurnAgainstMap(camera_, correction_, patches.landmarks,
                                                patches.observed, tracked.pose.camera_from_world);
}

}  // namespace arfm_vo
