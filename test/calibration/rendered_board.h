#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "arfm_vo/base/random.h"
#include "arfm_vo/calibration/chessboard.h"
#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// A camera with known truth, for rendered boards.
struct TrueCamera {
  cv::Matx33d matrix;
  cv::Mat distortion;  ///< [1 x 5] plumb bob
  cv::Size size;
};

struct TrueRig {
  TrueCamera left, right;
  Rigid3 right_from_left;
};

/// The paper's size of image and a rig with small known faults of mounting.
inline TrueRig MakeRig(double scale = 1) {
  const auto camera = [&](double f, double cx, double cy, double k1, double k2) {
    return TrueCamera{{f * scale, 0, cx * scale, 0, f * 1.001 * scale, cy * scale, 0, 0, 1},
                      (cv::Mat_<double>(1, 5) << k1, k2, 4e-4, -3e-4, 0.01),
                      cv::Size(int(1624 * scale), int(1234 * scale))};
  };
  return {camera(1420, 820.3, 611.8, -0.18, 0.09), camera(1431, 803.6, 622.4, -0.17, 0.08),
          Rigid3(ExpSO3({0.004, -0.012, 0.003}), Eigen::Vector3d(-0.24, 0.0012, -0.0015))};
}

/// Random poses of a board that fills a good part of both images and is tilted up to
/// `max_tilt_rad`, wholly in sight of both eyes.
inline std::vector<Rigid3> RandomBoardPoses(const TrueRig& rig, const Chessboard& board, int count,
                                            double max_tilt_rad, RandomEngine& engine) {
  const auto uniform = [&](double low, double high) {
    return low + RandomUnit(engine) * (high - low);
  };
  const auto is_seen = [&](const TrueCamera& camera, const Rigid3& pose) {
    for (const int u : {-1, board.columns})
      for (const int v : {-1, board.rows}) {
        const Eigen::Vector3d x = pose * Eigen::Vector3d(u * board.square_m, v * board.square_m, 0);
        if (x.z() < 0.1) return false;
        std::vector<cv::Point2d> pixel;
        cv::projectPoints(std::vector<cv::Point3d>{{x.x(), x.y(), x.z()}}, cv::Vec3d(0, 0, 0),
                          cv::Vec3d(0, 0, 0), camera.matrix, camera.distortion, pixel);
        if (pixel[0].x < 6 || pixel[0].y < 6 || pixel[0].x > camera.size.width - 7 ||
            pixel[0].y > camera.size.height - 7)
          return false;
      }
    return true;
  };
  const Eigen::Vector3d centre((board.columns - 1) * board.square_m / 2,
                               (board.rows - 1) * board.square_m / 2, 0);
  const double distance = board.columns * board.square_m * rig.left.matrix(0, 0) /
                          rig.left.size.width;  // at which the board would fill the width
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
inline std::vector<cv::Point2f> ProjectBoard(const TrueCamera& camera, const Chessboard& board,
                                             const Rigid3& camera_from_board) {
  const Eigen::Vector3d omega = LogSO3(camera_from_board.rotation);
  const Eigen::Vector3d& t = camera_from_board.translation;
  std::vector<cv::Point2f> corners;
  cv::projectPoints(board.Corners(), cv::Vec3d(omega.x(), omega.y(), omega.z()),
                    cv::Vec3d(t.x(), t.y(), t.z()), camera.matrix, camera.distortion, corners);
  return corners;
}

/// Renders boards by casting a ray a pixel through the distorted camera, each edge averaged over
/// the pixel so that it lies where it should to a small part of one; then blur and noise.
class BoardRenderer {
 public:
  BoardRenderer(const TrueCamera& camera, const Chessboard& board)
      : camera_(camera), board_(board) {
    cv::Mat pixels(camera.size, CV_64FC2);
    for (int v = 0; v < pixels.rows; ++v)
      for (int u = 0; u < pixels.cols; ++u) pixels.at<cv::Vec2d>(v, u) = {double(u), double(v)};
    cv::undistortPoints(pixels.reshape(2, pixels.rows * pixels.cols), rays_, camera.matrix,
                        camera.distortion, cv::noArray(), cv::noArray(),
                        {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 1e-10});
    rays_ = rays_.reshape(2, camera.size.height);
  }

  cv::Mat Render(const Rigid3& camera_from_board, double blur_px, double noise_levels,
                 RandomEngine& engine) const {
    const Rigid3 board_from_camera = camera_from_board.Inverse();
    const Eigen::Matrix3d rotation = board_from_camera.RotationMatrix();
    const Eigen::Vector3d& eye = board_from_camera.translation;
    cv::Mat image(camera_.size, CV_32F);
    cv::parallel_for_({0, image.rows}, [&](const cv::Range& range) {
      for (int v = range.start; v < range.end; ++v)
        for (int u = 0; u < image.cols; ++u) image.at<float>(v, u) = Shade(rotation, eye, u, v);
    });
    cv::GaussianBlur(image, image, {}, blur_px);
    cv::Mat noise(camera_.size, CV_32F), grey;
    cv::RNG random(engine());
    random.fill(noise, cv::RNG::NORMAL, 0, noise_levels);
    image += noise;
    image.convertTo(grey, CV_8U);
    return grey;
  }

 private:
  /// The board's point, in squares from the first inner corner, that a ray (x, y, 1) meets.
  cv::Vec2d Meet(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& eye,
                 const cv::Vec2d& ray) const {
    const Eigen::Vector3d direction = rotation * Eigen::Vector3d(ray[0], ray[1], 1);
    const double depth = -eye.z() / direction.z();
    return {(eye.x() + depth * direction.x()) / board_.square_m,
            (eye.y() + depth * direction.y()) / board_.square_m};
  }

  float Shade(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& eye, int u, int v) const {
    const double light = 0.9 + 0.1 * u / rays_.cols;  // from one side
    const cv::Vec2d ray = rays_.at<cv::Vec2d>(v, u);
    const cv::Vec2d at = Meet(rotation, eye, ray);
    if (!IsWithin(at, 1.6)) return static_cast<float>(105 * light);
    if (!IsWithin(at, 1)) return static_cast<float>(215 * light);  // white margin
    const int u_next = u + (u + 1 < rays_.cols ? 1 : -1),
              v_next = v + (v + 1 < rays_.rows ? 1 : -1);
    const cv::Vec2d by_u = Meet(rotation, eye, rays_.at<cv::Vec2d>(v, u_next)) - at;
    const cv::Vec2d by_v = Meet(rotation, eye, rays_.at<cv::Vec2d>(v_next, u)) - at;
    const double black =
        Wave(at[0], std::hypot(by_u[0], by_v[0])) * Wave(at[1], std::hypot(by_u[1], by_v[1]));
    return static_cast<float>((122.5 - 92.5 * black) * light);
  }

  bool IsWithin(const cv::Vec2d& at, double margin) const {
    return at[0] > -margin && at[1] > -margin && at[0] < board_.columns - 1 + margin &&
           at[1] < board_.rows - 1 + margin;
  }

  /// The square wave (+1 in [0, 1), -1 in [1, 2)) averaged over `width` about x.
  static double Wave(double x, double width) {
    const auto integral = [](double at) {
      const double phase = at - 2 * std::floor(at / 2);
      return phase < 1 ? phase : 2 - phase;
    };
    return (integral(x + width / 2) - integral(x - width / 2)) / width;
  }

  TrueCamera camera_;
  Chessboard board_;
  cv::Mat rays_;  ///< [height x width] undistorted (x, y) at z = 1 of each pixel
};

}  // namespace arfm_vo
