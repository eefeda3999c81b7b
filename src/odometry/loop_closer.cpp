#include "arfm_vo/odometry/loop_closer.h"


#include "arfm_vo/base/check.h"
#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"
#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kProbability = 0.99;  ///< that a loop that is right is within what is stated
/// Each so manyth keyframe is looked at, and those after one that is recognised, until that is
/// confirmed or refuted.
constexpr int kLoopInterval = 3;
/// A step is no surer, rad^2 and m^2, for the sake of the numbers.
constexpr double kMinVariance = 1e-10;

/// A loop is seen from many keyframes: one in which most of what looks alike does not agree can be
/// left out, which costs an eighth of the samples. How many must agree the false alarms decide.
PoseEstimatorOptions LoopPose() {
  PoseEstimatorOptions options = RecognitionPose();
  options.min_inliers = PoseEstimatorOptions().min_inliers;
  options.min_inlier_share = 0.5;
  options.ransac.max_iterations = 52;
  return options;
}

}  // namespace

LoopCloser::LoopCloser(const StereoCamera& camera, const LoopOptions& options)
    : camera_(camera), options_(options), finder_(MakeFinder()) {}

PlaceFinder LoopCloser::MakeFinder() const {
  constexpr int kConfirming = 2;  ///< keyframes before the one that closes a loop
  return PlaceFinder(camera_, kConfirming, LoopPose());
}

void LoopOptions::Check() const {
  Require(min_gap_keyframes >= 1, "loops.min_gap_keyframes must be at least 1");
  Require(max_points >= 1, "loops.max_points must be at least 1");
}

void LoopCloser::Add(const MapStore& map, const Matrix6& step_covariance,
                     const StereoCorrection& correction) {
  AddStep(map, step_covariance);
  if (const auto loop = Find(map, correction)) Close(map, *loop);
}

void LoopCloser::AddStep(const MapStore& map, const Matrix6& covariance) {
  const int newest = static_cast<int>(map.keyframes.size()) - 1;
  if (newest == 0) return;
  steps_.push_back({newest - 1, newest,
                    map.keyframes[newest].camera_from_world *
                        map.keyframes[newest - 1].camera_from_world.Inverse(),
                    InvertDefinite(covariance + kMinVariance * Matrix6::Identity())});
}

void LoopCloser::TakeSteps(const MapStore& map, int first) {
  for (size_t k = first; k < steps_.size(); ++k) {
    steps_[k].second_from_first =
        map.keyframes[k + 1].camera_from_world * map.keyframes[k].camera_from_world.Inverse();
  }
}

std::optional<PoseConstraint> LoopCloser::Find(const MapStore& map,
                                               const StereoCorrection& correction) {
  const std::vector<KnownKeyframe>& known = map.settled;
  if (num_points_ > 2 * static_cast<size_t>(options_.max_points)) {  // most are left out by now
    finder_ = MakeFinder();
    num_known_ = num_points_ = 0;
  }
  finder_.Add(known, num_known_);
  for (; num_known_ < known.size(); ++num_known_) num_points_ += known[num_known_].points.size();
  const int newest = static_cast<int>(map.keyframes.size()) - 1;
  if (newest % kLoopInterval != 0 && !is_to_be_confirmed_) return std::nullopt;
  const Rigid3& camera_from_world = map.keyframes[newest].camera_from_world;
  const auto found =
      finder_.Find(map.NewestView(camera_, correction), camera_from_world.Inverse(), known);
  is_to_be_confirmed_ = !found && finder_.has_recognised();
  if (!found) return std::nullopt;
  return PoseConstraint{static_cast<int>(found->keyframe), newest, found->camera_from_keyframe,
                        InvertDefinite(found->covariance)};
}

void LoopCloser::Close(const MapStore& map, const PoseConstraint& loop) {
  const double allowed = ChiSquareQuantile(6, kProbability);
  const std::vector<Rigid3> poses = map.Poses();
  const Vector6 error = LinearizeConstraint(loop, poses[loop.first], poses[loop.second]).residual;
  const bool agrees = error.dot(loop.information * error) <= allowed;
  if (!agrees) {
    const Matrix6 covariance =
        FindErrorCovariance(poses, steps_, loops_, loop) + InvertDefinite(loop.information);
    if (!(SquaredMahalanobis(error, covariance) <= allowed)) {
      ++num_refused_;
      return;
    }
  }
  is_contradicted_ |= !agrees;
  measured_.push_back(loop);
  loops_.push_back(loop);
}

std::vector<Rigid3> LoopCloser::Bend(const MapStore& map) {
  finder_.ForgetSightings();
  is_contradicted_ = false;
  loops_ = measured_;
  num_bent_ = loops_.size();
  return SolvePoseGraph(map.Poses(), steps_, loops_);
}

}  // namespace arfm_vo
