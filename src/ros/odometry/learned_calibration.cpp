#include "arfm_vo/ros/odometry/learned_calibration.h"

#include <ros/console.h>

#include <cstdlib>
#include <filesystem>

#include "arfm_vo/configuration/learned_correction_file.h"

namespace arfm_vo {
namespace {

std::filesystem::path FindRosHome() {
  if (const char* home = std::getenv("ROS_HOME")) return home;
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home ? home : ".") / ".ros";
}

}  // namespace

std::string LearnedCalibration::Path() const {
  return FindRosHome() / "arfm_vo" / NameLearnedCorrection(*camera_);
}

std::optional<CorrectionBelief> LearnedCalibration::ReadFor(const StereoCamera& camera) {
  if (!is_on_ || (camera_ && *camera_ == camera)) return std::nullopt;
  camera_ = camera;
  try {
    const auto correction = ReadLearnedCorrection(Path(), camera);
    if (!correction) return std::nullopt;
    written_ = *correction;
    ROS_INFO("what earlier drives told of the rectification is read from %s (known to %.2f px)",
             Path().c_str(), correction->MaxColumnSigma(camera));
    return correction;
  } catch (const std::exception& error) {
    ROS_WARN("learned calibration is not read: %s", error.what());
    return std::nullopt;
  }
}

void LearnedCalibration::Write(const CorrectionBelief& correction) {
  if (!is_on_ || !camera_ || correction == written_) return;
  try {
    WriteLearnedCorrection(Path(), *camera_, correction);
    written_ = correction;
  } catch (const std::exception& error) {
    ROS_WARN_THROTTLE(60, "learned calibration is not kept: %s", error.what());
  }
}

}  // namespace arfm_vo
