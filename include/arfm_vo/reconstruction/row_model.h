#pragma once

#include <Eigen/Core>
#include <vector>

namespace arfm_vo {

/// A stereo match's place in the left image and how far its row is off in the right one.
struct RowSample {
  double u_left = 0, v_left = 0;  ///< px
  double residual_px = 0;         ///< v_right - v_left
  double sigma_px = 1;
};

/// What the rows of a rectified pair are off by, over the left image: a quadratic polynomial of
/// (u, v). Real rectifications leave some tenths of a pixel in the middle and a pixel or more in
/// the corners: an error of roll shows as u, of focal length as v, of yaw as u v, of pitch as v^2.
/// Learnt robustly from the matches of the pairs so far; older pairs count less and less.
class RowModel {
 public:
  RowModel(int width, int height);

  /// Adds the samples of a pair; wrong ones among them lose their influence.
  void Update(const std::vector<RowSample>& samples);
  /// Expected v_right - v_left at a left pixel, px.
  double Predict(double u_left, double v_left) const;
  /// Robust standard deviation of the newest samples from the model, px; 0 before the first.
  double spread_px() const { return spread_px_; }
  /// True once enough samples have been seen for the model to be trusted.
  bool IsLearnt() const { return num_samples_ >= kMinSamples; }

 private:
  static constexpr int kNumTerms = 6;
  static constexpr double kMinSamples = 30;
  using Terms = Eigen::Matrix<double, kNumTerms, 1>;
  using Information = Eigen::Matrix<double, kNumTerms, kNumTerms>;

  Terms TermsAt(double u_left, double v_left) const;
  void MeasureSpread(const std::vector<RowSample>& samples);

  double half_width_, half_height_;
  Information information_;  ///< of the older pairs and the prior
  Terms weighted_sum_;
  Terms coefficients_;
  double spread_px_ = 0;
  double num_samples_ = 0;
};

}  // namespace arfm_vo
