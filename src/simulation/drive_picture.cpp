#include "arfm_vo/simulation/drive_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "arfm_vo/base/format.h"
#include "arfm_vo/simulation/drive_path.h"
#include "arfm_vo/simulation/terrain_renderer.h"

namespace arfm_vo {
namespace {

constexpr int kSide_px = 800, kCaption_px = 84;
constexpr double kMargin_m = 2.5;
constexpr double kHeight_m = 300;  ///< of the camera: so high that the ground looks flat from there
const cv::Scalar kTruthColor(60, 200, 60), kSightColor(40, 60, 230), kGoalColor(0, 215, 255),
    kInk(20, 20, 20), kPaper(245, 245, 245), kGround(0.72, 0.86, 1);

/// The picture, and where the places of the map are in it.
class Canvas {
 public:
  Canvas(const Terrain& terrain, const RoverPose& start, const Drive& drive)
      : terrain_(terrain), start_(start) {
    Eigen::AlignedBox2d box(PositionOf(ToWorld(Goal(drive))));
    for (const TrackPoint& point : drive.track) box.extend(PositionOf(ToWorld(point.truth)));
    px_per_m_ = kSide_px / (box.sizes().maxCoeff() + 2 * kMargin_m);
    const double focal_px = px_per_m_ * kHeight_m, middle_px = (kSide_px - 1) / 2.0;
    camera_ = {focal_px, focal_px, middle_px, middle_px, 1, kSide_px, kSide_px};
    const Eigen::Vector2d middle = box.center();
    const double camera_m = terrain.Height(middle.x(), middle.y()) + kHeight_m;
    const Rigid3 world_from_camera(Eigen::Quaterniond(0, 1, 0, 0),  // down, the y axis up
                                   Eigen::Vector3d(middle.x(), middle.y(), camera_m));
    camera_from_world_ = world_from_camera.Inverse();
    cv::Mat ground;
    cv::cvtColor(TerrainRenderer(terrain, {}).Render(camera_, world_from_camera, 0), ground,
                 cv::COLOR_GRAY2BGR);
    cv::multiply(ground, kGround, ground);
    cv::copyMakeBorder(ground, picture_, 0, kCaption_px, 0, 0, cv::BORDER_CONSTANT, kPaper);
  }
  static RoverPose Goal(const Drive& drive) {
    return {drive.goal.x_m, drive.goal.y_m, drive.goal.heading_rad.value_or(0)};
  }
  void DrawWay(const Drive& drive, RoverPose TrackPoint::*pose, const cv::Scalar& color,
               int width) {
    std::vector<cv::Point> points;
    for (const TrackPoint& point : drive.track)
      if (point.is_tracked) points.push_back(Pixel(point.*pose));
    cv::polylines(picture_, points, false, color, width, cv::LINE_AA);
  }
  void DrawPose(const RoverPose& pose, const cv::Scalar& color) {
    cv::circle(picture_, Pixel(pose), 7, color, -1, cv::LINE_AA);
    cv::arrowedLine(picture_, Pixel(pose), Pixel(Advance(pose, 0.8, 0)), color, 3, cv::LINE_AA, 0,
                    0.3);
  }
  void DrawScale() {
    const int y = kSide_px - 18;
    cv::line(picture_, {20, y}, {20 + cvRound(px_per_m_), y}, kPaper, 3);
    Write("1 m", {20, y - 8}, kPaper);
  }
  void Write(const std::string& text, cv::Point at, const cv::Scalar& color) {
    cv::putText(picture_, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.5, color, 1, cv::LINE_AA);
  }
  const cv::Mat& picture() const { return picture_; }

 private:
  RoverPose ToWorld(const RoverPose& in_map) const {
    return ProjectToPlane(LiftFromPlane(start_) * LiftFromPlane(in_map));
  }
  cv::Point Pixel(const RoverPose& in_map) const {
    const RoverPose place = ToWorld(in_map);
    const Eigen::Vector3d on_ground(place.x_m, place.y_m, terrain_.Height(place.x_m, place.y_m));
    const Eigen::Vector2d pixel = camera_.Project(camera_from_world_ * on_ground);
    return {cvRound(pixel.x()), cvRound(pixel.y())};
  }

  const Terrain& terrain_;
  RoverPose start_;
  double px_per_m_ = 1;
  StereoCamera camera_;
  Rigid3 camera_from_world_;
  cv::Mat picture_;
};

}  // namespace

cv::Mat DrawDrive(const Terrain& terrain, const RoverPose& start, const Drive& drive) {
  Canvas canvas(terrain, start, drive);
  canvas.DrawWay(drive, &TrackPoint::truth, kTruthColor, 8);
  canvas.DrawWay(drive, &TrackPoint::sight, kSightColor, 2);
  if (!drive.track.empty()) canvas.DrawPose(drive.track.front().truth, kInk);
  canvas.DrawPose(Canvas::Goal(drive), kGoalColor);
  canvas.DrawScale();
  double farthest_m = 0;
  for (const TrackPoint& point : drive.track)
    if (point.is_tracked) farthest_m = std::max(farthest_m, Distance(point.truth, point.sight));
  canvas.Write(
      Format("driven %.2f m in %.0f s, %.1f deg at the steepest; sight off by %.3f m at most",
             drive.driven_m, drive.duration_s, drive.steepest_deg, farthest_m),
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

void SaveDrive(const std::string& path, const Terrain& terrain, const RoverPose& start,
               const Drive& drive) {
  const std::string temporary = path + ".new.png";
  if (!cv::imwrite(temporary, DrawDrive(terrain, start, drive)))
    throw std::runtime_error(temporary + ": cannot be written");
  std::filesystem::rename(temporary, path);
}

}  // namespace arfm_vo
