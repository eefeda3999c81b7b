#pragma once

#include <Eigen/Core>
#include <functional>
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

/// The step of all unknowns, and what the linear model promises of it.
struct BundleStep {
  Eigen::VectorXd reduced;              ///< six a free pose, then the correction's
  std::vector<Eigen::Vector3d> points;  ///< [tracks]
  double expected_decrease = 0;         ///< of the cost
};

/// Gauss-Newton equations of a bundle with robust weights (IRLS), solved by eliminating the points
/// (the Schur complement; Triggs et al. 2000, 6.1). Points are dealt out to threads in pieces that
/// do not depend on the number of threads, so the result does not either.
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
  struct Piece {
    int first_track = 0, last_track = 0;
    double cost = 0;
    ReducedSystem sum;
  };
  void ForEachPiece(const std::function<void(Piece&)>& work);
  void LinearizePiece(const BundleState& state, Piece& piece);
  void LinearizeSighting(const ReprojectionModel& model, const BundleState& state, int track,
                         int index, Piece& piece);
  void LinearizeByTurns(const ReprojectionTerm& term, double weight,
                        const Eigen::Matrix3d& rotation, int track, int free_pose, Piece& piece);
  void LinearizeByCorrection(const ReprojectionTerm& term, double weight,
                             const Eigen::Matrix3d& rotation, int track, int free_pose,
                             Piece& piece);
  void EliminatePiece(double damping, Piece& piece);
  double AddConstraints(const BundleState& state);
  double AddPrior(const BundleState& state);
  void Damp(double damping);
  void FindPointSteps(BundleStep& step) const;
  void MeasureStep(double damping, BundleStep& step) const;

  const BundleProblem& problem_;
  const BundleSelection& selection_;
  const BundleStructure& structure_;
  const RobustLoss losses_[2];  ///< without and with a right pixel
  const int num_threads_;
  const double max_time_share_;
  const int num_coefficients_;  ///< of the correction that are free
  CorrectionBelief::Matrix prior_information_ = CorrectionBelief::Matrix::Zero();
  ReducedSolver solver_;
  std::vector<Piece> pieces_;
  std::vector<Eigen::Matrix3d> rotations_;                    ///< [poses]
  ReducedSystem held_;                                        ///< equations with the points held
  ReducedSystem reduced_;                                     ///< with the points eliminated
  std::vector<Eigen::Matrix<double, 6, 3>> sighting_blocks_;  ///< poses by points
  std::vector<Eigen::Matrix3d> point_blocks_;                 ///< points by points
  std::vector<BorderMatrix<3>> point_borders_;   ///< points by correction, where it is free
  std::vector<Eigen::Vector3d> point_rights_;    ///< of b
  std::vector<Eigen::Matrix3d> point_inverses_;  ///< of the damped point blocks
};

}  // namespace arfm_vo
