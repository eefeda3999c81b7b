#pragma once

#include <string>
#include <vector>

#include "arfm_vo/calibration/single_camera.h"
#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

struct StereoCalibrationOptions {
  int min_pairs = 5;  ///< fewer good pairs are an error
  DistortionModel model = DistortionModel::kPlumbBob;

  void Check() const;
};

/// The corners of one pair; `right` names the same physical corners in the same order as `left`.
struct CornerPair {
  std::string name;
  BoardCorners left, right;
};

struct LeftOutPair {
  std::string name, reason;
};

struct StereoCalibration {
  cv::Size image_size;
  SingleCamera left, right;
  IntrinsicsPrecision left_precision, right_precision;
  Rigid3 right_from_left;                 ///< m (unit of the board's square)
  double stereo_rms_px = 0;               ///< of all corners of both cameras
  double tilt_rad = 0;                    ///< largest angle between two views of the board
  std::vector<CornerPair> pairs;          ///< used
  std::vector<double> left_px, right_px;  ///< rms of each used pair in each camera
  std::vector<LeftOutPair> left_out;

  double BaselineM() const { return right_from_left.translation.norm(); }
};

/// Both intrinsics and the pose of the right camera from a moved board: each camera by Zhang's
/// method, then both together. Pairs that disagree with the others are found by their error against
/// the median, worst first, and left out. Throws CalibrationError where the pairs give no
/// calibration: too few, all views parallel, one camera mirrored, cameras swapped, no common
/// relative pose.
StereoCalibration CalibrateStereo(std::vector<CornerPair> pairs, const Chessboard& board,
                                  cv::Size image_size,
                                  const StereoCalibrationOptions& options = {});

}  // namespace arfm_vo
