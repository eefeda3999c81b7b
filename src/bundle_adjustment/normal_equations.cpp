#include "normal_equations.h"

#include <Eigen/LU>
#include <algorithm>
#include <thread>

#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"

namespace arfm_vo {
namespace {

/// Below this many tracks the pieces are not worth their sums.
constexpr int kMinTracksToSplit = 4000;
constexpr int kNumPieces = 4;

/// [x]x m
Eigen::Matrix3d CrossColumns(const Eigen::Vector3d& x, const Eigen::Matrix3d& m) {
  Eigen::Matrix3d product;
  product.row(0) = x.y() * m.row(2) - x.z() * m.row(1);
  product.row(1) = x.z() * m.row(0) - x.x() * m.row(2);
  product.row(2) = x.x() * m.row(1) - x.y() * m.row(0);
  return product;
}

double DampedDiagonal(double value, double damping) {
  return value + damping * std::clamp(value, 1e-6, 1e32);
}

}  // namespace

NormalEquations::NormalEquations(const BundleProblem& problem, const BundleSelection& selection,
                                 const BundleStructure& structure, const BundleOptions& options)
    : problem_(problem),
      selection_(selection),
      structure_(structure),
      losses_{RobustLoss(options.loss, options.loss_threshold_sigma, 2),
              RobustLoss(options.loss, options.loss_threshold_sigma, 4)},
      num_threads_(options.num_threads),
      num_coefficients_(selection.num_free_coefficients()),
      solver_(structure, num_coefficients_),
      sighting_blocks_(structure.sightings.size()),
      point_blocks_(structure.tracks.size()),
      point_borders_(structure.tracks.size()),
      point_rights_(structure.tracks.size()),
      point_inverses_(structure.tracks.size()) {
  const int64_t num_tracks = static_cast<int64_t>(structure.tracks.size());
  pieces_.resize(num_tracks < kMinTracksToSplit ? 1 : kNumPieces);
  const int64_t count = static_cast<int64_t>(pieces_.size());
  for (int64_t i = 0; i < count; ++i) {
    pieces_[i].first_track = static_cast<int>(i * num_tracks / count);
    pieces_[i].last_track = static_cast<int>((i + 1) * num_tracks / count);
  }
}

template <class Work>
void NormalEquations::ForEachPiece(Work&& work) {
  const int num_pieces = static_cast<int>(pieces_.size());
  const int num_threads = std::min(num_threads_, num_pieces);
  const auto run = [&](int thread) {
    for (int i = thread; i < num_pieces; i += num_threads) work(pieces_[i]);
  };
  std::vector<std::thread> others;
  for (int thread = 1; thread < num_threads; ++thread) others.emplace_back(run, thread);
  run(0);
  for (std::thread& other : others) other.join();
}

double NormalEquations::Linearize(const BundleState& state) {
  rotations_.clear();
  for (const Rigid3& pose : state.camera_from_world) rotations_.push_back(pose.RotationMatrix());
  ForEachPiece([&](Piece& piece) { LinearizePiece(state, piece); });
  held_.SetZero(structure_, num_coefficients_);
  double cost = 0;
  for (const Piece& piece : pieces_) {
    held_ += piece.sum;
    cost += piece.cost;
  }
  return cost + AddConstraints(state) + AddPrior(state);
}

void NormalEquations::LinearizePiece(const BundleState& state, Piece& piece) {
  const ReprojectionModel model(problem_.camera, state.correction, num_coefficients_ > 0);
  piece.sum.SetZero(structure_, num_coefficients_);
  piece.cost = 0;
  for (int track = piece.first_track; track < piece.last_track; ++track) {
    point_blocks_[track].setZero();
    point_borders_[track].setZero(3, num_coefficients_);
    point_rights_[track].setZero();
    for (int i = structure_.tracks[track].first; i < structure_.tracks[track].last; ++i) {
      LinearizeSighting(model, state, track, i, piece);
    }
  }
}

void NormalEquations::LinearizeSighting(const ReprojectionModel& model, const BundleState& state,
                                        int track, int index, Piece& piece) {
  const BundleStructure::Sighting& sighting = structure_.sightings[index];
  const Eigen::Matrix3d& rotation = rotations_[sighting.pose];
  const int free_pose = sighting.free_pose;
  sighting_blocks_[index].setZero();
  for (int i = sighting.first; i < sighting.last; ++i) {
    const BundleObservation& observation = structure_.observations[i];
    ReprojectionTerm term;
    model.Linearize(observation, rotation, state.camera_from_world[sighting.pose].translation,
                    state.points[observation.point], term);
    const RobustLoss& loss = losses_[observation.has_right];
    const double s = term.residual.squaredNorm();
    piece.cost += loss.Rho(s);
    const double weight = loss.Weight(s);

    // With A the derivative by x, J_point = A R and J_pose = A (-[x]x, I).
    const Eigen::Matrix<double, 4, 3> weighted = weight * term.by_x;
    const Eigen::Matrix3d m = weighted.transpose() * term.by_x;
    const Eigen::Vector3d pull = -(weighted.transpose() * term.residual);
    const Eigen::Matrix3d m_r = m * rotation;
    point_blocks_[track].noalias() += rotation.transpose() * m_r;
    point_rights_[track].noalias() += rotation.transpose() * pull;
    if (free_pose != BundleStructure::kFixed) {
      const Eigen::Matrix3d x_m = CrossColumns(term.x, m);
      Matrix6d& block = piece.sum.blocks[structure_.row_begin[free_pose]];
      block.topLeftCorner<3, 3>() += CrossColumns(term.x, x_m.transpose());
      block.topRightCorner<3, 3>() += x_m;
      block.bottomRightCorner<3, 3>() += m;
      piece.sum.right[free_pose].head<3>() += term.x.cross(pull);
      piece.sum.right[free_pose].tail<3>() += pull;
      sighting_blocks_[index].topRows<3>() += CrossColumns(term.x, m_r);
      sighting_blocks_[index].bottomRows<3>() += m_r;
    }
    if (num_coefficients_ == 0 || !observation.has_right) continue;
    constexpr int kNumTerms = ImageBasis::kNumTerms;
    const auto& basis = term.right_by_coefficients;
    const Eigen::Matrix<double, kNumTerms, kNumTerms> corner = weight * basis * basis.transpose();
    for (const int k : {0, 1}) {  // the coefficients of u, which move u alone, and those of v
      const Eigen::Vector3d by_x = weighted.row(2 + k);
      point_borders_[track].middleCols<kNumTerms>(k * kNumTerms).noalias() +=
          (rotation.transpose() * by_x) * basis.transpose();
      piece.sum.corner.block<kNumTerms, kNumTerms>(k * kNumTerms, k * kNumTerms) += corner;
      piece.sum.corner_right.segment<kNumTerms>(k * kNumTerms) -=
          weight * term.residual[2 + k] * basis;
      if (free_pose == BundleStructure::kFixed) continue;
      Vector6d by_pose;
      by_pose << term.x.cross(by_x), by_x;
      piece.sum.border[free_pose].middleCols<kNumTerms>(k * kNumTerms).noalias() +=
          by_pose * basis.transpose();
    }
  }
}

double NormalEquations::AddConstraints(const BundleState& state) {
  double cost = 0;
  for (const PoseConstraint& constraint : problem_.constraints) {
    const ConstraintTerm term =
        LinearizeConstraint(constraint, state.camera_from_world[constraint.first],
                            state.camera_from_world[constraint.second]);
    const Matrix6d& information = constraint.information;
    cost += term.residual.dot(information * term.residual);
    const int ends[2] = {structure_.free_pose[constraint.first],
                         structure_.free_pose[constraint.second]};
    const Matrix6d* const jacobians[2] = {&term.by_first, &term.by_second};
    for (const int i : {0, 1}) {
      if (ends[i] == BundleStructure::kFixed) continue;
      held_.right[ends[i]] -= jacobians[i]->transpose() * information * term.residual;
      for (const int j : {0, 1}) {
        if (ends[j] < ends[i]) continue;  // the upper triangle; also a fixed pose
        held_.blocks[structure_.FindBlock(ends[i], ends[j])] +=
            jacobians[i]->transpose() * information * *jacobians[j];
      }
    }
  }
  return cost;
}

double NormalEquations::AddPrior(const BundleState& state) {
  if (num_coefficients_ == 0) return 0;
  const double information = 1 / (problem_.correction_sigma_px * problem_.correction_sigma_px);
  held_.corner.diagonal().array() += information;
  held_.corner_right -= information * state.correction.coefficients_px;
  const auto& [mean, earlier] = problem_.correction_prior;
  const StereoCorrection::Coefficients off = state.correction.coefficients_px - mean;
  held_.corner += earlier;
  held_.corner_right -= earlier * off;
  return information * state.correction.coefficients_px.squaredNorm() + off.dot(earlier * off);
}

bool NormalEquations::Solve(double damping, BundleStep& step) {
  ForEachPiece([&](Piece& piece) { EliminatePiece(damping, piece); });
  reduced_ = held_;
  Damp(damping);
  for (const Piece& piece : pieces_) reduced_ -= piece.sum;
  if (!solver_.Factorize(reduced_)) return false;
  step.reduced = solver_.SolveFor(reduced_);
  if (!step.reduced.allFinite()) return false;
  FindPointSteps(step);
  MeasureStep(damping, step);
  return true;
}

void NormalEquations::Damp(double damping) {
  for (int i = 0; i < structure_.num_free_poses(); ++i) {
    for (double& value : reduced_.blocks[structure_.row_begin[i]].diagonal()) {
      value = DampedDiagonal(value, damping);
    }
  }
  for (double& value : reduced_.corner.diagonal()) value = DampedDiagonal(value, damping);
}

void NormalEquations::EliminatePiece(double damping, Piece& piece) {
  piece.sum.SetZero(structure_, num_coefficients_);
  const bool with_correction = num_coefficients_ > 0;
  for (int track = piece.first_track; track < piece.last_track; ++track) {
    Eigen::Matrix3d damped = point_blocks_[track];
    for (double& value : damped.diagonal()) value = DampedDiagonal(value, damping);
    const Eigen::Matrix3d inverse = damped.inverse();
    point_inverses_[track] = inverse;
    const Eigen::Vector3d inverse_right = inverse * point_rights_[track];
    const int last = structure_.tracks[track].last;
    for (int i = structure_.tracks[track].first; i < last; ++i) {
      const int row = structure_.sightings[i].free_pose;
      if (row == BundleStructure::kFixed) continue;
      piece.sum.right[row].noalias() += sighting_blocks_[i] * inverse_right;
      const Eigen::Matrix<double, 6, 3> product = sighting_blocks_[i] * inverse;
      int block = structure_.row_begin[row];
      for (int j = i; j < last; ++j) {
        const int column = structure_.sightings[j].free_pose;
        if (column == BundleStructure::kFixed) continue;
        block = structure_.FindBlock(row, column, block);
        piece.sum.blocks[block].noalias() += product * sighting_blocks_[j].transpose();
      }
      if (with_correction) piece.sum.border[row].noalias() += product * point_borders_[track];
    }
    if (!with_correction) continue;
    const BorderMatrix<3> product = inverse * point_borders_[track];
    piece.sum.corner.noalias() += point_borders_[track].transpose() * product;
    piece.sum.corner_right.noalias() += point_borders_[track].transpose() * inverse_right;
  }
}

void NormalEquations::FindPointSteps(BundleStep& step) const {
  step.points.resize(structure_.tracks.size());
  const CornerVector correction = step.reduced.tail(num_coefficients_);
  for (size_t track = 0; track < structure_.tracks.size(); ++track) {
    Eigen::Vector3d right = point_rights_[track] - point_borders_[track] * correction;
    for (int i = structure_.tracks[track].first; i < structure_.tracks[track].last; ++i) {
      const int pose = structure_.sightings[i].free_pose;
      if (pose == BundleStructure::kFixed) continue;
      right.noalias() -= sighting_blocks_[i].transpose() * step.reduced.segment<6>(6 * pose);
    }
    step.points[track] = point_inverses_[track] * right;
  }
}

void NormalEquations::MeasureStep(double damping, BundleStep& step) const {
  // The model promises d^T b + d^T (damping D) d.
  double decrease = 0;
  const auto add = [&](const auto& d, const auto& right, const auto& diagonal) {
    decrease += d.dot(right);
    for (Eigen::Index i = 0; i < d.size(); ++i) {
      decrease += d[i] * d[i] * (DampedDiagonal(diagonal[i], damping) - diagonal[i]);
    }
  };
  for (int i = 0; i < structure_.num_free_poses(); ++i) {
    add(step.reduced.segment<6>(6 * i), held_.right[i],
        held_.blocks[structure_.row_begin[i]].diagonal());
  }
  add(step.reduced.tail(num_coefficients_), held_.corner_right, held_.corner.diagonal());
  for (size_t track = 0; track < step.points.size(); ++track) {
    add(step.points[track], point_rights_[track], point_blocks_[track].diagonal());
  }
  step.expected_decrease = decrease;
}

void NormalEquations::Apply(const BundleStep& step, BundleState& state) const {
  // To first order this is BoxPlus and addition. A stretch of the path that turns as a whole must
  // keep its shape, though, or long paths converge slowly: poses move by the exponential of SE(3),
  // and a point moves with the first pose that sees it.
  const std::vector<Rigid3> old = state.camera_from_world;
  for (int i = 0; i < structure_.num_free_poses(); ++i) {
    Rigid3& pose = state.camera_from_world[structure_.pose_of_free[i]];
    const Eigen::Vector3d turn = step.reduced.segment<3>(6 * i);
    const Eigen::Vector3d shift = step.reduced.segment<3>(6 * i + 3);
    pose = Rigid3(ExpSO3(turn), Eigen::Vector3d(LeftJacobianSO3(turn) * shift)) * pose;
  }
  for (size_t track = 0; track < step.points.size(); ++track) {
    const BundleStructure::Sighting& host = structure_.sightings[structure_.tracks[track].first];
    Eigen::Vector3d& point = state.points[structure_.tracks[track].point];
    if (host.free_pose == BundleStructure::kFixed) {
      point += step.points[track];
      continue;
    }
    const auto host_step = step.reduced.segment<6>(6 * host.free_pose);
    const Eigen::Vector3d x = old[host.pose] * point;
    const Eigen::Vector3d moved_x = x + host_step.head<3>().cross(x) + host_step.tail<3>() +
                                    old[host.pose].rotation * step.points[track];
    point = state.camera_from_world[host.pose].Inverse() * moved_x;
  }
  if (num_coefficients_ > 0) {
    state.correction.coefficients_px += step.reduced.tail<kMaxCoefficients>();
  }
}

Eigen::MatrixXd NormalEquations::InverseColumns(int first, int count) const {
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(reduced_size(), count);
  right.middleRows(first, count).setIdentity();
  return solver_.Solve(right);
}

}  // namespace arfm_vo
