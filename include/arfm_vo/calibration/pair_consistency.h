#pragma once

#include <vector>

#include "arfm_vo/calibration/single_camera.h"
#include "arfm_vo/calibration/stereo_calibration.h"

namespace arfm_vo {

/// For each pair how far, in px rms, the right corners lie from where the left camera's board pose
/// and the one relative pose that suits most pairs put them. Shows boards that moved between the
/// cameras' exposures, pairs of different moments and mirrored cameras, all of which each camera
/// alone finds good.
std::vector<double> MeasureConsistency(const SingleCalibration& left,
                                       const SingleCalibration& right,
                                       const std::vector<CornerPair>& pairs,
                                       const Chessboard& board);

/// 1 for each error that stands out: above `factor` times the median and above `floor`. Of those
/// only the worse half is marked, for a gross one lifts its neighbours: to be called again.
std::vector<char> FindOutliers(const std::vector<double>& errors, double factor, double floor);

}  // namespace arfm_vo
