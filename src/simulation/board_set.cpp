#include "arfm_vo/simulation/board_set.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/base/random.h"
#include "arfm_vo/simulation/parallel_rows.h"

namespace arfm_vo {
namespace {

constexpr double kBlack = 0.06, kWhite = 0.8, kBackground = 0.3;

/// The share within [low, high] of what is `width` wide about x.
double ShareWithin(double low, double high, double x, double width) {
  const auto share_above = [&](double limit) {
    return std::clamp((x - limit) / width + 0.5, 0.0, 1.0);
  };
  return share_above(low) - share_above(high);
}

/// The square wave, +1 in [0, 1) and -1 in [1, 2), averaged over `width` about x.
double SquareWave(double x, double width) {
  const auto integral = [](double end) {
    const double phase = end - 2 * std::floor(end / 2);
    return std::min(phase, 2 - phase);
  };
  return (integral(x + width / 2) - integral(x - width / 2)) / width;
}

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

std::string FormatCamera(const std::string& side, const DistortedCamera& camera) {
  std::string lines;
  const auto& [fx, fy, cx, cy, k1, k2, p1, p2, k3, width, height] = camera;
  const double values[] = {fx, fy, cx, cy, k1, k2, p1, p2, k3};
  const char* const kKeys[] = {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
  for (size_t i = 0; i < std::size(values); ++i)
    lines += std::string(kKeys[i]) + "_" + side + ": " + FormatNumber(values[i]) + "\n";
  return lines;
}

}  // namespace

void DistortedCamera::Check() const {
  Require(fx > 0 && fy > 0, "distorted camera: focal lengths must be positive");
  Require(width >= 1 && height >= 1, "distorted camera: width and height must be positive");
  for (const double value : {fx, fy, cx, cy, k1, k2, p1, p2, k3}) {
    Require(std::isfinite(value), "distorted camera: a value is not finite");
  }
}

Eigen::Vector2d DistortedCamera::Project(const Eigen::Vector2d& n) const {
  const double x = n.x(), y = n.y(), r2 = n.squaredNorm();
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {fx * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + cx,
          fy * (y * radial + 2 * p2 * x * y + p1 * (r2 + 2 * y * y)) + cy};
}

Eigen::Vector2d DistortedCamera::Unproject(const Eigen::Vector2d& pixel) const {
  constexpr double kStep = 1e-6;
  Eigen::Vector2d n((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Eigen::Vector2d error = Project(n) - pixel;
    if (error.squaredNorm() < 1e-22) break;
    Eigen::Matrix2d jacobian;
    jacobian.col(0) = (Project(n + Eigen::Vector2d(kStep, 0)) - error - pixel) / kStep;
    jacobian.col(1) = (Project(n + Eigen::Vector2d(0, kStep)) - error - pixel) / kStep;
    n -= jacobian.inverse() * error;
  }
  return n;
}

void BoardPattern::Check() const {
  Require(columns >= 2 && rows >= 2, "board: needs at least 2 x 2 inner corners");
  Require(square_m > 0, "board: square_m must be positive");
}

BoardRenderer::BoardRenderer(const DistortedCamera& camera, const BoardPattern& pattern)
    : camera_(camera), pattern_(pattern) {
  camera.Check();
  pattern.Check();
  rays_.reserve(static_cast<size_t>(camera.width + 1) * (camera.height + 1));
  for (int v = 0; v <= camera.height; ++v) {
    for (int u = 0; u <= camera.width; ++u) {
      rays_.push_back(camera.Unproject({u, v}));
    }
  }
}

double BoardRenderer::Tone(const Eigen::Vector2d& at, const Eigen::Vector2d& width) const {
  const auto share_within = [&](double margin) {
    return ShareWithin(-margin, pattern_.columns - 1 + margin, at.x(), width.x()) *
           ShareWithin(-margin, pattern_.rows - 1 + margin, at.y(), width.y());
  };
  const double black = (1 + SquareWave(at.x(), width.x()) * SquareWave(at.y(), width.y())) / 2;
  return kBackground + (kWhite - kBackground) * share_within(2) -
         (kWhite - kBlack) * share_within(1) * black;
}

cv::Mat BoardRenderer::Trace(const Rigid3& camera_from_board, int num_threads) const {
  Require(camera_from_board.IsFinite(), "board: its pose is not finite");
  // board_from_ray * (x, y, 1) is the point on the board's plane, up to scale.
  Eigen::Matrix3d ray_from_board = camera_from_board.RotationMatrix();
  ray_from_board.leftCols<2>() *= pattern_.square_m;
  ray_from_board.col(2) = camera_from_board.translation;
  const Eigen::Matrix3d board_from_ray = ray_from_board.inverse();
  const double facing = std::abs(camera_from_board.RotationMatrix()(2, 2));
  cv::Mat radiance(camera_.height, camera_.width, CV_32FC1);
  ForEachRow(camera_.height, num_threads, [&](int v) {
    for (int u = 0; u < camera_.width; ++u) {
      double nearest = 1e9;  // 1 / depth in units of the scale; not positive behind the camera
      const auto meet = [&](int right, int down) -> Eigen::Vector2d {
        const size_t at = static_cast<size_t>(v + down) * (camera_.width + 1) + u + right;
        const Eigen::Vector3d q = board_from_ray * rays_[at].homogeneous();
        nearest = std::min(nearest, q.z());
        return q.head<2>() / q.z();
      };
      const Eigen::Vector2d here = meet(0, 0);
      const Eigen::Vector2d along_u = meet(1, 0) - here, along_v = meet(0, 1) - here;
      const Eigen::Vector2d width(std::hypot(along_u.x(), along_v.x()),
                                  std::hypot(along_u.y(), along_v.y()));
      // The board is lit from the camera's side, a little unevenly; the room behind is even.
      const double light = (0.75 + 0.25 * facing) * (0.9 + 0.1 * u / camera_.width);
      radiance.at<float>(v, u) = light * (nearest > 1e-9 ? Tone(here, width) : kBackground);
    }
  });
  return radiance;
}

cv::Mat BoardRenderer::Render(const Rigid3& camera_from_board, const SensorOptions& sensor,
                              uint32_t image_id, int num_threads) const {
  return ExposeImage(Trace(camera_from_board, num_threads), sensor, image_id);
}

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
          "board: too few poses show the whole board to both cameras");
  return poses;
}

std::string FormatTruth(const BoardRig& rig, const BoardPattern& pattern) {
  const Eigen::Vector3d rotation = LogSO3(rig.right_from_left.rotation);
  const Eigen::Vector3d& translation = rig.right_from_left.translation;
  std::string lines =
      "columns: " + std::to_string(pattern.columns) + "\nrows: " + std::to_string(pattern.rows) +
      "\nsquare_m: " + FormatNumber(pattern.square_m) + "\n" + FormatCamera("left", rig.left) +
      FormatCamera("right", rig.right) + "baseline_m: " + FormatNumber(rig.BaselineM()) + "\n";
  for (int i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    lines += "right_from_left_rotation_" + axis + ": " + FormatNumber(rotation[i]) + "\n";
    lines += "right_from_left_translation_m_" + axis + ": " + FormatNumber(translation[i]) + "\n";
  }
  return lines;
}

}  // namespace arfm_vo
