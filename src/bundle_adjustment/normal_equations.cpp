#include "normal_equations.h"

#include "arfm_vo/base/pacer.h"
#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"
#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

/// The coefficients of the correction are the field's of u, the lens's, and the field's of v.
constexpr int kNumField = StereoCorrection::kNumField, kNumLens = StereoCorrection::kNumLens;
constexpr int kFirstOfV = StereoCorrection::kNumPlacing;

}  // namespace

NormalEquations::NormalEquations(const BundleProblem& problem, const BundleSelection& selection,
                                 const BundleStructure& structure, const BundleOptions& options)
    : problem_(problem),
      selection_(selection),
      structure_(structure),
      losses_{RobustLoss(options.loss, kBundleLossThreshold, 2),
              RobustLoss(options.loss, kBundleLossThreshold, 4)},
      max_time_share_(options.max_time_share),
      num_coefficients_(static_cast<int>(selection.correction_directions.cols())),
      solver_(structure.blocks, num_coefficients_),
      ties_(structure.observations.size()),
      point_blocks_(structure.tracks.size()),
      point_rights_(3, structure.tracks.size()),
      point_borders_(num_coefficients_, 3 * structure.tracks.size()),
      solved_borders_(num_coefficients_, 3 * structure.tracks.size()) {
  if (problem.correction_prior) prior_information_ = problem.correction_prior->Information();
}

double NormalEquations::Linearize(const BundleState& state) {
  rotations_.clear();
  for (const Rigid3& pose : state.camera_from_world) rotations_.push_back(pose.RotationMatrix());
  const ReprojectionModel model(problem_.camera, state.correction, num_coefficients_ > 0);
  held_.SetZero(structure_.blocks, num_coefficients_);
  point_rights_.setZero();
  point_borders_.setZero();
  field_block_.setZero();
  double cost = 0;
  Pacer pacer(max_time_share_);
  for (int track = 0; track < static_cast<int>(structure_.tracks.size()); ++track) {
    pacer.Pause();
    point_blocks_[track].setZero();
    for (int i = structure_.tracks[track].first; i < structure_.tracks[track].last; ++i) {
      cost += LinearizeObservation(model, state, track, i);
    }
  }
  if (problem_.correction_prior && !problem_.correction_turns) {
    for (const int first : {0, kFirstOfV})
      held_.corner.block<kNumField, kNumField>(first, first) += field_block_;
  }
  return cost + AddConstraints(state) + AddPrior(state);
}

double NormalEquations::LinearizeObservation(const ReprojectionModel& model,
                                             const BundleState& state, int track, int index) {
  const BundleObservation& observation = structure_.observations[index];
  const Eigen::Matrix3d& rotation = rotations_[observation.pose];
  const int free_pose = structure_.FreePose(index);
  ReprojectionTerm term;
  model.Linearize(observation, rotation, state.camera_from_world[observation.pose].translation,
                  state.points[observation.point], term);
  const RobustLoss& loss = losses_[observation.has_right];
  const double s = term.residual.squaredNorm();
  const double weight = loss.Weight(s);

  // With A the derivative by x, J_point = A R and J_pose = A (-[x]x, I).
  const Eigen::Matrix3d m = weight * (term.by_x.transpose().lazyProduct(term.by_x));
  const Eigen::Vector3d pull = -weight * term.by_x.transpose().lazyProduct(term.residual);
  const Eigen::Matrix3d m_r = m.lazyProduct(rotation);
  point_blocks_[track] += rotation.transpose().lazyProduct(m_r);
  point_rights_.col(track) += rotation.transpose().lazyProduct(pull);
  if (free_pose != BundleStructure::kFixed) {
    const Eigen::Matrix3d x_m = CrossColumns(term.x, m);
    Matrix6d& block = held_.blocks[structure_.blocks.row_begin[free_pose]];
    block.topLeftCorner<3, 3>() += CrossColumns(term.x, x_m.transpose());
    block.topRightCorner<3, 3>() += x_m;
    block.bottomRightCorner<3, 3>() += m;
    held_.right[free_pose].head<3>() += term.x.cross(pull);
    held_.right[free_pose].tail<3>() += pull;
    ties_[index].x = term.x;
    ties_[index].Set(m);
  }
  if (num_coefficients_ > 0) {
    if (problem_.correction_turns) {
      LinearizeByTurns(term, weight, rotation, track, free_pose);
    } else {
      LinearizeByCorrection(term, weight, rotation, track, free_pose);
    }
  }
  return loss.Rho(s);
}

