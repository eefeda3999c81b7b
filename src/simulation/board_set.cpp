#include "arfm_vo/simulation/board_set.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

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

bool IsInSight(const SingleCamera& camera, cv::Size image_size, const Chessboard& board,
               const Rigid3& camera_from_board) {
  std::vector<cv::Point3d> corners;
  for (const double column : {-1.5, board.columns + 0.5}) {
    for (const double row : {-1.5, board.rows + 0.5}) {
      const Eigen::Vector3d x =
          camera_from_board * Eigen::Vector3d(column * board.square_m, row * board.square_m, 0);
      if (x.z() < 0.2) return false;
      corners.emplace_back(x.x(), x.y(), x.z());
    }
  }
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(corners, cv::Vec3d(), cv::Vec3d(), camera.matrix, camera.distortion, pixels);
  const cv::Rect2d inside(kMarginPx, kMarginPx, image_size.width - 1 - 2 * kMarginPx,
                          image_size.height - 1 - 2 * kMarginPx);
  return std::all_of(pixels.begin(), pixels.end(),
                     [&](const cv::Point2d& pixel) { return inside.contains(pixel); });
}

std::vector<cv::Point2d> Unproject(const SingleCamera& camera,
                                   const std::vector<cv::Point2d>& pixels) {
  std::vector<cv::Point2d> rays;
  cv::undistortPoints(pixels, rays, camera.matrix, camera.distortion, cv::noArray(), cv::noArray(),
                      {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-11});
  return rays;
}

Rigid3 DrawPose(const BoardRig& rig, const Chessboard& board, double max_tilt_rad,
                RandomEngine& engine) {
  const auto draw = [&](double low, double high) {
    return low + (high - low) * RandomUnit(engine);
  };
  const double azimuth = draw(0, 2 * M_PI), tilt = max_tilt_rad * std::sqrt(draw(0.1, 1));
  const Eigen::Quaterniond rotation =
      ExpSO3(tilt * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0)) *
      ExpSO3({0, 0, draw(-0.3, 0.3)});
  const double width_m = (board.columns + 1) * board.square_m;
  const double z = width_m * rig.left.matrix(0, 0) / (draw(0.25, 0.8) * rig.image_size.width);
  const double v = draw(0, rig.image_size.height), u = draw(0, rig.image_size.width);
  const cv::Point2d ray = Unproject(rig.left, {{u, v}})[0];
  const Eigen::Vector3d middle((board.columns - 1) * board.square_m / 2,
                               (board.rows - 1) * board.square_m / 2, 0);
  return {rotation, Eigen::Vector3d(z * Eigen::Vector3d(ray.x, ray.y, 1) - rotation * middle)};
}

std::string FormatCamera(const std::string& side, const SingleCamera& camera) {
  const cv::Matx33d& k = camera.matrix;
  const cv::Mat1d d = camera.distortion;
  std::string lines;
  for (const auto& [key, value] : {std::pair("fx", k(0, 0)),
                                   {"fy", k(1, 1)},
                                   {"cx", k(0, 2)},
                                   {"cy", k(1, 2)},
                                   {"k1", d(0)},
                                   {"k2", d(1)},
                                   {"p1", d(2)},
                                   {"p2", d(3)},
                                   {"k3", d(4)}})
    lines += std::string(key) + "_" + side + ": " + FormatNumber(value) + "\n";
  return lines;
}

}  // namespace

BoardRenderer::BoardRenderer(const SingleCamera& camera, cv::Size image_size,
                             const Chessboard& board)
    : image_size_(image_size), board_(board) {
  board.Check();
  std::vector<cv::Point2d> pixels;
  for (int v = 0; v <= image_size.height; ++v)
    for (int u = 0; u <= image_size.width; ++u) pixels.emplace_back(u, v);
  rays_ = Unproject(camera, pixels);
}

double BoardRenderer::Tone(const Eigen::Vector2d& at, const Eigen::Vector2d& width) const {
  const auto share_within = [&](double margin) {
    return ShareWithin(-margin, board_.columns - 1 + margin, at.x(), width.x()) *
           ShareWithin(-margin, board_.rows - 1 + margin, at.y(), width.y());
  };
  const double black = (1 + SquareWave(at.x(), width.x()) * SquareWave(at.y(), width.y())) / 2;
  return kBackground + (kWhite - kBackground) * share_within(2) -
         (kWhite - kBlack) * share_within(1) * black;
}

