#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "arfm_vo/calibration/single_camera.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/simulation/sensor.h"

namespace arfm_vo {

/// Takes pictures of a chessboard with one camera. A white border as wide as a square is around the
/// board. Every pixel is the mean over its footprint on the board, taken as a rectangle along the
/// board's edges, so that these are where they belong to a small part of a pixel.
class BoardRenderer {
 public:
  BoardRenderer(const SingleCamera& camera, cv::Size image_size, const Chessboard& board);

  /// CV_32FC1 radiance, 1 is white.
  cv::Mat Trace(const Rigid3& camera_from_board, int num_threads = 1) const;
  /// The same as an 8 bit picture; `image_id` selects the noise.
  cv::Mat Render(const Rigid3& camera_from_board, const SensorOptions& sensor, uint32_t image_id,
                 int num_threads = 1) const;

 private:
  /// The mean tone about a point, over so much along the board's axes; in squares from the first
  /// inner corner.
  double Tone(const Eigen::Vector2d& at, const Eigen::Vector2d& width) const;

  cv::Size image_size_;
  Chessboard board_;
  std::vector<cv::Point2d> rays_;  ///< normalised, of the pixels: [height+1 x width+1]
};

/// Two cameras as they are before calibration.
struct BoardRig {
  cv::Size image_size;
  SingleCamera left, right;
  Rigid3 right_from_left;

  /// Two cameras of 1624 x 1234 pixels 0.24 m apart with small faults of mounting, scaled to a
  /// width.
  static BoardRig Make(int width = 1624);
  double BaselineM() const { return right_from_left.translation.norm(); }
};

/// Seeded poses left_from_board, all of the board in sight of both cameras, in all parts of the
/// picture, 25 to 80 % of its width wide, tilted up to `max_tilt_deg` every way.
std::vector<Rigid3> DrawBoardPoses(const BoardRig& rig, const Chessboard& board, int num_poses,
                                   double max_tilt_deg, int seed);

/// The truth as lines `key: value`.
std::string FormatTruth(const BoardRig& rig, const Chessboard& board);

}  // namespace arfm_vo