void NormalEquations::LinearizeByTurns(const ReprojectionTerm& term, double weight,
                                       const Eigen::Matrix3d& rotation, int track, int free_pose) {
  const CorrectionBelief::Turns& turns = *problem_.correction_turns;
  Eigen::Matrix<double, 3, 2> by_turn;  // of (u_right, v_right), transposed
  by_turn.col(0).noalias() = turns.topRows<kNumField>().transpose() * term.right_by_field;
  by_turn.col(1).noalias() = turns.bottomRows<kNumField>().transpose() * term.right_by_field;
  const Eigen::Matrix<double, 3, 2> weighted = weight * by_turn;
  const Eigen::Matrix3d by_x = term.by_x.bottomRows<2>().transpose() * weighted.transpose();
  point_borders_.block<3, 3>(0, 3 * track).noalias() += by_x.transpose() * rotation;
  held_.corner.topLeftCorner<3, 3>().noalias() += weighted * by_turn.transpose();
  held_.corner_right.head<3>().noalias() -= weighted * term.residual.tail<2>();
  if (free_pose == BundleStructure::kFixed) return;
  held_.border[free_pose].block<3, 3>(0, 0) += CrossColumns(term.x, by_x);
  held_.border[free_pose].block<3, 3>(3, 0) += by_x;
}

void NormalEquations::LinearizeByCorrection(const ReprojectionTerm& term, double weight,
                                            const Eigen::Matrix3d& rotation, int track,
                                            int free_pose) {
  const auto& field = term.right_by_field;
  const Eigen::Matrix<double, 4, 3> weighted = weight * term.by_x;
  // The coefficients of u move row 2 alone, those of v row 3, those of the lens all four.
  for (const auto& [row, first] : {std::pair(2, 0), std::pair(3, kFirstOfV)}) {
    if (first >= num_coefficients_) break;
    const Eigen::Vector3d by_x = weighted.row(row);
    point_borders_.block<kNumField, 3>(first, 3 * track).noalias() +=
        field * (by_x.transpose() * rotation);
    if (free_pose == BundleStructure::kFixed) continue;
    Vector6d by_pose;
    by_pose << term.x.cross(by_x), by_x;
    held_.border[free_pose].middleCols<kNumField>(first).noalias() += by_pose * field.transpose();
  }
  const Eigen::Matrix<double, 3, kNumLens> by_x = weighted.transpose() * term.by_lens;
  point_borders_.block<kNumLens, 3>(kNumField, 3 * track).noalias() += by_x.transpose() * rotation;
  if (problem_.correction_prior) LinearizeCorner(term, weight);
  if (free_pose == BundleStructure::kFixed) return;
  held_.border[free_pose].block<3, kNumLens>(0, kNumField) += Skew(term.x) * by_x;
  held_.border[free_pose].block<3, kNumLens>(3, kNumField) += by_x;
}

void NormalEquations::LinearizeCorner(const ReprojectionTerm& term, double weight) {
  const Eigen::Matrix<double, kNumField, 1> field = weight * term.right_by_field;
  field_block_.noalias() += field * term.right_by_field.transpose();
  held_.corner.block<kNumLens, kNumField>(kNumField, 0).noalias() +=
      term.by_lens.row(2).transpose() * field.transpose();
  held_.corner.block<kNumField, kNumLens>(kFirstOfV, kNumField).noalias() +=
      field * term.by_lens.row(3);
  held_.corner_right.segment<kNumField>(0) -= term.residual[2] * field;
  held_.corner_right.segment<kNumField>(kFirstOfV) -= term.residual[3] * field;
  const Eigen::Matrix<double, kNumLens, 4> lens = weight * term.by_lens.transpose();
  held_.corner.block<kNumLens, kNumLens>(kNumField, kNumField).noalias() += lens * term.by_lens;
  held_.corner_right.segment<kNumLens>(kNumField).noalias() -= lens * term.residual;
}

double NormalEquations::AddConstraints(const BundleState& state) {
  double cost = 0;
  for (const PoseConstraint& constraint : problem_.constraints) {
    const ConstraintTerm term =
        LinearizeConstraint(constraint, state.camera_from_world[constraint.first],
                            state.camera_from_world[constraint.second]);
    const Matrix6d& information = constraint.information;
    cost += term.residual.dot(information * term.residual);
    held_.Add(term, information,
              {structure_.free_pose[constraint.first], structure_.free_pose[constraint.second]},
              structure_.blocks);
  }
  return cost;
}

double NormalEquations::AddPrior(const BundleState& state) {
  if (!problem_.correction_prior) return 0;
  const StereoCorrection::Coefficients off =
      state.correction.coefficients_px - problem_.correction_prior->mean.coefficients_px;
  const StereoCorrection::Coefficients pull = prior_information_ * off;
  const BundleSelection::Directions& directions = selection_.correction_directions;
  held_.corner += Propagate(directions.transpose(), prior_information_);
  held_.corner_right -= directions.transpose() * pull;
  return off.dot(pull);
}

}  // namespace arfm_vo
