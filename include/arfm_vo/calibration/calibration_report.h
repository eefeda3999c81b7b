#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "arfm_vo/calibration/image_pairs.h"
#include "arfm_vo/calibration/rectification.h"

namespace arfm_vo {

/// The report for people, Markdown: intrinsics with their precision, the rig, errors of each view,
/// row residual after rectification, coverage, pairs left out and why.
std::string FormatReport(const StereoCalibration& calibration, const Rectification& rectification,
                         const Chessboard& board);

/// The figures for programs, lines `key: value`: pairs_used, pairs_left_out, stereo_rms_px,
/// baseline_m, fx_left, fx_right, row_residual_median_px, row_residual_p95_px.
std::string FormatFigures(const StereoCalibration& calibration, const Rectification& rectification);

/// Writes everything into `folder`, made where it is not there: left.yaml, right.yaml, report.md,
/// corners_NAME.jpg of each used pair, rectified.jpg and coverage.png.
void WriteCalibration(const std::filesystem::path& folder, const std::vector<ImagePair>& files,
                      const StereoCalibration& calibration, const Rectification& rectification,
                      const Chessboard& board);

}  // namespace arfm_vo
