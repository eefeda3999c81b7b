#include "arfm_vo/evaluation/match_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/base/format.h"
#include "arfm_vo/base/median.h"

namespace arfm_vo {
namespace {

const cv::Scalar kGreen(60, 220, 60), kRed(60, 60, 255), kWhite(255, 255, 255);
constexpr int kTextHeight_px = 22;
constexpr int kSubpixelBits = 3;  // coordinates in eighths of a pixel

cv::Point ToSubpixels(double u, double v) {
  return {cvRound(u * (1 << kSubpixelBits)), cvRound(v * (1 << kSubpixelBits))};
}

void DrawRing(cv::Mat& picture, double u, double v, int radius_px, const cv::Scalar& color,
              int thickness) {
  cv::circle(picture, ToSubpixels(u, v), radius_px << kSubpixelBits, color, thickness, cv::LINE_AA,
             kSubpixelBits);
}

/// What both cameras see, (u, v) in px and the depth in units of focal length times baseline; of a
/// pair whose features were not computed the map's points.
std::vector<Eigen::Vector3d> PointsToDraw(const StereoFrame& frame, const OdometryUpdate& update) {
  std::vector<Eigen::Vector3d> points;
  const auto add = [&](double u, double v, double u_right) {
    if (u > u_right) points.emplace_back(u, v, 1 / (u - u_right));
  };
  for (const StereoPoint& point : frame.points)
    add(point.observation.x(), point.observation.y(), point.observation.z());
  if (!points.empty()) return points;
  for (const LandmarkObservation& seen : update.observations)
    if (seen.has_right) add(seen.pixels[0], seen.pixels[1], seen.pixels[2]);
  return points;
}

std::string Describe(const StereoFrame& frame, const PoseEstimate& pose) {
  if (!pose.IsMeasured())
    return Format("LOST: %s (%d matches, %zu stereo points)", ToString(pose.status),
                  pose.num_matches, frame.points.size());
  return Format("%s%d of %d map points agree, rms %.2f px",
                pose.IsTracked() ? "" : "DEGRADED: ", pose.num_inliers, pose.num_matches,
                pose.rms_px);
}

}  // namespace

DepthColors::DepthColors(std::vector<float> depths_m) {
  if (depths_m.empty()) return;
  const auto log = [](double depth_m) { return std::log(std::max(depth_m, 1e-3)); };
  log_near_ = log(Quantile(depths_m, 0.05));
  log_far_ = std::max(log(Quantile(std::move(depths_m), 0.95)), log_near_ + 1e-3);
}

cv::Scalar DepthColors::BgrOf(double depth_m) const {
  const double log_depth = std::log(std::max(depth_m, 1e-3));
  const double far = std::clamp((log_depth - log_near_) / (log_far_ - log_near_), 0.0, 1.0);
  // Through violet, not green: green is for the matched ones.
  return {255 * std::min(1.0, 2 - 2 * far), 60, 255 * std::min(1.0, 2 * far)};
}

cv::Mat DrawMatches(const cv::Mat& left, const StereoFrame& frame, const OdometryUpdate& update) {
  cv::Mat picture(left.rows + kTextHeight_px, left.cols, CV_8UC3, cv::Scalar::all(0));
  cv::Mat image = picture.rowRange(kTextHeight_px, picture.rows);
  cv::cvtColor(left, image, cv::COLOR_GRAY2BGR);

  const std::vector<Eigen::Vector3d> points = PointsToDraw(frame, update);
  std::vector<float> depths;
  for (const Eigen::Vector3d& point : points) depths.push_back(point.z());
  const DepthColors colors(depths);
  for (const Eigen::Vector3d& point : points)
    DrawRing(image, point.x(), point.y(), 2, colors.BgrOf(point.z()), cv::FILLED);
  for (const LandmarkObservation& observation : update.observations)
    DrawRing(image, observation.pixels[0], observation.pixels[1], 5, kGreen, 1);

  cv::putText(picture, Describe(frame, update.pose), {6, kTextHeight_px - 7},
              cv::FONT_HERSHEY_SIMPLEX, 0.5, update.pose.IsTracked() ? kWhite : kRed, 1,
              cv::LINE_AA);
  return picture;
}

}  // namespace arfm_vo
