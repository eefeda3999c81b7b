#include "arfm_vo/odometry/global_map.h"

#include <algorithm>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"
#include "arfm_vo/bundle_adjustment/pose_graph.h"
#include "arfm_vo/pose/chi_square.h"

namespace arfm_vo {
namespace {

/// One held keyframe for so many that move keeps what it saw of the same landmarks.
constexpr int kHeldShare = 5;

/// Loops that agree with the path this far, by their own covariance, do not bend it.
constexpr double kLoopProbability = 0.99;

constexpr double kAdjustmentGrowth = 1.5;

/// How sure the motion between two keyframes is when a loop is shared out among them.
constexpr double kStepSigma_rad = 5e-4, kStepSigma_m = 2e-3, kStepSigmaShare = 2e-3;

bool HasResult(const BundleResult& result) {
  return result.status == BundleStatus::kConverged || result.status == BundleStatus::kNotConverged;
}

}  // namespace

void GlobalMapOptions::Check() const {
  solver.Check();
  Require(min_observations >= 2, "global.min_observations must be at least 2");
  Require(max_keyframes >= 2, "global.max_keyframes must be at least 2");
  loops.Check();
}

GlobalMap::GlobalMap(const StereoCamera& camera, const GlobalMapOptions& options,
                     const CorrectionBelief& correction)
    : camera_(camera),
      options_(options),
      detector_(camera, options.loops),
      calibration_(camera, options.learn_correction, correction) {
  camera.Check();
  options.Check();
}

void GlobalMap::Add(const Keyframe& keyframe, const std::vector<Landmark>& landmarks) {
  Require(store_.keyframes.empty() || keyframe.id > store_.keyframes.back().id,
          "global map: keyframe " + std::to_string(keyframe.id) + " is not newer than the last");
  const int newest = num_keyframes();
  Keyframe kept = keyframe;
  kept.camera_from_world = keyframe.camera_from_world * map_from_odom_.Inverse();
  kept.first_landmark = FirstLandmark(landmarks);
  if (newest > 0) {
    const Rigid3& before = store_.keyframes.back().camera_from_world;
    calibration_.AddTurn((kept.camera_from_world * before.Inverse()).Angle());
  }
  if (kept.right_turn) calibration_.Turn(*kept.right_turn, newest);
  store_.keyframes.push_back(std::move(kept));
  for (const Landmark& landmark : landmarks) {
    MapStore::Point& point = store_.landmarks[landmark.id];
    point.x_in_world = map_from_odom_ * landmark.x_in_world;
    point.first_keyframe = newest;
    point.appearance = {landmark.descriptor.data(), landmark.keypoint.laplacian_sign};
  }
  for (const LandmarkObservation& observation : keyframe.observations) {
    const auto landmark = store_.Find(observation.landmark);
    if (landmark == store_.landmarks.end()) continue;
    ++landmark->second.num_observations;
    landmark->second.last_keyframe = newest;
  }
  if (options_.loops.enabled) {
    if (const auto loop = detector_.Detect(store_, calibration_.correction().mean)) Close(*loop);
  }
  FollowCalibration();
  if (num_keyframes() <= options_.NumMoving()) return;
  const int first_moving = FirstMoving();
  store_.Forget(first_moving, first_moving - options_.NumMoving() / kHeldShare,
                options_.loops.enabled, options_.max_settled_points);
}

int NextAdjustment(int num_keyframes, int num_moving) {
  return std::clamp(static_cast<int>(kAdjustmentGrowth * num_keyframes), num_keyframes + 1,
                    num_keyframes + std::max(1, num_moving / 2));
}

bool GlobalMap::IsAdjustmentDue() const {
  return num_keyframes() >= next_adjustment_ || is_contradicted_ || calibration_.IsTurning();
}

int GlobalMap::FirstMoving() const {
  // The first of all never moves, nor do those of another correction.
  return std::max(calibration_.first_telling() + 1, num_keyframes() - options_.NumMoving());
}

int GlobalMap::FirstSeeing() const {
  return std::max(store_.first_seeing, calibration_.first_telling());
}

LandmarkId GlobalMap::FirstLandmark(const std::vector<Landmark>& landmarks) const {
  if (!landmarks.empty()) return landmarks.front().id;
  return store_.landmarks.empty() ? 0 : store_.landmarks.rbegin()->first + 1;
}

/// What was seen before and again becomes one landmark, the older one. The path need not be bent
/// where the loop says what it says already.
void GlobalMap::Close(const Loop& loop) {
  loops_.push_back(loop.constraint);
  const PoseConstraint& c = loop.constraint;
  const Eigen::Matrix<double, 6, 1> error =
      LinearizeConstraint(c, store_.keyframes[c.first].camera_from_world,
                          store_.keyframes[c.second].camera_from_world)
          .residual;
  is_contradicted_ |= error.dot(c.information * error) > ChiSquareQuantile(6, kLoopProbability);
  for (const auto& [first, second] : loop.same) {
    const auto old = store_.Find(first), seen = store_.Find(second);
    if (old->first >= seen->first) continue;
    seen->second.same_as = old->first;
    old->second.num_observations += seen->second.num_observations;
    old->second.last_keyframe = seen->second.last_keyframe;
    seen->second.num_observations = 0;
  }
}

void GlobalMap::BendOntoLoops() {
  std::vector<Rigid3> poses;
  for (const Keyframe& keyframe : store_.keyframes) {
    poses.push_back(keyframe.camera_from_world);
  }
  std::vector<PoseConstraint> constraints = loops_;
  // An adjustment has found what the loops closed before it say, from more than they were.
  for (size_t i = 0; i < num_adjusted_loops_; ++i) {
    PoseConstraint& loop = constraints[i];
    loop.second_from_first = poses[loop.second] * poses[loop.first].Inverse();
  }
  for (int k = 0; k + 1 < num_keyframes(); ++k) {
    PoseConstraint step{k, k + 1, poses[k + 1] * poses[k].Inverse(), {}};
    const double sigma_m =
        kStepSigma_m + kStepSigmaShare * step.second_from_first.translation.norm();
    step.information.setZero();
    step.information.diagonal().head<3>().setConstant(1 / (kStepSigma_rad * kStepSigma_rad));
    step.information.diagonal().tail<3>().setConstant(1 / (sigma_m * sigma_m));
    constraints.push_back(step);
  }
  const std::vector<Rigid3> bent = SolvePoseGraph(poses, constraints);
  for (auto& [id, point] : store_.landmarks) {
    const int k = point.first_keyframe;
    point.x_in_world = bent[k].Inverse() * (poses[k] * point.x_in_world);
  }
  for (int k = 0; k < num_keyframes(); ++k) store_.keyframes[k].camera_from_world = bent[k];
  is_contradicted_ = false;
}

/// The newest keyframes alone.
void GlobalMap::FollowCalibration() {
  const auto prior = calibration_.WindowPrior(num_keyframes());
  if (!prior) return;
  const int first = num_keyframes() - CalibrationState::kWindow;
  BundleProblem window = MakeProblem(first, first + 1);
  window.correction_prior = prior;
  window.correction_turns = CorrectionBelief::ByTurn(camera_);
  calibration_.Follow(AdjustBundle(std::move(window), options_.solver), num_keyframes());
}

BundleProblem GlobalMap::MakeProblem() {
  BundleProblem problem = MakeProblem(FirstSeeing(), FirstMoving());
  problem.correction_prior = calibration_.Prior();
  return problem;
}

/// Poses are those of the keyframes from `first_seeing` on, then those that loops lead back to.
BundleProblem GlobalMap::MakeProblem(int first_seeing, int first_moving) {
  BundleProblem problem;
  problem.camera = camera_;
  problem.correction = calibration_.correction().mean;
  for (auto& [id, point] : store_.landmarks) {
    point.row = -1;
    const bool is_seen = point.last_keyframe >= first_moving;
    if (!is_seen || point.num_observations < options_.min_observations) continue;
    point.row = static_cast<int>(problem.points.size());
    problem.points.push_back(point.x_in_world);
  }
  for (int k = first_seeing; k < num_keyframes(); ++k) {
    const int pose = k - first_seeing;
    problem.camera_from_world.push_back(store_.keyframes[k].camera_from_world);
    bool is_tied = false;  // to older ones: not where the odometry was lost in between
    for (const LandmarkObservation& observation : store_.keyframes[k].observations) {
      const auto landmark = store_.Find(observation.landmark);
      if (landmark == store_.landmarks.end() || landmark->second.row < 0) continue;
      is_tied |= landmark->second.first_keyframe < k;
      problem.observations.push_back(
          {{observation.pixels, observation.has_right, observation.sigma_px},
           pose,
           landmark->second.row});
    }
    problem.pose_is_fixed.push_back(k < first_moving || !is_tied);
  }
  for (const PoseConstraint& loop : loops_) {
    if (loop.first >= first_seeing || loop.second < first_moving) continue;
    PoseConstraint constraint = loop;
    constraint.first = static_cast<int>(problem.camera_from_world.size());
    constraint.second -= first_seeing;
    problem.camera_from_world.push_back(store_.keyframes[loop.first].camera_from_world);
    problem.pose_is_fixed.push_back(true);
    problem.constraints.push_back(constraint);
  }
  return problem;
}

std::optional<MapUpdate> GlobalMap::Adjust(const BundleCallback& progress) {
  if (num_keyframes() < 2) return std::nullopt;
  next_adjustment_ =
      calibration_.first_telling() + NextAdjustment(num_adjusted(), options_.NumMoving());
  const Rigid3 newest_from_odom = store_.keyframes.back().camera_from_world * map_from_odom_;
  const bool is_bent = is_contradicted_;
  if (is_bent) BendOntoLoops();
  BundleProblem problem = MakeProblem();
  if (problem.observations.empty()) return std::nullopt;
  const bool is_open = problem.correction_prior.has_value();
  BundleResult result = AdjustBundle(std::move(problem), options_.solver, progress);
  if (!HasResult(result)) return std::nullopt;
  CalibrationState calibration = calibration_;
  if (is_open && !calibration.Learn(result, num_keyframes())) {
    problem = MakeProblem();  // the poses must be of the correction that is told
    problem.correction_prior.reset();
    problem.correction = calibration.correction().mean;
    result = AdjustBundle(std::move(problem), options_.solver, progress);
    if (!HasResult(result)) return std::nullopt;
  }
  calibration_ = std::move(calibration);
  num_adjusted_loops_ = loops_.size();
  MapUpdate update = TakeResult(result, is_bent);
  map_from_odom_ = store_.keyframes.back().camera_from_world.Inverse() * newest_from_odom;
  return update;
}

MapUpdate GlobalMap::TakeResult(const BundleResult& result, bool is_bent) {
  MapUpdate update;
  update.num_keyframes = num_adjusted();
  update.correction = calibration_.correction();
  const int first = is_bent ? 0 : FirstMoving() - 1;  // the held one moves against the newest
  for (int k = 0; k < num_keyframes(); ++k) {
    Keyframe& keyframe = store_.keyframes[k];
    if (k >= FirstSeeing()) {
      keyframe.camera_from_world = result.camera_from_world[k - FirstSeeing()];
    }
    if (k >= first) update.keyframes.push_back({keyframe.id, keyframe.camera_from_world});
  }
  for (auto& [id, point] : store_.landmarks) {
    if (point.row >= 0) {
      if (!result.point_is_used[point.row]) continue;
      point.x_in_world = result.points[point.row];
    } else if (!is_bent || point.num_observations < options_.min_observations) {
      continue;
    }
    update.landmarks.push_back({id, point.x_in_world});
  }
  return update;
}

}  // namespace arfm_vo
