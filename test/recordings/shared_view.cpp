#include "recordings/shared_view.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace arfm_vo {
namespace {

constexpr int kGrid = 8;               ///< px between the pixels that are looked at
constexpr int kCornerCell = 6;         ///< px
constexpr double kMinContrast = 10;    ///< grey levels of a corner, after a slight blur
constexpr double kMinOverNoise = 2.5;  ///< contrast over the noise's standard deviation
constexpr double kFar = 1e4;           ///< m, for the sky
constexpr double kHiddenBehind = 1.3;  ///< times as far as what was seen there: hidden

double MedianDepth(const cv::Mat& depth_m) {
  std::vector<float> known;
  for (int v = 0; v < depth_m.rows; v += kGrid) {
    for (int u = 0; u < depth_m.cols; u += kGrid) {
      const float depth = depth_m.at<float>(v, u);
      if (depth > 0) known.push_back(std::min(depth, static_cast<float>(kFar)));
    }
  }
  if (known.empty()) return 10;
  std::nth_element(known.begin(), known.begin() + known.size() / 2, known.end());
  return known[known.size() / 2];
}

/// The pixels of `now` that `before` has seen, at every kGrid-th: non-zero.
cv::Mat FindShared(const StereoCamera& camera, const TruePair& before, const TruePair& now,
                   const Rigid3& before_from_now, const cv::Mat& hidden) {
  const int rows = (camera.height + kGrid - 1) / kGrid,
            columns = (camera.width + kGrid - 1) / kGrid;
  const double median = MedianDepth(now.depth_m);
  cv::Mat shared = cv::Mat::zeros(rows, columns, CV_8U);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int u = column * kGrid, v = row * kGrid;
      if (!hidden.empty() && hidden.at<uchar>(v, u) != 0) continue;
      const double known = now.depth_m.at<float>(v, u);
      const double z = std::min(kFar, known > 0 ? known : median);
      const Eigen::Vector3d here(z * (u - camera.cx) / camera.fx, z * (v - camera.cy) / camera.fy,
                                 z);
      const Eigen::Vector3d there = before_from_now * here;
      if (there.z() < 0.5 * z || there.z() > 2 * z) continue;
      const Eigen::Vector2d pixel = camera.Project(there);
      if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() > camera.width - 1 ||
          pixel.y() > camera.height - 1) {
        continue;
      }
      const double seen = before.depth_m.at<float>(static_cast<int>(std::lround(pixel.y())),
                                                   static_cast<int>(std::lround(pixel.x())));
      if (known > 0 && seen > 0 && there.z() > kHiddenBehind * seen) continue;
      shared.at<uchar>(row, column) = 1;
    }
  }
  return shared;
}

}  // namespace

SharedView CompareViews(const StereoCamera& camera, const TruePair& before, const TruePair& now,
                        const Rigid3& before_from_now, const ShownPicture& picture) {
  const cv::Mat shared = FindShared(camera, before, now, before_from_now, picture.hidden);
  SharedView view;
  view.share = cv::sum(shared)[0] / static_cast<double>(shared.total());
  cv::Mat smooth;
  cv::GaussianBlur(picture.image, smooth, {3, 3}, 0);
  std::vector<cv::KeyPoint> corners;
  const double contrast = std::max(kMinContrast, kMinOverNoise * picture.noise_grey_levels);
  cv::FAST(smooth, corners, static_cast<int>(std::lround(contrast)));
  cv::Mat taken =
      cv::Mat::zeros(camera.height / kCornerCell + 1, camera.width / kCornerCell + 1, CV_8U);
  for (const cv::KeyPoint& corner : corners) {
    const int u = static_cast<int>(corner.pt.x), v = static_cast<int>(corner.pt.y);
    if (shared.at<uchar>(v / kGrid, u / kGrid) == 0) continue;
    uchar& cell = taken.at<uchar>(v / kCornerCell, u / kCornerCell);
    view.num_corners += cell == 0;
    cell = 1;
  }
  return view;
}

}  // namespace arfm_vo
