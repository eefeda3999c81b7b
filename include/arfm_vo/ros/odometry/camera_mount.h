#pragma once

#include <ros/time.h>
#include <std_msgs/Header.h>
#include <tf2/buffer_core.h>

#include <optional>
#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"
#include "arfm_vo/evaluation/trajectory_output.h"
#include "arfm_vo/odometry/session.h"

namespace arfm_vo {

/// Where a camera on a head that moves sits on the rover, and whether it can be trusted.
struct CameraMountOptions {
  std::string base_frame = "base_link";  ///< frame whose pose is told
  std::string camera_frame;              ///< left optical frame; empty: the frame_id of the images
  double tf_timeout_s = 0.1;  ///< how long a pair waits for the tf of its stamp (wall time)
  double max_slew_dps = 0;    ///< pairs taken while the head turns faster are skipped; 0: none

  void Check() const {
    Require(!base_frame.empty(), "base_frame must not be empty");
    Require(tf_timeout_s >= 0, "tf_timeout_s must not be negative");
    Require(max_slew_dps >= 0, "max_slew_dps must not be negative");
  }
  ARFM_FIELDS(base_frame, camera_frame, tf_timeout_s, max_slew_dps)
};

/// base_from_camera at each image's stamp, from tf.
class CameraMount {
 public:
  /// `buffer` must outlive the mount.
  CameraMount(const tf2::BufferCore& buffer, const CameraMountOptions& options);

  /// base_from_camera at `stamp`. Throws std::invalid_argument with tf's words where tf cannot tell
  /// within the timeout. Never the newest one instead, never identity.
  Rigid3 BaseFromCamera(const std::string& image_frame, const ros::Time& stamp) const;

  /// Whether the head turned faster than the limit in the window before `stamp`. Where tf does not
  /// reach back so far, it did not.
  bool IsSlewing(const std::string& image_frame, const ros::Time& stamp,
                 const Rigid3& base_from_camera) const;

  /// Gives `session` a pair, whose left image has `header`, with the camera where tf says it was at
  /// that stamp. Skipped where tf cannot tell or the head was slewing. Where the camera sat goes to
  /// `log`.
  SessionUpdate Process(const FrameOnRequest& frame, const StereoCamera& camera,
                        const StereoImages& images, const std_msgs::Header& header,
                        Session& session, MountLog& log) const;

 private:
  Rigid3 LookUp(const std::string& image_frame, const ros::Time& stamp) const;

  const tf2::BufferCore& buffer_;
  CameraMountOptions options_;
};

}  // namespace arfm_vo
