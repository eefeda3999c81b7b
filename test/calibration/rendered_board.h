#pragma once

#include "arfm_vo/calibration/corner_detection.h"
#include "arfm_vo/simulation/board_set.h"

namespace arfm_vo {

inline BoardPattern ToPattern(const Chessboard& board) {
  return {board.columns, board.rows, board.square_m};
}

/// Where a camera at `camera_from_board` sees the corners: the truth without noise.
inline BoardCorners ProjectBoard(const DistortedCamera& camera, const Chessboard& board,
                                 const Rigid3& camera_from_board) {
  BoardCorners corners;
  for (const cv::Point3f& corner : board.Corners()) {
    const Eigen::Vector3d x = camera_from_board * Eigen::Vector3d(corner.x, corner.y, corner.z);
    const Eigen::Vector2d pixel = camera.Project(x.head<2>() / x.z());
    corners.emplace_back(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
  }
  return corners;
}

/// A picture of the board by a camera that blurs a little and has noise.
inline cv::Mat RenderBoard(const DistortedCamera& camera, const Chessboard& board,
                           const Rigid3& camera_from_board, uint32_t image_id) {
  SensorOptions sensor;
  sensor.blur_px = 0.8;
  sensor.noise_grey_levels = 2;
  return BoardRenderer(camera, ToPattern(board)).Render(camera_from_board, sensor, image_id, 2);
}

}  // namespace arfm_vo
