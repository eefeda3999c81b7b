#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <image_transport/image_transport.h>
#include <ros/ros.h>

#include <atomic>
#include <mutex>
#include <string>
#include <thread>

#include "arfm_vo/hardware/clock_offset.h"
#include "arfm_vo/hardware/stereo_camera_device.h"
#include "arfm_vo/ros/rover/camera_health.h"
#include "arfm_vo/ros/rover/camera_info_server.h"
#include "arfm_vo/ros/rover/drive_listener.h"

namespace arfm_vo {

struct StereoCameraNodeOptions {
  StereoCameraOptions camera;  ///< its keys stand beside those of the node
  std::string left_camera_info_url, right_camera_info_url;  ///< as camera_info_manager takes them
  std::string frame_id = "left_camera_optical";             ///< of both eyes' messages
  CameraHealthOptions health;

  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    camera.VisitFields(visit);
    visit("left_camera_info_url", left_camera_info_url);
    visit("right_camera_info_url", right_camera_info_url);
    visit("frame_id", frame_id);
    visit("health", health);
  }
};

/// Pairs of a stereo camera as left|right/image_raw and camera_info, both eyes with one stamp.
class StereoCameraNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter. A camera that is not there is no error:
  /// the node waits for it and says so in its diagnostics.
  StereoCameraNode(ros::NodeHandle node, ros::NodeHandle private_node,
                   VideoEnvironment environment = VideoEnvironment::Kernel());
  ~StereoCameraNode();

 private:
  /// The topics of one eye and its set_camera_info, which is refused while the rover drives.
  class Eye {
   public:
    Eye(const ros::NodeHandle& node, const std::string& name, const std::string& url,
        const DriveListener& drive);
    /// With the calibration, or an empty one where it is not for pictures of this size.
    void Publish(const VideoFrame& frame, const std_msgs::Header& header);
    /// The calibration, whatever its size; K[0] is 0 where there is none.
    sensor_msgs::CameraInfo Loaded() { return calibration_.Get(); }

   private:
    sensor_msgs::CameraInfo Fitting(int width, int height);

    ros::NodeHandle node_;
    CameraInfoServer calibration_;
    image_transport::ImageTransport transport_;
    image_transport::CameraPublisher publisher_;
  };

  void Run();
  void Publish(const FramePair& pair);
  void Report(diagnostic_updater::DiagnosticStatusWrapper& diagnostics);
  void ReportCalibration(diagnostic_updater::DiagnosticStatusWrapper& diagnostics);

  const StereoCameraNodeOptions options_;
  DriveListener drive_;
  Eye left_, right_;
  // Of the capturing thread:
  StereoCameraDevice camera_;
  ClockOffset clock_;
  ros::Time last_stamp_;
  int published_jumps_ = 0;
  std::string said_;  ///< the problem that was last logged
  std::mutex mutex_;  ///< guards the two that follow
  StereoCameraStatus status_;
  int num_clock_jumps_ = 0;
  StereoCameraStatus reported_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

}  // namespace arfm_vo
