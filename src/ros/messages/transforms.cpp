#include "arfm_vo/ros/messages/transforms.h"

#include <tf2/buffer_core.h>
#include <tf2/exceptions.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "arfm_vo/base/check.h"
#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {

void CameraMountOptions::Check() const {
  Require(!base_frame.empty(), "base_frame must not be empty");
  Require(tf_timeout_s >= 0, "tf_timeout_s must not be negative");
  Require(max_slew_dps >= 0, "max_slew_dps must not be negative");
  Require(slew_window_s > 0, "slew_window_s must be positive");
}

CameraMount::CameraMount(const tf2::BufferCore& buffer, const CameraMountOptions& options)
    : buffer_(buffer), options_(options) {
  options.Check();
}

const std::string& CameraMount::CameraFrame(const std::string& image_frame) const {
  return options_.camera_frame.empty() ? image_frame : options_.camera_frame;
}

std::optional<Rigid3> CameraMount::LookUp(const std::string& camera_frame,
                                          const ros::Time& stamp) const {
  const std::string name = "tf " + options_.base_frame + " <- " + camera_frame;
  try {
    const geometry_msgs::TransformStamped transform =
        buffer_.lookupTransform(options_.base_frame, camera_frame, stamp);
    return FromMessage(transform.transform, name);
  } catch (const tf2::TransformException& error) {
    error_ = name + ": " + error.what();
  } catch (const std::invalid_argument& error) {
    error_ = error.what();
  }
  return std::nullopt;
}

std::optional<Rigid3> CameraMount::BaseFromCamera(const std::string& image_frame,
                                                  const ros::Time& stamp) const {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::duration<double>(options_.tf_timeout_s);
  while (true) {
    if (const auto base_from_camera = LookUp(CameraFrame(image_frame), stamp))
      return base_from_camera;
    if (Clock::now() >= deadline) return std::nullopt;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

bool CameraMount::IsSlewing(const std::string& image_frame, const ros::Time& stamp,
                            const Rigid3& base_from_camera) const {
  if (options_.max_slew_dps == 0 || stamp.toSec() < options_.slew_window_s) return false;
  const auto base_from_before =
      LookUp(CameraFrame(image_frame), stamp - ros::Duration(options_.slew_window_s));
  if (!base_from_before) return false;
  const double turn_deg = (base_from_before->Inverse() * base_from_camera).Angle() * 180 / M_PI;
  return turn_deg > options_.max_slew_dps * options_.slew_window_s;
}

}  // namespace arfm_vo
