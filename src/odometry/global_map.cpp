#include "arfm_vo/odometry/global_map.h"

#include <algorithm>
#include <utility>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

/// One held keyframe for so many that move keeps what it saw of the same landmarks.
constexpr int kHeldShare = 5;

constexpr double kAdjustmentGrowth = 1.5;

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
      closer_(camera, options.loops),
      calibration_(camera, options.learn_correction, correction) {
  camera.Check();
  options.Check();
}

void GlobalMap::Add(const Keyframe& keyframe, const std::vector<Landmark>& landmarks) {
  Require(store_.keyframes.empty() || keyframe.id > store_.keyframes.back().id,
          "global map: keyframe " + std::to_string(keyframe.id) + " is not newer than the last");
  const int newest = num_keyframes();
  const Rigid3 camera_from_map = keyframe.camera_from_world * map_from_odom_.Inverse();
  if (newest > 0) {
    const Rigid3& before = store_.keyframes.back().camera_from_world;
    calibration_.AddTurn((camera_from_map * before.Inverse()).Angle());
  }
  if (keyframe.right_turn) calibration_.Turn(*keyframe.right_turn, newest);
  store_.keyframes.push_back({keyframe.id, camera_from_map, keyframe.observations});
  for (const Landmark& landmark : landmarks) {
    MapStore::Point& point = store_.landmarks[landmark.id];
    point.x_in_world = map_from_odom_ * landmark.x_in_world;
    point.first_keyframe = newest;
    point.appearance = {landmark.descriptor.data(), landmark.keypoint.laplacian_sign};
  }
  for (const LandmarkObservation& observation : keyframe.observations) {
    const auto landmark = store_.landmarks.find(observation.landmark);
    if (landmark == store_.landmarks.end()) continue;
    ++landmark->second.num_observations;
    landmark->second.last_keyframe = newest;
  }
  Settle();
  if (options_.loops.enabled)
    closer_.Add(store_, keyframe.step_covariance, calibration_.correction().mean);
  FollowCalibration();
  const int first_moving = FirstMoving();
  if (num_keyframes() > options_.max_keyframes)
    store_.Forget(first_moving, first_moving - options_.max_keyframes / kHeldShare);
}

/// What is old enough to be known again: before it is forgotten.
void GlobalMap::Settle() {
  const LoopOptions& loops = options_.loops;
  const bool is_kept = options_.max_settled_points > 0;
  int first_unsettled = num_keyframes() - loops.min_gap_keyframes;
  if (num_keyframes() > options_.max_keyframes)
    first_unsettled = std::max(first_unsettled, FirstMoving());
  const size_t for_loops = loops.enabled ? loops.max_points : 0;
  store_.Settle(first_unsettled, is_kept ? options_.max_settled_points : for_loops);
}

int NextAdjustment(int num_keyframes, int num_moving) {
  return std::clamp(static_cast<int>(kAdjustmentGrowth * num_keyframes), num_keyframes + 1,
                    num_keyframes + std::max(1, num_moving / 2));
}

bool GlobalMap::IsAdjustmentDue() const {
  return num_keyframes() >= next_adjustment_ || closer_.is_contradicted() ||
         calibration_.IsTurning();
}

int GlobalMap::FirstMoving() const {
  // The first of all never moves, nor do those of another correction.
  return std::max(calibration_.first_telling() + 1, num_keyframes() - options_.max_keyframes);
}

int GlobalMap::FirstSeeing() const {
  return std::max(store_.first_seeing, calibration_.first_telling());
}

