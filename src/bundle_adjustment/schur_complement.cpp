#include <Eigen/LU>
#include <algorithm>

#include "arfm_vo/base/pacer.h"
#include "arfm_vo/geometry/screw_motion.h"
#include "normal_equations.h"

namespace arfm_vo {
namespace {

double DampedDiagonal(double value, double damping) {
  return value + damping * std::clamp(value, 1e-6, 1e32);
}

template <class Block>
void DampDiagonal(double damping, Block& block) {
  for (int i = 0; i < block.rows(); ++i) block(i, i) = DampedDiagonal(block(i, i), damping);
}

}  // namespace

const ReducedSystem& NormalEquations::EliminatePoints(double damping) {
  reduced_ = held_;
  Damp(damping);
  Pacer pacer(max_time_share_);
  for (int track = 0; track < static_cast<int>(structure_.tracks.size()); ++track) {
    pacer.Pause();
    EliminatePoint(track, damping);
  }
  if (problem_.correction_prior) {
    reduced_.corner.triangularView<Eigen::Lower>() -= solved_borders_ * point_borders_.transpose();
    reduced_.corner_right.noalias() -= solved_borders_ * point_rights_.reshaped();
  }
  return reduced_;
}

bool NormalEquations::Solve(double damping, BundleStep& step) {
  EliminatePoints(damping);
  Pacer pacer(max_time_share_);
  if (!solver_.Factorize(reduced_)) return false;
  pacer.Pause();
  step.reduced = solver_.SolveFor(reduced_);
  if (!step.reduced.allFinite()) return false;
  FindPointSteps(damping, step);
  MeasureStep(damping, step);
  pacer.Pause();
  return true;
}

void NormalEquations::Damp(double damping) {
  for (int i = 0; i < structure_.num_free_poses(); ++i) {
    DampDiagonal(damping, reduced_.blocks[structure_.blocks.row_begin[i]]);
  }
  DampDiagonal(damping, reduced_.corner);
}

Eigen::Matrix3d NormalEquations::DampedInverse(int track, double damping) const {
  Eigen::Matrix3d damped = point_blocks_[track];
  DampDiagonal(damping, damped);
  return damped.inverse();
}

void NormalEquations::EliminatePoint(int track, double damping) {
  const bool with_correction = num_coefficients_ > 0;
  const auto& [point, first, last] = structure_.tracks[track];
  const Eigen::Matrix3d inverse = DampedInverse(track, damping);
  const Eigen::Vector3d inverse_right = inverse * point_rights_.col(track);
  const auto border = point_borders_.middleCols<3>(3 * track);
  solved_borders_.middleCols<3>(3 * track) = border.lazyProduct(inverse);
  track_blocks_.resize(std::max<size_t>(track_blocks_.size(), last - first));
  for (int i = first; i < last; ++i) {
    if (structure_.FreePose(i) == BundleStructure::kFixed) continue;
    const Eigen::Matrix3d m_r =
        ties_[i].M().lazyProduct(rotations_[structure_.observations[i].pose]);
    track_blocks_[i - first] << CrossColumns(ties_[i].x, m_r), m_r;
  }
  for (int i = first; i < last; ++i) {
    const int row = structure_.FreePose(i);
    if (row == BundleStructure::kFixed) continue;
    reduced_.right[row].noalias() -= track_blocks_[i - first] * inverse_right;
    const PoseByPoint product = track_blocks_[i - first] * inverse;
    int block = structure_.blocks.row_begin[row];
    for (int j = i; j < last; ++j) {
      const int column = structure_.FreePose(j);
      if (column == BundleStructure::kFixed) continue;
      block = structure_.blocks.Find(row, column, block);
      reduced_.blocks[block].noalias() -= product * track_blocks_[j - first].transpose();
    }
    if (with_correction) reduced_.border[row] -= product.lazyProduct(border.transpose());
  }
}

void NormalEquations::FindPointSteps(double damping, BundleStep& step) const {
  step.points.resize(structure_.tracks.size());
  const CornerVector correction = step.reduced.tail(num_coefficients_);
  for (int track = 0; track < static_cast<int>(structure_.tracks.size()); ++track) {
    Eigen::Vector3d right = point_rights_.col(track);
    right.noalias() -= point_borders_.middleCols<3>(3 * track).transpose() * correction;
    for (int i = structure_.tracks[track].first; i < structure_.tracks[track].last; ++i) {
      const int free_pose = structure_.FreePose(i);
      if (free_pose == BundleStructure::kFixed) continue;
      const Eigen::Vector3d turn = step.reduced.segment<3>(6 * free_pose);
      const Eigen::Vector3d shift = step.reduced.segment<3>(6 * free_pose + 3);
      const Eigen::Matrix3d& rotation = rotations_[structure_.observations[i].pose];
      right.noalias() -= rotation.transpose() * (ties_[i].M() * (shift + turn.cross(ties_[i].x)));
    }
    step.points[track] = DampedInverse(track, damping) * right;
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
        held_.blocks[structure_.blocks.row_begin[i]].diagonal());
  }
  add(step.reduced.tail(num_coefficients_), held_.corner_right, held_.corner.diagonal());
  for (size_t track = 0; track < step.points.size(); ++track) {
    add(step.points[track], point_rights_.col(track), point_blocks_[track].diagonal());
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
    const int host = structure_.observations[structure_.tracks[track].first].pose;
    const int free_host = structure_.free_pose[host];
    Eigen::Vector3d& point = state.points[structure_.tracks[track].point];
    if (free_host == BundleStructure::kFixed) {
      point += step.points[track];
      continue;
    }
    const auto host_step = step.reduced.segment<6>(6 * free_host);
    const Eigen::Vector3d x = old[host] * point;
    const Eigen::Vector3d moved_x = x + host_step.head<3>().cross(x) + host_step.tail<3>() +
                                    old[host].rotation * step.points[track];
    point = state.camera_from_world[host].Inverse() * moved_x;
  }
  state.correction.coefficients_px +=
      selection_.correction_directions * step.reduced.tail(num_coefficients_);
}

Eigen::MatrixXd NormalEquations::InverseColumns(int first, int count) const {
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(reduced_size(), count);
  right.middleRows(first, count).setIdentity();
  return solver_.Solve(right);
}

}  // namespace arfm_vo
