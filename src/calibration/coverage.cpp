#include "arfm_vo/calibration/coverage.h"

#include <algorithm>
#include <opencv2/core.hpp>

namespace arfm_vo {

Coverage::Coverage(const std::vector<BoardCorners>& views, cv::Size image_size)
    : counts(8, 10, CV_32S, cv::Scalar(0)) {
  for (const BoardCorners& corners : views) {
    for (const cv::Point2f& corner : corners) {
      const int column = static_cast<int>((corner.x + 0.5F) * counts.cols / image_size.width);
      const int row = static_cast<int>((corner.y + 0.5F) * counts.rows / image_size.height);
      ++counts.at<int>(std::clamp(row, 0, counts.rows - 1), std::clamp(column, 0, counts.cols - 1));
    }
  }
  share = cv::countNonZero(counts) / static_cast<double>(counts.total());
}

}  // namespace arfm_vo