/// Landmarks move with the keyframe that saw them first.
void GlobalMap::MoveTo(const std::vector<Rigid3>& camera_from_world) {
  for (auto& [id, point] : store_.landmarks) {
    const int k = point.first_keyframe;
    point.x_in_world =
        camera_from_world[k].Inverse() * (store_.keyframes[k].camera_from_world * point.x_in_world);
  }
  for (int k = 0; k < num_keyframes(); ++k)
    store_.keyframes[k].camera_from_world = camera_from_world[k];
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
  rows_ = store_.SeenFrom(first_moving, options_.min_observations);
  for (const auto& [id, point] : rows_) problem.points.push_back(point->x_in_world);
  size_t num_observations = 0;
  for (int k = first_seeing; k < num_keyframes(); ++k)
    num_observations += store_.keyframes[k].observations.size();
  problem.observations.reserve(num_observations);
  for (int k = first_seeing; k < num_keyframes(); ++k) {
    const int pose = k - first_seeing;
    problem.camera_from_world.push_back(store_.keyframes[k].camera_from_world);
    bool is_tied = false;  // to older ones: not where the odometry was lost in between
    auto row = rows_.begin();
    for (const LandmarkObservation& observation : store_.keyframes[k].observations) {
      row = std::lower_bound(row, rows_.end(), observation.landmark,
                             [](const auto& a, LandmarkId landmark) { return a.first < landmark; });
      if (row == rows_.end()) break;
      if (row->first != observation.landmark) continue;
      is_tied |= row->second->first_keyframe < k;
      problem.observations.push_back({observation, pose, static_cast<int>(row - rows_.begin())});
    }
    problem.pose_is_fixed.push_back(k < first_moving || !is_tied);
  }
  for (PoseConstraint loop : closer_.loops()) {
    if (loop.second < first_moving) continue;
    loop.second -= first_seeing;
    if (loop.first < first_seeing) {
      problem.camera_from_world.push_back(store_.keyframes[loop.first].camera_from_world);
      problem.pose_is_fixed.push_back(true);
      loop.first = static_cast<int>(problem.camera_from_world.size()) - 1;
    } else {
      loop.first -= first_seeing;
    }
    problem.constraints.push_back(loop);
  }
  return problem;
}

std::optional<MapUpdate> GlobalMap::Adjust(const BundleCallback& progress) {
  if (num_keyframes() < 2) return std::nullopt;
  next_adjustment_ =
      calibration_.first_telling() + NextAdjustment(num_adjusted(), options_.max_keyframes);
  const Rigid3 newest_from_odom = store_.keyframes.back().camera_from_world * map_from_odom_;
  const bool is_bent = IsToBeBent();
  const std::vector<Rigid3> before = is_bent ? store_.Poses() : std::vector<Rigid3>();
  if (is_bent) MoveTo(closer_.Bend(store_));
  const auto result = Solve(progress);
  if (!result) {
    if (is_bent) MoveTo(before);
    return std::nullopt;
  }
  MapUpdate update = TakeResult(*result, is_bent);
  map_from_odom_ = store_.keyframes.back().camera_from_world.Inverse() * newest_from_odom;
  return update;
}

std::optional<BundleResult> GlobalMap::Solve(const BundleCallback& progress) {
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
  return result;
}

MapUpdate GlobalMap::TakeResult(const BundleResult& result, bool is_bent) {
  MapUpdate update;
  update.num_keyframes = num_adjusted();
  update.correction = calibration_.correction();
  // The held one moves against the newest; where older ones stand in this map nobody was told.
  const int first = is_bent ? 0 : std::min(num_told_, FirstMoving() - 1);
  for (int k = 0; k < num_keyframes(); ++k) {
    MapStore::Keyframe& keyframe = store_.keyframes[k];
    if (k >= FirstSeeing()) {
      keyframe.camera_from_world = result.camera_from_world[k - FirstSeeing()];
    }
    if (k >= first) update.keyframes.push_back({keyframe.id, keyframe.camera_from_world});
  }
  num_told_ = num_keyframes();
  for (size_t k = 0; k < store_.settled.size(); ++k)
    store_.settled[k].map_from_camera = store_.keyframes[k].camera_from_world.Inverse();
  closer_.TakeSteps(store_, FirstMoving() - 1);
  auto row = rows_.begin();
  for (auto& [id, point] : store_.landmarks) {
    if (row != rows_.end() && row->first == id) {
      const auto i = row++ - rows_.begin();
      if (!result.point_is_used[i]) continue;
      point.x_in_world = result.points[i];
    } else if (!is_bent || point.num_observations < options_.min_observations) {
      continue;
    }
    update.landmarks.push_back({id, point.x_in_world});
  }
  return update;
}

}  // namespace arfm_vo
