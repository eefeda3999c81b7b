#include "arfm_vo/rehearsal/drive_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace arfm_vo {
namespace {

constexpr int kSide_px = 800;
constexpr int kCaption_px = 84;
constexpr double kMargin_m = 2.5;
constexpr double kContour_m = 0.25;
const cv::Scalar kTruthColor(60, 200, 60), kSightColor(40, 60, 230), kGoalColor(0, 215, 255),
    kInk(20, 20, 20), kPaper(245, 245, 245);

/// A place of the map in the world, both seen from above.
RoverPose ToWorld(const RoverPose& start, const RoverPose& in_map) {
  const double cosine = std::cos(start.heading_rad), sine = std::sin(start.heading_rad);
  return {start.x_m + cosine * in_map.x_m - sine * in_map.y_m,
          start.y_m + sine * in_map.x_m + cosine * in_map.y_m,
          start.heading_rad + in_map.heading_rad};
}

class Canvas {
 public:
  Canvas(const Terrain& terrain, const RoverPose& start, const Drive& drive)
      : terrain_(terrain), start_(start) {
    const RoverPose goal = Goal(drive);
    double low_x = goal.x_m, high_x = low_x, low_y = goal.y_m, high_y = low_y;
    for (const TrackPoint& point : drive.track) {
      const RoverPose place = ToWorld(start_, point.truth);
      low_x = std::min(low_x, place.x_m), high_x = std::max(high_x, place.x_m);
      low_y = std::min(low_y, place.y_m), high_y = std::max(high_y, place.y_m);
    }
    const double side_m = std::max(high_x - low_x, high_y - low_y) + 2 * kMargin_m;
    px_per_m_ = kSide_px / side_m;
    left_m_ = (low_x + high_x - side_m) / 2;
    top_m_ = (low_y + high_y + side_m) / 2;
    picture_ = cv::Mat(kSide_px + kCaption_px, kSide_px, CV_8UC3, kPaper);
  }

  RoverPose Goal(const Drive& drive) const {
    return ToWorld(start_, {drive.goal.x_m, drive.goal.y_m, drive.goal.heading_rad.value_or(0)});
  }

  void ShadeGround() {
    for (int v = 0; v < kSide_px; ++v) {
      for (int u = 0; u < kSide_px; ++u) {
        const double x = left_m_ + u / px_per_m_, y = top_m_ - v / px_per_m_;
        const double light = terrain_.Normal(x, y).dot(terrain_.to_sun()) / terrain_.to_sun().z();
        const double height = terrain_.Height(x, y) / kContour_m;
        const double next = terrain_.Height(x + 1 / px_per_m_, y - 1 / px_per_m_) / kContour_m;
        const double shade = std::clamp(60 + 95 * light, 0.0, 235.0) *
                             (std::floor(height) == std::floor(next) ? 1 : 0.8);
        picture_.at<cv::Vec3b>(v, u) = {cv::saturate_cast<uchar>(0.72 * shade),
                                        cv::saturate_cast<uchar>(0.86 * shade),
                                        cv::saturate_cast<uchar>(shade)};
      }
    }
  }

  void DrawWay(const Drive& drive, RoverPose TrackPoint::*pose, const cv::Scalar& color,
               int width) {
    std::vector<cv::Point> points;
    for (const TrackPoint& point : drive.track)
      if (point.is_tracked) points.push_back(Pixel(ToWorld(start_, point.*pose)));
    cv::polylines(picture_, points, false, color, width, cv::LINE_AA);
  }

  void DrawPose(const RoverPose& pose, const cv::Scalar& color) {
    RoverPose tip = pose;
    tip.x_m += 0.8 * std::cos(pose.heading_rad);
    tip.y_m += 0.8 * std::sin(pose.heading_rad);
    cv::circle(picture_, Pixel(pose), 7, color, -1, cv::LINE_AA);
    cv::arrowedLine(picture_, Pixel(pose), Pixel(tip), color, 3, cv::LINE_AA, 0, 0.3);
  }

  void DrawScale() {
    const int y = kSide_px - 18;
    const int end = 20 + static_cast<int>(std::lround(px_per_m_));
    cv::line(picture_, {20, y}, {end, y}, kInk, 3);
    Write("1 m", {20, y - 8}, kInk);
  }

  void Write(const std::string& text, cv::Point at, const cv::Scalar& color) {
    cv::putText(picture_, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.5, color, 1, cv::LINE_AA);
  }

  const cv::Mat& picture() const { return picture_; }

 private:
  cv::Point Pixel(const RoverPose& place) const {
    return {static_cast<int>(std::lround((place.x_m - left_m_) * px_per_m_)),
            static_cast<int>(std::lround((top_m_ - place.y_m) * px_per_m_))};
  }

  const Terrain& terrain_;
  RoverPose start_;
  double px_per_m_ = 1, left_m_ = 0, top_m_ = 0;
  cv::Mat picture_;
};

std::string Format(const char* format, double a, double b, double c) {
  char text[160];
  std::snprintf(text, sizeof(text), format, a, b, c);
  return text;
}

}  // namespace

cv::Mat DrawDrive(const Terrain& terrain, const RoverPose& start, const Drive& drive) {
  Canvas canvas(terrain, start, drive);
  canvas.ShadeGround();
  canvas.DrawWay(drive, &TrackPoint::truth, kTruthColor, 4);
  canvas.DrawWay(drive, &TrackPoint::sight, kSightColor, 2);
  canvas.DrawPose(start, kInk);
  canvas.DrawPose(canvas.Goal(drive), kGoalColor);
  canvas.DrawScale();
  canvas.Write(Format("driven %.2f m in %.0f s, %.1f deg at the steepest", drive.driven_m,
                      drive.duration_s, drive.steepest_deg),
               {16, kSide_px + 24}, kInk);
  canvas.Write(drive.outcome + Format(": %.3f m and %.2f deg from the goal (allowed %.3f m)",
                                      drive.final_error_m, drive.final_heading_error_deg,
                                      drive.AllowedError()),
               {16, kSide_px + 48}, kInk);
  canvas.Write("true way", {16, kSide_px + 72}, kTruthColor);
  canvas.Write("way by sight", {110, kSide_px + 72}, kSightColor);
  canvas.Write("goal", {240, kSide_px + 72}, {0, 150, 200});
  return canvas.picture();
}

}  // namespace arfm_vo
