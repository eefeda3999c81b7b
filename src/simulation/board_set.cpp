#include "arfm_vo/simulation/board_set.h"

#include <cmath>

#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/base/random.h"

namespace arfm_vo {
namespace {

constexpr int kMaxTries = 100000;
constexpr double kMarginPx = 5;

bool IsInSight(const DistortedCamera& camera, const BoardPattern& pattern,
               const Rigid3& camera_from_board) {
  for (const double column : {-1.5, pattern.columns + 0.5}) {
    for (const double row : {-1.5, pattern.rows + 0.5}) {
      const Eigen::Vector3d x =
          camera_from_board * Eigen::Vector3d(column * pattern.square_m, row * pattern.square_m, 0);
      if (x.z() < 0.2) return false;
      const Eigen::Vector2d pixel = camera.Project(x.head<2>() / x.z());
      if (pixel.x() < kMarginPx || pixel.y() < kMarginPx ||
          pixel.x() > camera.width - 1 - kMarginPx || pixel.y() > camera.height - 1 - kMarginPx) {
        return false;
      }
    }
  }
  return true;
}

Rigid3 DrawPose(const DistortedCamera& camera, const BoardPattern& pattern, double max_tilt_rad,
                RandomEngine& engine) {
  const auto draw = [&](double low, double high) {
    return low + (high - low) * RandomUnit(engine);
  };
  const double azimuth = draw(0, 2 * M_PI), tilt = max_tilt_rad * std::sqrt(draw(0.1, 1));
  const Eigen::Quaterniond rotation =
      ExpSO3(tilt * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0)) *
      ExpSO3({0, 0, draw(-0.3, 0.3)});
  const double width_m = (pattern.columns + 1) * pattern.square_m;
  const double z = width_m * camera.fx / (draw(0.25, 0.8) * camera.width);
  const Eigen::Vector2d pixel(draw(0, camera.width), draw(0, camera.height));
  const Eigen::Vector2d ray = camera.Unproject(pixel);
  const Eigen::Vector3d middle((pattern.columns - 1) * pattern.square_m / 2,
                               (pattern.rows - 1) * pattern.square_m / 2, 0);
  return {rotation, Eigen::Vector3d(z * Eigen::Vector3d(ray.x(), ray.y(), 1) - rotation * middle)};
}

std::string FormatEye(const std::string& eye, const DistortedCamera& camera) {
  std::string lines;
  const auto& [fx, fy, cx, cy, k1, k2, p1, p2, k3, width, height] = camera;
  const double values[] = {fx, fy, cx, cy, k1, k2, p1, p2, k3};
  const char* const kKeys[] = {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
  for (size_t i = 0; i < std::size(values); ++i)
    lines += std::string(kKeys[i]) + "_" + eye + ": " + FormatNumber(values[i]) + "\n";
  return lines;
}

}  // namespace

BoardRig BoardRig::Make(int width) {
  const double scale = width / 1624.0;
  const int height = static_cast<int>(std::lround(1234 * scale));
  BoardRig rig;
  rig.left = {1405 * scale, 1406.3 * scale, 818.6 * scale, 609.1 * scale, -0.168, 0.081,
              3e-4,         -4e-4,          0.006,         width,         height};
  rig.right = {1412.5 * scale, 1413.1 * scale, 806.2 * scale, 621.7 * scale, -0.172, 0.085,
               -2e-4,          3e-4,           0.004,         width,         height};
  rig.right_from_left = {ExpSO3({0.005, -0.011, 0.004}), Eigen::Vector3d(-0.24, 0.0014, -0.0021)};
  return rig;
}

std::vector<Rigid3> DrawBoardPoses(const BoardRig& rig, const BoardPattern& pattern, int num_poses,
                                   double max_tilt_deg, int seed) {
  pattern.Check();
  RandomEngine engine(seed);
  std::vector<Rigid3> poses;
  for (int i = 0; i < kMaxTries && static_cast<int>(poses.size()) < num_poses; ++i) {
    const Rigid3 pose = DrawPose(rig.left, pattern, max_tilt_deg * M_PI / 180, engine);
    if (IsInSight(rig.left, pattern, pose) &&
        IsInSight(rig.right, pattern, rig.right_from_left * pose)) {
      poses.push_back(pose);
    }
  }
  Require(static_cast<int>(poses.size()) == num_poses,
          "board: too few poses show the whole board to both eyes");
  return poses;
}

std::string FormatTruth(const BoardRig& rig, const BoardPattern& pattern) {
  const Eigen::Vector3d rotation = LogSO3(rig.right_from_left.rotation);
  const Eigen::Vector3d& translation = rig.right_from_left.translation;
  std::string lines =
      "columns: " + std::to_string(pattern.columns) + "\nrows: " + std::to_string(pattern.rows) +
      "\nsquare_m: " + FormatNumber(pattern.square_m) + "\n" + FormatEye("left", rig.left) +
      FormatEye("right", rig.right) + "baseline_m: " + FormatNumber(rig.BaselineM()) + "\n";
  for (int i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    lines += "right_from_left_rotation_" + axis + ": " + FormatNumber(rotation[i]) + "\n";
    lines += "right_from_left_translation_m_" + axis + ": " + FormatNumber(translation[i]) + "\n";
  }
  return lines;
}

}  // namespace arfm_vo
