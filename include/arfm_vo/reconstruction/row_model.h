#pragma once

#include <Eigen/Core>
#include <vector>

#include "arfm_vo/geometry/correction_belief.h"

namespace arfm_vo {

/// A stereo match's place in the right image and how far its row is off there.
struct RowSample {
  double u_right = 0, v_right = 0;  ///< px
  double residual_px = 0;           ///< v_right - v_left
  double sigma_px = 1;
};

/// The rows of a StereoCorrection, learnt robustly from the matches of the pairs so far, on top of
/// what is known of it; older pairs count less and less. The columns do not show in one pair.
class RowModel {
 public:
  /// `prior`: what is known of the correction before.
  RowModel(const StereoCamera& camera, const CorrectionBelief& prior);

  /// Adds the samples of a pair; wrong ones among them lose their influence.
  void Update(const std::vector<RowSample>& samples);
  /// What is known of the rows where the right camera may have been knocked since.
  RowModel AfterAKnock() const;
  /// Expected v_right - v_left at a right pixel, px.
  double Predict(double u_right, double v_right) const;
  /// Robust standard deviation of the newest samples from the model, px; 0 before the first.
  double spread_px() const { return spread_px_; }
  /// How far the newest pair's rows are off the model as a whole, px (median): a bump between the
  /// exposures of the cameras, which the model does not follow at once. Zero below 0.3 px.
  double shift_px() const { return shift_px_; }
  /// Whether a calibration can err as the model has it: but for one in 10,000 all can. Pictures of
  /// two moments in a motion displace the rows as no calibration does.
  bool IsPlausible() const;
  /// True once enough samples have been seen for the model to be trusted.
  bool IsLearnt() const { return num_samples_ >= kMinSamples; }

 private:
  static constexpr int kNumTerms = ImageBasis::kNumTerms;
  static constexpr double kMinSamples = 30;
  using Terms = Eigen::Matrix<double, kNumTerms, 1>;
  using Information = Eigen::Matrix<double, kNumTerms, kNumTerms>;

  std::vector<double> Deviations(const std::vector<RowSample>& samples,
                                 const std::vector<Terms>& terms) const;
  void MeasureSpread(std::vector<double> deviations);

  StereoCamera camera_;
  Information prior_information_;  ///< of the rows' coefficients
  Terms prior_mean_;
  Information information_;  ///< of the older pairs and the prior
  Terms weighted_sum_;
  Terms coefficients_;
  double spread_px_ = 0;
  double shift_px_ = 0;
  double num_samples_ = 0;
};

}  // namespace arfm_vo
