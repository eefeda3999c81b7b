#include "arfm_vo/pose/pose_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/pose/false_alarms.h"
#include "arfm_vo/pose/reprojection.h"
#include "pose_equations.h"
#include "scaled_normal_matrix.h"

namespace arfm_vo {
namespace {

/// Expected fall of the cost at which a search ends: a tenth of the pose's standard deviation while
/// the inliers may change, a thousandth at the end.
constexpr double kRoughly = 1e-2, kEnough = 1e-6;
constexpr int kMaxIterations = 10;  ///< of each round
constexpr int kMinInliers = 4;
/// The measured scale of the residuals is kept in between, in stated standard deviations.
constexpr double kMinScale = 0.3, kMaxScale = 3;
/// Observations' worth of trust in the stated sigma_px.
constexpr double kScalePrior = 10;

/// What the loss needs to know for residuals of one number of coordinates.
struct ResidualModel {
  RobustLoss loss;
  double bound;        ///< of the chi-square test
  double median;       ///< of the squared norm of a residual within the bound
  double lost_weight;  ///< what the hard bound takes from the mean slope of the influence function

  ResidualModel(const PoseRefinementOptions& options, int num_coordinates)
      : loss(options.loss, options.loss_threshold_sigma, num_coordinates),
        bound(InlierBound(num_coordinates)),
        median(ChiSquareQuantile(num_coordinates, kInlierProbability / 2)),
        lost_weight(loss.Weight(bound) *
                    (1 - ChiSquareProbability(num_coordinates + 2, bound) / kInlierProbability)) {}
};

/// The normal equations with the cost.
struct Linearization : PoseNormalEquations {
  double cost = 0;
};

class Refiner {
 public:
  Refiner(const StereoCamera& camera, const std::vector<PointObservation>& observations,
          const Rigid3& camera_from_world, const PoseRefinementOptions& options,
          const std::vector<char>& is_inlier)
      : camera_(camera),
        observations_(observations),
        options_(options),
        models_{ResidualModel(options, 2), ResidualModel(options, 3)},
        equations_(camera, observations),
        squared_(observations.size()),
        weights_(observations.size()) {
    result_.camera_from_world = camera_from_world;
    result_.is_inlier = is_inlier;
    if (is_inlier.empty()) BeginWithProven();
    CountInliers();
  }

  PoseRefinement Run() {
    UpdateInformation();
    MeasureScale(std::numeric_limits<double>::infinity());  // the first pose may be far off
    for (int round = 0; round < options_.max_rounds; ++round) {
      if (!HasEnoughInliers() || !Iterate(kRoughly)) return result_;
      const double last_scale = result_.scale;
      UpdateInformation();
      MeasureScale(kMaxScale);
      const bool is_same = Classify();
      if (is_same && std::abs(result_.scale - last_scale) < 0.01 * last_scale) break;
    }
    if (!HasEnoughInliers() || !Iterate(kEnough)) return result_;
    UpdateInformation();
    if (FindCovariance()) result_.status = RefinementStatus::kConverged;
    return result_;
  }

 private:
  const ResidualModel& ModelOf(size_t i) const { return models_[observations_[i].has_right]; }

  bool HasEnoughInliers() const { return result_.num_inliers >= kMinInliers; }

  /// New points join where they agree with the pose of these: on something that moves they agree
  /// with one another so well that they would take the pose along.
  void BeginWithProven() {
    constexpr int kEnough = 15;  // fewer hardly fix a pose: all begin
    for (const PointObservation& observation : observations_) {
      result_.is_inlier.push_back(observation.is_proven);
    }
    CountInliers();
    if (result_.num_inliers < kEnough) result_.is_inlier.assign(observations_.size(), 1);
  }

  void CountInliers() {
    result_.num_inliers =
        static_cast<int>(std::count(result_.is_inlier.begin(), result_.is_inlier.end(), 1));
  }

  /// The information of each residual, and its squared norm, at the present pose.
  void UpdateInformation() {
    equations_.UpdateInformation(result_.camera_from_world);
    std::copy_n(equations_.SquareErrors(result_.camera_from_world), squared_.size(),
                squared_.begin());
  }

  void MeasureScale(double max_scale) {
    std::vector<double>& ratios = scratch_;
    ratios.clear();
    for (size_t i = 0; i < observations_.size(); ++i) {
      if (result_.is_inlier[i]) ratios.push_back(squared_[i] / ModelOf(i).median);
    }
    if (ratios.empty()) return;
    const auto middle = ratios.begin() + ratios.size() / 2;
    std::nth_element(ratios.begin(), middle, ratios.end());
    const double count = static_cast<double>(ratios.size());
    const double variance = (count * *middle + kScalePrior) / (count + kScalePrior);
    result_.scale = std::clamp(std::sqrt(variance), kMinScale, max_scale);
  }

  /// Returns whether the inliers stay the same.
  bool Classify() {
    bool is_same = true;
    for (size_t i = 0; i < observations_.size(); ++i) {
      const char is_inlier = squared_[i] <= ModelOf(i).bound * result_.scale * result_.scale;
      is_same &= is_inlier == result_.is_inlier[i];
      result_.is_inlier[i] = is_inlier;
    }
    CountInliers();
    return is_same;
  }

