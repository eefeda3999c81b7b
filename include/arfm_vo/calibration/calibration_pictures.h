#pragma once

#include "arfm_vo/calibration/chessboard.h"
#include "arfm_vo/calibration/rectification.h"

namespace arfm_vo {

/// Both images of a pair side by side with their corners and the board's order (the paper's
/// Fig. 12), BGR.
cv::Mat DrawCorners(const cv::Mat& left, const cv::Mat& right, const CornerPair& pair,
                    const Chessboard& board);

/// The pair rectified, side by side, with level lines across both (Fig. 13), BGR.
cv::Mat DrawRectified(const cv::Mat& left, const cv::Mat& right,
                      const StereoCalibration& calibration, const Rectification& rectification);

/// All corners of all used pairs as dots over an empty image of each eye, side by side, BGR.
cv::Mat DrawCoverage(const StereoCalibration& calibration);

}  // namespace arfm_vo
