#include "arfm_vo/odometry/drift_estimator.h"

#include <algorithm>
#include <string>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

using Eigen::MatrixXd;

/// The 6 x 6 blocks of `matrix` whose rows and columns are named.
MatrixXd TakeBlocks(const MatrixXd& matrix, const std::vector<int>& rows,
                    const std::vector<int>& columns) {
  MatrixXd taken(6 * rows.size(), 6 * columns.size());
  for (size_t i = 0; i < rows.size(); ++i) {
    for (size_t j = 0; j < columns.size(); ++j) {
      taken.block<6, 6>(6 * i, 6 * j) = matrix.block<6, 6>(6 * rows[i], 6 * columns[j]);
    }
  }
  return taken;
}

void PutBlocks(const MatrixXd& blocks, const std::vector<int>& rows,
               const std::vector<int>& columns, MatrixXd& matrix) {
  for (size_t i = 0; i < rows.size(); ++i) {
    for (size_t j = 0; j < columns.size(); ++j) {
      matrix.block<6, 6>(6 * rows[i], 6 * columns[j]) = blocks.block<6, 6>(6 * i, 6 * j);
    }
  }
}

}  // namespace

void DriftEstimator::Add(KeyframeId keyframe, const PoseDrift& drift) {
  Require(keyframes_.empty() || keyframe > keyframes_.back(),
          "drift: keyframe " + std::to_string(keyframe) + " is not newer than the last");
  keyframes_.push_back(keyframe);
  const Eigen::Index size = covariance_.rows();
  MatrixXd larger = MatrixXd::Zero(size + 6, size + 6);
  larger.topLeftCorner(size, size) = covariance_;
  larger.bottomRightCorner<6, 6>() = drift.covariance;
  covariance_ = std::move(larger);
  by_correction_.conservativeResize(size + 6, StereoCorrection::kNumPlacing);
  by_correction_.bottomRows<6>() = drift.by_correction;
}

PoseDrift DriftEstimator::Beside(KeyframeId keyframe, const Rigid3& pose_from_keyframe,
                                 const PoseDrift& own) const {
  const Matrix6 carried = CarryStep(pose_from_keyframe);
  const PoseDrift drift = Drift(keyframe);
  return {own.covariance + Propagate(carried, drift.covariance),
          own.by_correction + carried * drift.by_correction};
}

void DriftEstimator::SetCorrection(const CorrectionBelief& correction, KeyframeId anchor,
                                   const std::map<KeyframeId, Rigid3>& moved) {
  const MatrixXd unknown = correction.PlacingCovariance();
  // In directions of their own, X with X^T unknown_ X = 1 and X^T unknown X = d, what is learnt,
  // d < 1, is independent of what stays unknown; what has opened, d > 1, is of a camera that has
  // changed.
  MatrixXd kept = 0 * unknown;  // takes what is unknown now to what was unknown of the same
  if (IsPositiveDefinite(unknown_)) {
    const SymmetricEigen ratios(unknown, unknown_);
    const MatrixXd shares = ratios.values.cwiseMax(1).cwiseInverse().asDiagonal();
    kept = unknown_ * Propagate(ratios.vectors, shares);
  }
  MatrixXd staying = by_correction_;
  const auto of_anchor = Drift(anchor).by_correction;
  for (const auto& [keyframe, from_anchor] : moved) {
    const int i = Find(keyframe);
    if (i >= 0) staying.middleRows<6>(6 * i) = CarryStep(from_anchor) * of_anchor;
  }
  covariance_ += Propagate(staying, unknown_ - Propagate(kept, unknown));
  by_correction_ *= kept;
  unknown_ = unknown;
}

void DriftEstimator::Forget(KeyframeId oldest) {
  const auto first = std::lower_bound(keyframes_.begin(), keyframes_.end(), oldest);
  const Eigen::Index gone = 6 * (first - keyframes_.begin());
  if (gone == 0) return;
  keyframes_.erase(keyframes_.begin(), first);
  const Eigen::Index size = covariance_.rows() - gone;
  covariance_ = covariance_.bottomRightCorner(size, size).eval();
  by_correction_ = by_correction_.bottomRows(size).eval();
}

void DriftEstimator::Clear() {
  keyframes_.clear();
  covariance_.resize(0, 0);
  by_correction_.resize(0, StereoCorrection::kNumPlacing);
}

int DriftEstimator::Find(KeyframeId keyframe) const {
  const auto found = std::lower_bound(keyframes_.begin(), keyframes_.end(), keyframe);
  if (found == keyframes_.end() || *found != keyframe) return -1;
  return static_cast<int>(found - keyframes_.begin());
}

void DriftEstimator::Update(const std::vector<KeyframeId>& keyframes,
                            const std::vector<char>& is_held, const PoseInformation& information) {
  // Rows of the information, and the same keyframes as rows of the covariance.
  std::vector<int> free, held, free_known, held_known;
  for (size_t i = 0; i < keyframes.size(); ++i) {
    const int known = Find(keyframes[i]);
    Require(known >= 0, "drift: keyframe " + std::to_string(keyframes[i]) + " is not known");
    (is_held[i] ? held : free).push_back(static_cast<int>(i));
    (is_held[i] ? held_known : free_known).push_back(known);
  }
  if (free.empty()) return;
  const Eigen::Index size = 6 * free.size();
  const auto inverse =
      SolveDefinite(TakeBlocks(information.poses, free, free), MatrixXd::Identity(size, size));
  if (!inverse) return;

  // The errors e_free = step e_held + s, with s independent of e_held and of `own` covariance.
  const MatrixXd& own = *inverse;
  const MatrixXd step = -own * TakeBlocks(information.poses, free, held);
  std::vector<int> others;
  for (int i = 0; i < static_cast<int>(keyframes_.size()); ++i) {
    if (std::count(free_known.begin(), free_known.end(), i) == 0) others.push_back(i);
  }
  const MatrixXd free_by_others = step * TakeBlocks(covariance_, held_known, others);
  const MatrixXd free_by_free =
      own + Propagate(step, TakeBlocks(covariance_, held_known, held_known));
  MatrixXd pulled(6 * free.size(), StereoCorrection::kNumPlacing);
  for (size_t i = 0; i < free.size(); ++i) {
    pulled.middleRows<6>(6 * i) = information.by_correction.middleRows<6>(6 * free[i]);
  }
  MatrixXd held_by_correction(6 * held.size(), StereoCorrection::kNumPlacing);
  for (size_t i = 0; i < held.size(); ++i) {
    held_by_correction.middleRows<6>(6 * i) = by_correction_.middleRows<6>(6 * held_known[i]);
  }
  const MatrixXd free_by_correction = step * held_by_correction - own * pulled;
  for (size_t i = 0; i < free.size(); ++i) {
    by_correction_.middleRows<6>(6 * free_known[i]) = free_by_correction.middleRows<6>(6 * i);
  }
  PutBlocks(free_by_others, free_known, others, covariance_);
  PutBlocks(free_by_others.transpose(), others, free_known, covariance_);
  PutBlocks((free_by_free + free_by_free.transpose()) / 2, free_known, free_known, covariance_);
}

PoseDrift DriftEstimator::Drift(KeyframeId keyframe) const {
  const int i = Find(keyframe);
  if (i < 0) return {};
  return {covariance_.block<6, 6>(6 * i, 6 * i), by_correction_.middleRows<6>(6 * i)};
}

}  // namespace arfm_vo
