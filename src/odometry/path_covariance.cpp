#include "arfm_vo/odometry/path_covariance.h"

#include "arfm_vo/bundle_adjustment/pose_information.h"
#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

/// Points by which a step is told, at most about.
constexpr size_t kNumPoints = 100;

}  // namespace

PoseDrift FindDrift(const StereoCamera& camera, const StereoCorrection& correction,
                    const LocalMap& map, const OdometryUpdate& update,
                    const BundleOptions& solver) {
  const Keyframe& before = map.keyframes().back();
  const LandmarkObservations& now = update.observations;
  PoseDrift drift{update.pose.covariance - update.doubt};
  BundleProblem problem;
  problem.camera = camera;
  BundleResult result;
  result.correction = correction;
  problem.camera_from_world = {before.camera_from_world, update.pose.camera_from_world};
  result.camera_from_world = problem.camera_from_world;
  const size_t every = 1 + now.size() / kNumPoints;
  size_t num_shared = 0;
  auto seen = before.observations.begin();
  for (const LandmarkObservation& observation : now) {
    while (seen != before.observations.end() && seen->landmark < observation.landmark) ++seen;
    if (seen == before.observations.end()) break;
    if (seen->landmark != observation.landmark) continue;
    if (num_shared++ % every != 0) continue;
    const int point = static_cast<int>(problem.points.size());
    problem.points.push_back(map.landmarks().at(observation.landmark).x_in_world);
    for (const auto* sighting : {&*seen, &observation}) {
      problem.observations.push_back({*sighting, sighting == &*seen ? 0 : 1, point});
    }
  }
  result.points = problem.points;
  result.point_is_used.assign(result.points.size(), 1);
  const PoseInformation information = FindPoseInformation(problem, result, solver);
  const auto by_correction = SolveDefinite(information.poses.bottomRightCorner(6, 6),
                                           information.by_correction.bottomRows(6));
  if (by_correction) drift.by_correction = -*by_correction;
  return drift;
}

void PathCovariance::SetCorrection(const CorrectionBelief& correction, const LocalMap& map,
                                   const Keyframe* anchor) {
  std::map<KeyframeId, Rigid3> moved;
  for (const Keyframe& keyframe : map.keyframes()) {
    if (anchor == nullptr || keyframe.id >= anchor->id) break;
    moved[keyframe.id] = keyframe.camera_from_world * anchor->camera_from_world.Inverse();
  }
  drift_.SetCorrection(correction, anchor == nullptr ? 0 : anchor->id, moved);
}

void PathCovariance::Begin(const Rigid3& camera_from_world, const Matrix6& covariance) {
  newest_ = PoseDrift{covariance};
  newest_rotation_ = camera_from_world.RotationMatrix();
  way_ = {};
  doubt_ = {};
  FollowWay(camera_from_world, true);
  settled_covariance_.setZero();
}

void PathCovariance::AddPose(const Keyframe& newest, const Rigid3& camera_from_world,
                             const PoseDrift& own) {
  newest_ = drift_.Beside(newest.id, camera_from_world * newest.camera_from_world.Inverse(), own);
  newest_rotation_ = camera_from_world.RotationMatrix();
}

void PathCovariance::AddKeyframe(KeyframeId keyframe, KeyframeId oldest, const Matrix6& doubt) {
  way_.AddDoubt(newest_rotation_.transpose() * doubt.bottomRightCorner<3, 3>() * newest_rotation_);
  drift_.Add(keyframe, newest_);
  drift_.Forget(oldest);
}

void PathCovariance::Settle(const Keyframe& keyframe) {
  const Rigid3 step = keyframe.camera_from_world * settled_from_world_.Inverse();
  const Matrix6 covariance = OfKeyframe(keyframe);
  // What is negative in it is an adjustment that knew more than the one before.
  const SymmetricEigen added(covariance - CarryCovariance(step, settled_covariance_));
  const Eigen::MatrixXd variances = added.values.cwiseMax(0).asDiagonal();
  step_covariance_ = Propagate(added.vectors, variances);
  settled_from_world_ = keyframe.camera_from_world;
  settled_covariance_ = covariance;
}

void PathCovariance::Clear() {
  drift_.Clear();
  way_ = {};
  doubt_ = {};
}

PathCovariance::Matrix6 PathCovariance::WithWay(Matrix6 covariance,
                                                const Eigen::Matrix3d& camera_from_world) const {
  covariance.bottomRightCorner<3, 3>() +=
      camera_from_world * (way_.Covariance() + doubt_.Covariance()) * camera_from_world.transpose();
  return covariance;
}

}  // namespace arfm_vo
