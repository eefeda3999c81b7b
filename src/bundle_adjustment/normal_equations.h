#pragma once

#include <Eigen/Core>
#include <vector>

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"
#include "bundle_structure.h"
#include "reduced_system.h"

namespace arfm_vo {

struct BundleState {
  std::vector<Rigid3> camera_from_world;
  std::vector<Eigen::Vector3d> points;
  StereoCorrection correction;
};

/// [x]x m
inline Eigen::Matrix3d CrossColumns(const Eigen::Vector3d& x, const Eigen::Matrix3d& m) {
  Eigen::Matrix3d product;
  product.row(0) = x.y() * m.row(2) - x.z() * m.row(1);
  product.row(1) = x.z() * m.row(0) - x.x() * m.row(2);
  product.row(2) = x.x() * m.row(1) - x.y() * m.row(0);
  return product;
}

/// The step of all unknowns, and what the linear model promises of it.
struct BundleStep {
  Eigen::VectorXd reduced;              ///< six a free pose, then the correction's
  std::vector<Eigen::Vector3d> points;  ///< [tracks]
  double expected_decrease = 0;         ///< of the cost
};

/// Gauss-Newton equations of a bundle with robust weights (IRLS), solved by eliminating the points
/// (the Schur complement; Triggs et al. 2000, 6.1).
class NormalEquations {
 public:
  NormalEquations(const BundleProblem& problem, const BundleSelection& selection,
                  const BundleStructure& structure, const BundleOptions& options);

  /// Sets up the equations at a state and returns its cost.
  double Linearize(const BundleState& state);
  /// After Linearize: what is left with the points eliminated, `damping` times the diagonal added.
  const ReducedSystem& EliminatePoints(double damping);
  /// Solves with `damping` times the diagonal added. Returns false where the equations are not
  /// positive definite.
  bool Solve(double damping, BundleStep& step);
  void Apply(const BundleStep& step, BundleState& state) const;

  /// After Solve: columns of the inverse of the reduced matrix, [size x count] from `first` on.
  Eigen::MatrixXd InverseColumns(int first, int count) const;
  int reduced_size() const { return solver_.size(); }
  /// After Linearize: [tracks] the points' own blocks.
  const std::vector<Eigen::Matrix3d>& point_blocks() const { return point_blocks_; }

 private:
  /// What ties a pose to a point that it sees: J_pose^T W J_point = ([x]x, I) m R, with m =
  /// A^T W A, A the observation's derivative by x = R X + t.
  struct Tie {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();  ///< m, camera frame
    Vector6d upper = Vector6d::Zero();            ///< of m: xx, xy, yy, xz, yz, zz

    void Set(const Eigen::Matrix3d& m) {
      upper << m(0, 0), m(0, 1), m(1, 1), m(0, 2), m(1, 2), m(2, 2);
    }
    Eigen::Matrix3d M() const {
      Eigen::Matrix3d m;
      m << upper[0], upper[1], upper[3], upper[1], upper[2], upper[4], upper[3], upper[4], upper[5];
      return m;
    }
  };
  using PoseByPoint = Eigen::Matrix<double, 6, 3>;

  double LinearizeObservation(const ReprojectionModel& model, const BundleState& state, int track,
                              int index);
  void LinearizeByTurns(const ReprojectionTerm& term, double weight,
                        const Eigen::Matrix3d& rotation, int track, int free_pose);
  void LinearizeByCorrection(const ReprojectionTerm& term, double weight,
                             const Eigen::Matrix3d& rotation, int track, int free_pose);
  /// Of the correction by itself, where it is solved for: the lower triangle.
  void LinearizeCorner(const ReprojectionTerm& term, double weight);
  void EliminatePoint(int track, double damping);
  double AddConstraints(const BundleState& state);
  double AddPrior(const BundleState& state);
  void Damp(double damping);
  Eigen::Matrix3d DampedInverse(int track, double damping) const;
  void FindPointSteps(double damping, BundleStep& step) const;
  void MeasureStep(double damping, BundleStep& step) const;

  const BundleProblem& problem_;
  const BundleSelection& selection_;
  const BundleStructure& structure_;
  const RobustLoss losses_[2];  ///< without and with a right pixel
  const double max_time_share_;
  const int num_coefficients_;  ///< of the correction that are free
  CorrectionBelief::Matrix prior_information_ = CorrectionBelief::Matrix::Zero();
  ReducedSolver solver_;
  std::vector<Eigen::Matrix3d> rotations_;     ///< [poses]
  ReducedSystem held_;                         ///< equations with the points held
  ReducedSystem reduced_;                      ///< with the points eliminated
  std::vector<Tie> ties_;                      ///< [observations] poses by points
  std::vector<Eigen::Matrix3d> point_blocks_;  ///< points by points
  Eigen::Matrix3Xd point_rights_;              ///< [3 x tracks] of b
  std::vector<PoseByPoint> track_blocks_;      ///< of the point that is being eliminated
  /// [coefficients x 3 tracks] correction by points, and that times the inverse of their blocks.
  Eigen::MatrixXd point_borders_, solved_borders_;
  /// [kNumField^2] of the field's coefficients of u by each other, which are those of v by each
  /// other.
  Eigen::Matrix<double, StereoCorrection::kNumField, StereoCorrection::kNumField> field_block_;
};

}  // namespace arfm_vo
