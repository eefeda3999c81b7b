#pragma once

#include <filesystem>
#include <string>

#include "arfm_vo/calibration/rectification.h"

namespace arfm_vo {

/// One eye's calibration as the YAML text that camera_calibration_parsers reads.
std::string FormatCameraInfo(const std::string& camera_name, cv::Size image_size, const Eye& eye,
                             const cv::Matx33d& rectification, const cv::Matx34d& projection);

/// Writes left.yaml and right.yaml to `folder`; std::system_error naming the file that fails.
void WriteCameraInfos(const std::filesystem::path& folder, const StereoCalibration& calibration,
                      const Rectification& rectification);

}  // namespace arfm_vo
