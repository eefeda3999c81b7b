#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <optional>

namespace arfm_vo {

/// Finds points of the left image along their rows in the right one by correlation of 24 x 24 px
/// (12 x 12 at half size), for keypoints that the detector did not find again there.
class RowSearch {
 public:
  /// Takes a rectified pair (CV_8UC1, same size).
  void SetImages(const cv::Mat& left, const cv::Mat& right);
  /// The place in the right image, to about a pixel, of a left pixel whose row is off by
  /// `row_offset_px` there; disparities from `min` to `max` are tried. Nothing where it is outside,
  /// not alike enough or not unique.
  std::optional<cv::Point2f> Find(const cv::Point2f& left_pixel, double row_offset_px,
                                  double min_disparity_px, double max_disparity_px) const;

 private:
  cv::Mat left_, right_;  ///< half size
};

}  // namespace arfm_vo
