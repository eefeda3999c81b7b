#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <atomic>
#include <string>
#include <thread>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/worker.h"
#include "arfm_vo/hardware/clock_offset.h"
#include "arfm_vo/hardware/stereo_camera_device.h"
#include "arfm_vo/ros/node/health.h"
#include "arfm_vo/ros/rover/published_camera.h"

namespace arfm_vo {

struct StereoCameraNodeOptions {
  StereoCameraOptions camera;  ///< its keys stand beside those of the node
  std::string left_camera_info_url, right_camera_info_url;  ///< as camera_info_manager takes them
  std::string frame_id = "left_camera_optical";             ///< of both cameras' messages

  void Check() const;
  ARFM_FIELDS((camera), left_camera_info_url, right_camera_info_url, frame_id)
};

/// The camera in stereo_camera_node's diagnostics: ERROR while no pairs come, WARN where they come
/// seldom, many frames stay alone, or a device does not do as asked.
/// `before` is the status at the last report.
void ReportCamera(const StereoCameraStatus& status, const StereoCameraStatus& before,
                  const StereoCameraOptions& camera, Diagnostics& diagnostics);

/// The calibration of both cameras: WARN where there is none, ERROR where it has another size than
/// the pictures or a baseline that is none.
void ReportCalibration(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right,
                       int width, int height, Diagnostics& diagnostics);

/// Pairs of a stereo camera as left|right/image_raw and camera_info, both cameras with one stamp.
class StereoCameraNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter. A camera that is not there is no error:
  /// the node waits for it and says so in its diagnostics.
  StereoCameraNode(ros::NodeHandle node, ros::NodeHandle private_node,
                   VideoEnvironment environment = VideoEnvironment::Kernel());
  ~StereoCameraNode();

 private:
  void Run();
  void Publish(const FramePair& pair);
  void Report(Diagnostics& diagnostics);

  const StereoCameraNodeOptions options_;
  DriveListener drive_;
  PublishedCamera left_, right_;
  // Of the capturing thread:
  StereoCameraDevice camera_;
  ClockOffset clock_;
  ros::Time last_stamp_;
  int published_jumps_ = 0;
  std::string said_;  ///< the problem that was last logged
  Shared<StereoCameraStatus> status_;
  std::atomic<int> num_clock_jumps_{0};
  StereoCameraStatus reported_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

}  // namespace arfm_vo
