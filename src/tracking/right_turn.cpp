#include "arfm_vo/tracking/right_turn.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "arfm_vo/geometry/linear_algebra.h"
#include "arfm_vo/geometry/right_shift.h"
#include "arfm_vo/pose/reprojection.h"

namespace arfm_vo {
namespace {

/// Log odds of a knock between two pairs: one in hours.
constexpr double kKnocked = -11;
/// A pair errs as a whole by so much.
constexpr double kCommonSigma_px = 0.1;
/// Observations that are looked at, at most, and those that suffice.
constexpr size_t kMost = 200, kLeast = 20;
constexpr int kIterations = 4;

using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;
using RightByTurn = Eigen::Matrix<double, 2, 3>;

/// Of the right image's pixel by the turn, px/rad.
RightByTurn ByTurn(const StereoCamera& camera, const CorrectionBelief::Turns& by_turn,
                   const Eigen::Vector2d& right) {
  constexpr int kNum = StereoCorrection::kNumField;
  const ImageBasis basis(camera, right);
  RightByTurn derivative;
  derivative.row(0) = basis.values.transpose() * by_turn.topRows<kNum>();
  derivative.row(1) = basis.values.transpose() * by_turn.bottomRows<kNum>();
  return derivative;
}

/// A pose and a turn that explain what was seen.
class Solver {
 public:
  Solver(const StereoCamera& camera, const StereoCorrection& correction,
         const Rigid3& camera_from_world)
      : camera_(camera),
        correction_(correction),
        by_turn_(CorrectionBelief::ByTurn(camera)),
        camera_from_world_(camera_from_world) {}

  void Add(const Landmark& landmark, const LandmarkObservation& observation) {
    const Eigen::Vector3d x = camera_from_world_ * landmark.x_in_world;
    if (!(x.z() > kMinDepth)) return;
    const Eigen::Vector4d seen = ProjectStereo4(camera_, correction_, x);
    const RightByTurn of_right = ByTurn(camera_, by_turn_, seen.tail<2>());
    const Eigen::Matrix3d by_point = ProjectionJacobian(camera_, x);
    Eigen::Matrix<double, 4, 3> projection;
    projection << by_point, by_point.row(1);
    Eigen::Matrix<double, 3, 6> moved;  // of BoxPlus: rotation about the camera, then translation
    moved << 0, x.z(), -x.y(), 1, 0, 0, -x.z(), 0, x.x(), 0, 1, 0, x.y(), -x.x(), 0, 0, 0, 1;
    Eigen::Matrix<double, 4, 9> jacobian = Eigen::Matrix<double, 4, 9>::Zero();
    jacobian.leftCols<6>() = projection * moved;
    jacobian.bottomRightCorner<2, 3>() = of_right;
    Eigen::Vector4d error = observation.Pixels() - seen;
    error.tail<2>() -= of_right * turn_;
    const Eigen::Matrix<double, 4, 3> by_world = projection * camera_from_world_.RotationMatrix();
    Eigen::Matrix4d covariance = by_world * landmark.covariance * by_world.transpose();
    covariance.diagonal().array() += observation.sigma_px * observation.sigma_px;
    const Eigen::Matrix4d of_error = covariance.inverse();
    const double squared = error.dot(of_error * error);
    const double weight = 1 / (1 + squared / 4);
    squared_ += weight * squared;
    num_coordinates_ += 4 * weight;
    const Eigen::Matrix<double, 9, 4> weighted =
        weight * jacobian.transpose().lazyProduct(of_error);  // (faster than as a general product)
    information_ += weighted.lazyProduct(jacobian);
    gradient_ += weighted * error;
  }

  void Step() {
    const Vector9 step = SolveSymmetric(information_, gradient_);
    camera_from_world_ = Rigid3(ExpSO3(step.head<3>()), step.segment<3>(3)) * camera_from_world_;
    turn_ += step.tail<3>();
    last_information_ = information_ / std::max(1., squared_ / std::max(1., num_coordinates_));
    squared_ = num_coordinates_ = 0;
    information_.setZero();
    gradient_.setZero();
  }

