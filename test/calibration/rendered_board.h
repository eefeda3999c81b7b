#pragma once

#include <opencv2/calib3d.hpp>

#include "arfm_vo/calibration/corner_detection.h"
#include "arfm_vo/simulation/board_set.h"

namespace arfm_vo {

/// Where a camera at `camera_from_board` sees the corners: the truth without noise.
inline BoardCorners ProjectBoard(const SingleCamera& camera, const Chessboard& board,
                                 const Rigid3& camera_from_board) {
  const Eigen::Vector3d turn = LogSO3(camera_from_board.rotation);
  const Eigen::Vector3d& shift = camera_from_board.translation;
  BoardCorners corners;
  cv::projectPoints(board.Corners(), cv::Vec3d(turn.x(), turn.y(), turn.z()),
                    cv::Vec3d(shift.x(), shift.y(), shift.z()), camera.matrix, camera.distortion,
                    corners);
  return corners;
}

/// A picture of the board by one camera of a rig that blurs a little and has noise.
inline cv::Mat RenderBoard(const BoardRig& rig, const SingleCamera& camera, const Chessboard& board,
                           const Rigid3& camera_from_board, uint32_t image_id) {
  SensorOptions sensor;
  sensor.blur_px = 0.8;
  sensor.noise_grey_levels = 2;
  return BoardRenderer(camera, rig.image_size, board)
      .Render(camera_from_board, sensor, image_id, 2);
}

}  // namespace arfm_vo
