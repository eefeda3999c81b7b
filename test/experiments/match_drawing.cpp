#include "experiments/match_drawing.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace arfm_vo {
namespace {

cv::Point2f Position(const Keypoint& keypoint) { return {keypoint.x, keypoint.y}; }

}  // namespace

cv::Mat DrawMatches(const JudgedPair& pair, const Features& first, const Features& second,
                    const Matches& matches) {
  const cv::Scalar green(0, 200, 0), red(0, 0, 255);
  cv::Mat picture(std::max(pair.first.rows, pair.second.rows), pair.first.cols + pair.second.cols,
                  CV_8UC1, cv::Scalar(0));
  pair.first.copyTo(picture(cv::Rect(cv::Point(), pair.first.size())));
  pair.second.copyTo(picture(cv::Rect(cv::Point(pair.first.cols, 0), pair.second.size())));
  cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  const cv::Point2f beside(static_cast<float>(pair.first.cols), 0);
  for (const bool correct : {true, false}) {
    for (const Match& match : matches) {
      const cv::Point2f from = Position(first.keypoints[match.first]);
      const cv::Point2f to = Position(second.keypoints[match.second]);
      if (pair.is_correct(from, to) != correct) continue;
      cv::line(picture, from, to + beside, correct ? green : red, 1, cv::LINE_AA);
    }
  }
  return picture;
}

cv::Mat DrawDepths(const cv::Mat& grey, const StereoPoints& points) {
  constexpr double kNearM = 3, kFarM = 60;
  cv::Mat depths(1, static_cast<int>(points.size()), CV_8UC1), colours, picture;
  for (size_t i = 0; i < points.size(); ++i) {
    const double share = std::log(points[i].x_in_camera.z() / kNearM) / std::log(kFarM / kNearM);
    depths.at<uchar>(static_cast<int>(i)) = cv::saturate_cast<uchar>(255 * (1 - share));
  }
  cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
  if (points.empty()) return picture;
  cv::applyColorMap(depths, colours, cv::COLORMAP_JET);
  for (size_t i = 0; i < points.size(); ++i) {
    const auto& observation = points[i].observation;
    cv::circle(picture, cv::Point2d(observation.x(), observation.y()), 3,
               colours.at<cv::Vec3b>(static_cast<int>(i)), cv::FILLED, cv::LINE_AA);
  }
  return picture;
}

}  // namespace arfm_vo
