#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "arfm_vo/calibration/stereo_calibration.h"
#include "arfm_vo/geometry/stereo_camera.h"

namespace arfm_vo {

/// How a camera is turned, as camera_info has it.
struct RectifiedCamera {
  cv::Matx33d rotation;    ///< R, rectified from camera
  cv::Matx34d projection;  ///< P, of the right camera [0, 3] = -fx * baseline, px m
};

/// Turns both cameras so that rows agree.
struct Rectification {
  RectifiedCamera left, right;

  StereoCamera Camera(cv::Size image_size) const;
};

/// `alpha` 0: only valid pixels are in the rectified image; 1: every pixel of the original is.
Rectification Rectify(const StereoCalibration& calibration, double alpha = 0);

/// |v_left - v_right| in px of each corner of the used pairs after rectification, sorted.
std::vector<double> MeasureRowResiduals(const StereoCalibration& calibration,
                                        const Rectification& rectification);

/// A rectified image of the camera, bilinear.
cv::Mat RectifyImage(const cv::Mat& image, const SingleCamera& camera,
                     const RectifiedCamera& rectified);

/// One camera's calibration as the YAML text that camera_calibration_parsers reads.
std::string FormatCameraInfo(const std::string& camera_name, cv::Size image_size,
                             const SingleCamera& camera, const RectifiedCamera& rectified);

/// Writes left.yaml and right.yaml to `folder`; std::system_error naming the file that fails.
void WriteCameraInfos(const std::filesystem::path& folder, const StereoCalibration& calibration,
                      const Rectification& rectification);

}  // namespace arfm_vo