  Linearization Linearize(const Rigid3& camera_from_world) {
    const double inverse_variance = 1 / (result_.scale * result_.scale);
    LossSum sums[] = {LossSum(models_[0].loss), LossSum(models_[1].loss)};
    const double* squared = equations_.SquareErrors(camera_from_world);
    for (size_t i = 0; i < observations_.size(); ++i) {
      weights_[i] = 0;
      if (!result_.is_inlier[i]) continue;
      const double s = squared[i] < kBehindCamera ? squared[i] * inverse_variance : kBehindCamera;
      sums[observations_[i].has_right].Add(s);
      weights_[i] = ModelOf(i).loss.Weight(s) * inverse_variance;
    }
    return {equations_.Accumulate(camera_from_world, weights_), sums[0].Sum() + sums[1].Sum()};
  }

  /// Iterates to the minimum for fixed inliers, scale and information. Returns false, with the
  /// status, where the points do not fix the pose.
  bool Iterate(double enough) {
    Linearization equations = Linearize(result_.camera_from_world);
    double damping = 0;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      const ScaledNormalMatrix matrix(equations.hessian);
      if (!matrix.IsFullRank()) {
        result_.status = RefinementStatus::kRankDeficient;
        return false;
      }
      ++result_.num_iterations;
      const ScaledNormalMatrix::Vector6d step = matrix.Solve(equations.gradient, damping);
      const Rigid3 moved = BoxPlus(result_.camera_from_world, step);
      const double expected = equations.gradient.dot(step);
      const Linearization moved_equations = Linearize(moved);
      if (moved_equations.cost <= equations.cost) {
        result_.camera_from_world = moved;
        equations = moved_equations;
        damping = damping > 1e-6 ? damping / 10 : 0;
      } else if (options_.step == StepKind::kLevenbergMarquardt) {
        damping = std::max(1e-3, 10 * damping);
      } else {
        break;
      }
      if (expected < enough) break;
    }
    return true;
  }

  /// (b / a^2) (J^T S^-1 J)^-1 with a the mean slope and b the mean square of the influence
  /// function (Huber 1981, 7.6), both for a coordinate, and n - 6 degrees of freedom.
  bool FindCovariance() {
    const Eigen::Matrix3d rotation = result_.camera_from_world.RotationMatrix();
    const double inverse_variance = 1 / (result_.scale * result_.scale);
    double slope = 0, square = 0, num_coordinates = 0, squared_px = 0;
    for (size_t i = 0; i < observations_.size(); ++i) {
      weights_[i] = result_.is_inlier[i] ? inverse_variance : 0;
      if (!result_.is_inlier[i]) continue;
      const ResidualModel& model = ModelOf(i);
      const int k = observations_[i].NumCoordinates();
      const double s = squared_[i] * inverse_variance;
      const double weight = model.loss.Weight(s);
      slope += k * (weight - model.lost_weight) + 2 * s * model.loss.WeightSlope(s);
      square += weight * weight * s;
      num_coordinates += k;
      const Eigen::Vector3d x =
          rotation * observations_[i].x_in_world + result_.camera_from_world.translation;
      squared_px += ReprojectionError(camera_, observations_[i], x).squaredNorm();
    }
    const ScaledNormalMatrix matrix(
        equations_.Accumulate(result_.camera_from_world, weights_).hessian);
    result_.rms_px = std::sqrt(squared_px / num_coordinates);
    const double freedom = std::max(1.0, num_coordinates - 6);
    // The stated noise stands in where the residuals are too small or too few to tell.
    const double least = kMinScale * kMinScale * inverse_variance;
    const double b = std::max(square / freedom, least);
    const double a = std::max(slope / num_coordinates, 0.1);
    if (!matrix.IsFullRank()) {
      result_.status = RefinementStatus::kRankDeficient;
      return false;
    }
    result_.covariance = b / (a * a) * matrix.Inverse();
    result_.covariance = (result_.covariance + result_.covariance.transpose()).eval() / 2;
    return true;
  }

  const StereoCamera& camera_;
  const std::vector<PointObservation>& observations_;
  const PoseRefinementOptions& options_;
  const ResidualModel models_[2];
  PoseEquations equations_;
  std::vector<double> squared_;  ///< [N], at the present pose
  std::vector<double> weights_;  ///< [N]
  std::vector<double> scratch_;
  PoseRefinement result_;
};

}  // namespace

void PoseRefinementOptions::Check() const {
  Require(max_rounds >= 1, "refinement.max_rounds must be at least 1");
  Require(loss_threshold_sigma > 0, "refinement.loss_threshold_sigma must be positive");
}

PoseRefinement RefinePose(const StereoCamera& camera,
                          const std::vector<PointObservation>& observations,
                          const Rigid3& camera_from_world, const PoseRefinementOptions& options,
                          const std::vector<char>& is_inlier) {
  options.Check();
  Require(is_inlier.empty() || is_inlier.size() == observations.size(),
          "pose refinement: is_inlier must have one flag an observation");
  Require(camera_from_world.IsFinite(), "pose refinement: the first pose is not finite");
  RequireValid(observations);
  return Refiner(camera, observations, camera_from_world, options, is_inlier).Run();
}

}  // namespace arfm_vo