  std::optional<RightTurn> Result() const {
    const auto covariance = SolveDefinite(last_information_, Matrix9::Identity());
    if (!covariance) return std::nullopt;
    const Eigen::Matrix3d common = Propagate(
        CorrectionBelief::ToTurn(camera_), CorrectionBelief::Isotropic(kCommonSigma_px).covariance);
    return RightTurn{turn_, covariance->bottomRightCorner<3, 3>() + common};
  }

 private:
  StereoCamera camera_;
  StereoCorrection correction_;
  CorrectionBelief::Turns by_turn_;
  Rigid3 camera_from_world_;
  Eigen::Vector3d turn_ = Eigen::Vector3d::Zero();
  Matrix9 information_ = Matrix9::Zero(), last_information_ = Matrix9::Zero();
  Vector9 gradient_ = Vector9::Zero();
  double squared_ = 0, num_coordinates_ = 0;  ///< errors in units of what is expected
};

}  // namespace

std::optional<RightTurn> FindTurnAgainstMap(const StereoCamera& camera,
                                            const StereoCorrection& correction,
                                            const std::vector<const Landmark*>& landmarks,
                                            const LandmarkObservations& observations,
                                            const Rigid3& camera_from_world) {
  std::vector<size_t> seen;
  for (size_t i = 0; i < observations.size(); ++i) {
    if (observations[i].has_right) seen.push_back(i);
  }
  if (seen.size() < kLeast) return std::nullopt;
  const size_t every = 1 + seen.size() / kMost;
  Solver solver(camera, correction, camera_from_world);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (size_t k = 0; k < seen.size(); k += every) {
      solver.Add(*landmarks[seen[k]], observations[seen[k]]);
    }
    solver.Step();
  }
  return solver.Result();
}

std::optional<RightTurn> FindTurnSince(const RightTurn& before, const RightTurn& now) {
  const RightTurn since{now.turn_rad - before.turn_rad, now.covariance + before.covariance};
  const Eigen::Matrix3d if_turned =
      RightTurn::kKnockSigma_rad * RightTurn::kKnockSigma_rad * Eigen::Matrix3d::Identity() +
      since.covariance;
  const double occam = std::log(if_turned.determinant() / since.covariance.determinant());
  const double log_odds = kKnocked + (SquaredMahalanobis(since.turn_rad, since.covariance) -
                                      SquaredMahalanobis(since.turn_rad, if_turned) - occam) /
                                         2;
  return log_odds > 0 ? std::optional(since) : std::nullopt;
}

std::optional<RightTurn> RightTurns::Look(const std::optional<RightTurn>& against_map,
                                          KeyframeId next) {
  if (!against_map) return std::nullopt;
  const auto turn = FindTurnSince(against_map_, *against_map);
  if (turn) {
    turns_[next] += *turn;  // and the map is seen with it, as before
  } else {
    against_map_ = *against_map;
  }
  return turn;
}

void RightTurns::Interrupt(const CorrectionBelief& correction, const StereoCamera& camera) {
  against_map_ = {Eigen::Vector3d::Zero(),
                  Propagate(CorrectionBelief::ToTurn(camera), correction.covariance)};
}

std::optional<RightTurn> RightTurns::Before(KeyframeId keyframe) const {
  const auto found = turns_.find(keyframe);
  return found == turns_.end() ? std::nullopt : std::optional(found->second);
}

CorrectionBelief RightTurns::Follow(CorrectionBelief learnt, KeyframeId newest,
                                    const StereoCamera& camera) {
  turns_.erase(turns_.begin(), turns_.upper_bound(newest));
  for (const auto& [keyframe, turn] : turns_) learnt = learnt.After(turn, camera);
  return learnt;
}

}  // namespace arfm_vo
