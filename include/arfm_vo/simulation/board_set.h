#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/simulation/sensor.h"

namespace arfm_vo {

/// A pinhole camera with the distortion of Brown (1971) and Conrady (1919) as OpenCV has it:
/// x_d = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2), y_d alike.
struct DistortedCamera {
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< px
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
  int width = 0, height = 0;  ///< px

  void Check() const;
  /// The pixel of a point (x / z, y / z, 1) in the camera frame.
  Eigen::Vector2d Project(const Eigen::Vector2d& normalized) const;
  /// The inverse of Project, by Newton's method.
  Eigen::Vector2d Unproject(const Eigen::Vector2d& pixel) const;
};

/// A chessboard on its plane z = 0: the first inner corner is the origin, x runs along the columns
/// of corners, y along the rows; a white border as wide as a square is around it.
struct BoardPattern {
  int columns = 20, rows = 10;  ///< inner corners
  double square_m = 0.1;

  void Check() const;
};

/// Takes pictures of a chessboard with one camera. Every pixel is the mean over its footprint on
/// the board, taken as a rectangle along the board's edges, so that these are where they belong to
/// a small part of a pixel.
class BoardRenderer {
 public:
  BoardRenderer(const DistortedCamera& camera, const BoardPattern& pattern);

  /// CV_32FC1 radiance, 1 is white.
  cv::Mat Trace(const Rigid3& camera_from_board, int num_threads = 1) const;
  /// The same as an 8 bit picture; `image_id` selects the noise.
  cv::Mat Render(const Rigid3& camera_from_board, const SensorOptions& sensor, uint32_t image_id,
                 int num_threads = 1) const;

 private:
  /// The mean tone about a point, over so much along the board's axes; in squares from the first
  /// inner corner.
  double Tone(const Eigen::Vector2d& at, const Eigen::Vector2d& width) const;

  DistortedCamera camera_;
  BoardPattern pattern_;
  std::vector<Eigen::Vector2d> rays_;  ///< normalised, of the pixels: [height+1 x width+1]
};

/// Two cameras as they are before calibration.
struct BoardRig {
  DistortedCamera left, right;
  Rigid3 right_from_left;

  /// Two cameras of 1624 x 1234 pixels 0.24 m apart with small faults of mounting, scaled to a
  /// width.
  static BoardRig Make(int width = 1624);
  double BaselineM() const { return right_from_left.translation.norm(); }
};

/// Seeded poses left_from_board, all of the board in sight of both cameras, in all parts of the
/// picture, 25 to 80 % of its width wide, tilted up to `max_tilt_deg` every way.
std::vector<Rigid3> DrawBoardPoses(const BoardRig& rig, const BoardPattern& pattern, int num_poses,
                                   double max_tilt_deg, int seed);

/// The truth as lines `key: value`.
std::string FormatTruth(const BoardRig& rig, const BoardPattern& pattern);

}  // namespace arfm_vo
