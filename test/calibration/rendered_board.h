#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "arfm_vo/base/random.h"
#include "arfm_vo/calibration/corner_detection.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/simulation/board_set.h"

namespace arfm_vo {

/// The paper's size of image and a rig with small known faults of mounting.
inline BoardRig MakeRig(double scale = 1) {
  const auto camera = [&](double f, double cx, double cy, double k1, double k2) {
    return SingleCamera{{f * scale, 0, cx * scale, 0, f * 1.001 * scale, cy * scale, 0, 0, 1},
                        (cv::Mat_<double>(1, 5) << k1, k2, 4e-4, -3e-4, 0.01)};
  };
  return {cv::Size(int(1624 * scale), int(1234 * scale)), camera(1420, 820.3, 611.8, -0.18, 0.09),
          camera(1431, 803.6, 622.4, -0.17, 0.08),
          Rigid3(ExpSO3({0.004, -0.012, 0.003}), Eigen::Vector3d(-0.24, 0.0012, -0.0015))};
}

/// Random poses of a board that fills a good part of both images and is tilted up to
/// `max_tilt_rad`, wholly in sight of both cameras.
inline std::vector<Rigid3> RandomBoardPoses(const BoardRig& rig, const Chessboard& board, int count,
                                            double max_tilt_rad, RandomEngine& engine) {
  const auto uniform = [&](double low, double high) {
    return low + RandomUnit(engine) * (high - low);
  };
  const auto is_seen = [&](const SingleCamera& camera, const Rigid3& pose) {
    for (const int u : {-1, board.columns})
      for (const int v : {-1, board.rows}) {
        const Eigen::Vector3d x = pose * Eigen::Vector3d(u * board.square_m, v * board.square_m, 0);
        if (x.z() < 0.1) return false;
        std::vector<cv::Point2d> pixel;
        cv::projectPoints(std::vector<cv::Point3d>{{x.x(), x.y(), x.z()}}, cv::Vec3d(0, 0, 0),
                          cv::Vec3d(0, 0, 0), camera.matrix, camera.distortion, pixel);
        if (pixel[0].x < 6 || pixel[0].y < 6 || pixel[0].x > rig.image_size.width - 7 ||
            pixel[0].y > rig.image_size.height - 7)
          return false;
      }
    return true;
  };
  const Eigen::Vector3d centre((board.columns - 1) * board.square_m / 2,
                               (board.rows - 1) * board.square_m / 2, 0);
  const double distance = board.columns * board.square_m * rig.left.matrix(0, 0) /
                          rig.image_size.width;  // at which the board would fill the width
  std::vector<Rigid3> poses;
  while (static_cast<int>(poses.size()) < count) {
    const double heading = uniform(0, 2 * M_PI),
                 tilt = max_tilt_rad * std::sqrt(RandomUnit(engine));
    const Eigen::Quaterniond rotation =
        ExpSO3({tilt * std::cos(heading), tilt * std::sin(heading), 0}) *
        ExpSO3({0, 0, uniform(-0.35, 0.35)});
    const double z = distance * uniform(1.1, 2.2);
    const Eigen::Vector3d middle(z * uniform(-0.35, 0.5), z * uniform(-0.35, 0.35), z);
    const Rigid3 pose(rotation, Eigen::Vector3d(middle - rotation * centre));
    if (is_seen(rig.left, pose) && is_seen(rig.right, rig.right_from_left * pose))
      poses.push_back(pose);
  }
  return poses;
}

/// Where a camera at `camera_from_board` sees the corners: the truth without noise.
inline std::vector<cv::Point2f> ProjectBoard(const SingleCamera& camera, const Chessboard& board,
                                             const Rigid3& camera_from_board) {
  const Eigen::Vector3d omega = LogSO3(camera_from_board.rotation);
  const Eigen::Vector3d& t = camera_from_board.translation;
  std::vector<cv::Point2f> corners;
  cv::projectPoints(board.Corners(), cv::Vec3d(omega.x(), omega.y(), omega.z()),
                    cv::Vec3d(t.x(), t.y(), t.z()), camera.matrix, camera.distortion, corners);
  return corners;
}

/// Takes pictures of a board with a camera.
class BoardCamera {
 public:
  BoardCamera(const SingleCamera& camera, cv::Size image_size, const Chessboard& board)
      : renderer_(camera, image_size, board) {}

  cv::Mat Render(const Rigid3& camera_from_board, double blur_px, double noise_levels,
                 RandomEngine& engine) const {
    SensorOptions sensor;
    sensor.blur_px = blur_px;
    sensor.noise_grey_levels = noise_levels;
    return renderer_.Render(camera_from_board, sensor, engine(), 2);
  }

 private:
  BoardRenderer renderer_;
};

}  // namespace arfm_vo