cv::Mat BoardRenderer::Trace(const Rigid3& camera_from_board, int num_threads) const {
  Require(camera_from_board.IsFinite(), "board: its pose is not finite");
  // board_from_ray * (x, y, 1) is the point on the board's plane, up to scale.
  Eigen::Matrix3d ray_from_board = camera_from_board.RotationMatrix();
  ray_from_board.leftCols<2>() *= board_.square_m;
  ray_from_board.col(2) = camera_from_board.translation;
  const Eigen::Matrix3d board_from_ray = ray_from_board.inverse();
  const double facing = std::abs(camera_from_board.RotationMatrix()(2, 2));
  cv::Mat radiance(image_size_, CV_32FC1);
  ForEachRow(image_size_.height, num_threads, [&](int v) {
    for (int u = 0; u < image_size_.width; ++u) {
      double nearest = 1e9;  // 1 / depth in units of the scale; not positive behind the camera
      const auto meet = [&](int right, int down) -> Eigen::Vector2d {
        const size_t at = static_cast<size_t>(v + down) * (image_size_.width + 1) + u + right;
        const Eigen::Vector3d q = board_from_ray * Eigen::Vector3d(rays_[at].x, rays_[at].y, 1);
        nearest = std::min(nearest, q.z());
        return q.head<2>() / q.z();
      };
      const Eigen::Vector2d here = meet(0, 0);
      const Eigen::Vector2d along_u = meet(1, 0) - here, along_v = meet(0, 1) - here;
      const Eigen::Vector2d width(std::hypot(along_u.x(), along_v.x()),
                                  std::hypot(along_u.y(), along_v.y()));
      // The board is lit from the camera's side, a little unevenly; the room behind is even.
      const double light = (0.75 + 0.25 * facing) * (0.9 + 0.1 * u / image_size_.width);
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
  const auto camera = [&](double fx, double fy, double cx, double cy,
                          const cv::Vec<double, 5>& distortion) {
    return SingleCamera{{fx * scale, 0, cx * scale, 0, fy * scale, cy * scale, 0, 0, 1},
                        cv::Mat(distortion).t()};
  };
  return {{width, static_cast<int>(std::lround(1234 * scale))},
          camera(1405, 1406.3, 818.6, 609.1, {-0.168, 0.081, 3e-4, -4e-4, 0.006}),
          camera(1412.5, 1413.1, 806.2, 621.7, {-0.172, 0.085, -2e-4, 3e-4, 0.004}),
          {ExpSO3({0.005, -0.011, 0.004}), Eigen::Vector3d(-0.24, 0.0014, -0.0021)}};
}

std::vector<Rigid3> DrawBoardPoses(const BoardRig& rig, const Chessboard& board, int num_poses,
                                   double max_tilt_deg, int seed) {
  board.Check();
  RandomEngine engine(seed);
  std::vector<Rigid3> poses;
  for (int i = 0; i < kMaxTries && static_cast<int>(poses.size()) < num_poses; ++i) {
    const Rigid3 pose = DrawPose(rig, board, max_tilt_deg * M_PI / 180, engine);
    if (IsInSight(rig.left, rig.image_size, board, pose) &&
        IsInSight(rig.right, rig.image_size, board, rig.right_from_left * pose)) {
      poses.push_back(pose);
    }
  }
  Require(static_cast<int>(poses.size()) == num_poses,
          "board: too few poses show the whole board to both cameras");
  return poses;
}

std::string FormatTruth(const BoardRig& rig, const Chessboard& board) {
  const Eigen::Vector3d rotation = LogSO3(rig.right_from_left.rotation);
  const Eigen::Vector3d& translation = rig.right_from_left.translation;
  std::string lines =
      "columns: " + std::to_string(board.columns) + "\nrows: " + std::to_string(board.rows) +
      "\nsquare_m: " + FormatNumber(board.square_m) + "\n" + FormatCamera("left", rig.left) +
      FormatCamera("right", rig.right) + "baseline_m: " + FormatNumber(rig.BaselineM()) + "\n";
  for (int i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    lines += "right_from_left_rotation_" + axis + ": " + FormatNumber(rotation[i]) + "\n";
    lines += "right_from_left_translation_m_" + axis + ": " + FormatNumber(translation[i]) + "\n";
  }
  return lines;
}

}  // namespace arfm_vo
