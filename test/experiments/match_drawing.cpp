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
  const cv::Size a = pair.first.size(), b = pair.second.size();
  const cv::Point shift = pair.is_stereo ? cv::Point(0, a.height) : cv::Point(a.width, 0);
  cv::Mat picture(std::max(a.height, b.height + shift.y), std::max(a.width, b.width + shift.x),
                  CV_8UC1, cv::Scalar(0));
  pair.first.copyTo(picture(cv::Rect(cv::Point(), a)));
  pair.second.copyTo(picture(cv::Rect(shift, b)));
  cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  for (const bool correct : {true, false}) {
    for (const Match& match : matches) {
      const cv::Point2f from = Position(first.keypoints[match.first]);
      const cv::Point2f to = Position(second.keypoints[match.second]);
      if (pair.is_correct(from, to) != correct) continue;
      cv::line(picture, from, to + cv::Point2f(shift), correct ? green : red, 1, cv::LINE_AA);
    }
  }
  return picture;
}

cv::Mat DrawDepths(const cv::Mat& grey, const StereoPoints& points) {
  constexpr double kPartLeftOut = 0.02;  // at both ends of the colours
  cv::Mat depths(1, static_cast<int>(points.size()), CV_8UC1), colours, picture;
  cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
  if (points.empty()) return picture;
  std::vector<double> sorted;
  for (const StereoPoint& point : points) sorted.push_back(std::log(point.x_in_camera.z()));
  std::sort(sorted.begin(), sorted.end());
  const auto left_out = static_cast<size_t>(kPartLeftOut * static_cast<double>(sorted.size()));
  const double near = sorted[left_out], far = sorted[sorted.size() - 1 - left_out];
  for (size_t i = 0; i < points.size(); ++i) {
    const double share = (std::log(points[i].x_in_camera.z()) - near) / std::max(far - near, 1e-9);
    depths.at<uchar>(static_cast<int>(i)) = cv::saturate_cast<uchar>(255 * (1 - share));
  }
  cv::applyColorMap(depths, colours, cv::COLORMAP_JET);
  for (size_t i = 0; i < points.size(); ++i) {
    const auto& observation = points[i].observation;
    cv::circle(picture, cv::Point2d(observation.x(), observation.y()), grey.cols / 350,
               colours.at<cv::Vec3b>(static_cast<int>(i)), cv::FILLED, cv::LINE_AA);
  }
  return picture;
}

}  // namespace arfm_vo
