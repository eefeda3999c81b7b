#include "arfm_vo/simulation/drive_picture.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

constexpr int kSide_px = 800;
constexpr int kCaption_px = 84;
constexpr int kChart_px = 130;  ///< of the error over the way, below the caption
constexpr double kMargin_m = 2.5;
constexpr double kContour_m = 0.25;
const cv::Scalar kTruthColor(60, 200, 60), kSightColor(40, 60, 230), kGoalColor(0, 215, 255),
    kInk(20, 20, 20), kPaper(245, 245, 245), kRock(150, 172, 190), kShadow(48, 58, 68),
    kFaint(200, 200, 200);

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
    picture_ = cv::Mat(kSide_px + kCaption_px + kChart_px, kSide_px, CV_8UC3, kPaper);
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

  /// As lit discs with a shadow; before anything lies on them.
  void StrewRocks() {
    cv::Mat ground = picture_.rowRange(0, kSide_px);
    const Eigen::Vector2d shade = -terrain_.to_sun().head<2>().normalized();
    for (const Solid& rock : terrain_.rocks().rocks()) {
      const double radius_px = 0.8 * rock.bounding_radius_m * px_per_m_;
      const cv::Point at = Pixel({rock.center.x(), rock.center.y(), 0});
      if (radius_px < 0.7 || !cv::Rect(0, 0, kSide_px, kSide_px).contains(at)) continue;
      const double shadow_px = 0.7 * radius_px;
      const cv::Point shadow(at.x + static_cast<int>(std::lround(shadow_px * shade.x())),
                             at.y - static_cast<int>(std::lround(shadow_px * shade.y())));
      const int radius = std::max(1, static_cast<int>(std::lround(radius_px)));
      cv::circle(ground, shadow, radius, kShadow, -1, cv::LINE_AA);
      cv::circle(ground, at, radius, kRock, -1, cv::LINE_AA);
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

  /// How far sight is from the truth, over the way.
  void DrawErrorChart(const Drive& drive) {
    const cv::Rect frame(60, kSide_px + kCaption_px + 8, kSide_px - 80, kChart_px - 34);
    std::vector<cv::Point2d> errors;  // m driven, m of error
    double way_m = 0, top_m = 0.02;
    for (size_t i = 0; i < drive.track.size(); ++i) {
      const TrackPoint& point = drive.track[i];
      if (i > 0) way_m += Distance(point.truth, drive.track[i - 1].truth);
      if (!point.is_tracked) continue;
      errors.emplace_back(way_m, Distance(point.truth, point.sight));
      top_m = std::max(top_m, 1.1 * errors.back().y);
    }
    std::vector<cv::Point> line;
    for (const cv::Point2d& error : errors)
      line.emplace_back(frame.x + cvRound(frame.width * error.x / std::max(way_m, 1e-3)),
                        frame.br().y - cvRound(frame.height * error.y / top_m));
    cv::rectangle(picture_, frame, kFaint, 1);
    cv::polylines(picture_, line, false, kSightColor, 2, cv::LINE_AA);
    Write(Format("%.0f cm", 100 * top_m), {6, frame.y + 12}, kInk);
    Write("0", {44, frame.br().y}, kInk);
    Write("sight off the truth, over the way driven", {frame.x, frame.br().y + 18}, kInk);
    Write(Format("%.1f m", way_m), {frame.br().x - 50, frame.br().y + 18}, kInk);
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

}  // namespace

cv::Mat DrawDrive(const Terrain& terrain, const RoverPose& start, const Drive& drive) {
  Canvas canvas(terrain, start, drive);
  canvas.ShadeGround();
  canvas.StrewRocks();
  canvas.DrawWay(drive, &TrackPoint::truth, kTruthColor, 8);
  canvas.DrawWay(drive, &TrackPoint::sight, kSightColor, 2);
  if (!drive.track.empty()) canvas.DrawPose(ToWorld(start, drive.track.front().truth), kInk);
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
  canvas.DrawErrorChart(drive);
  return canvas.picture();
}

void SaveDrive(const std::string& path, const Terrain& terrain, const RoverPose& start,
               const Drive& drive) {
  const std::string temporary = path + ".new.png";
  if (!cv::imwrite(temporary, DrawDrive(terrain, start, drive)))
    throw std::runtime_error(temporary + ": cannot be written");
  std::filesystem::rename(temporary, path);
}

}  // namespace arfm_vo
