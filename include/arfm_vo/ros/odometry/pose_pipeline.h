#pragma once

#include <arfm_vo/MapUpdateStamped.h>
#include <arfm_vo/StereoFrameStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/Image.h>

#include <exception>
#include <memory>
#include <string>

namespace diagnostic_updater {
class DiagnosticStatusWrapper;
}
namespace ros {
class NodeHandle;
}
namespace tf2 {
class BufferCore;
}

namespace arfm_vo {

/// What pose_node does with what comes in: the session, its trajectory, what is published and told.
/// Of the worker's thread. An interface, so that what subscribes is compiled without the odometry.
class PosePipeline {
 public:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  virtual ~PosePipeline() = default;

  /// Returns whether tf told where the camera sits.
  virtual bool Process(const StereoFrameStamped& frame, const sensor_msgs::ImageConstPtr& left,
                       const sensor_msgs::ImageConstPtr& right) = 0;
  virtual void Apply(const MapUpdateStamped& update) = 0;
  virtual void AddTrack(const nav_msgs::Odometry& odometry) = 0;
  virtual void CountRefused(const std::exception& error) = 0;
  virtual void StartEpoch() = 0;
  /// Returns what was written, in words.
  virtual std::string SaveTrajectory() = 0;

  virtual void ReportOdometry(Status& status) = 0;
  virtual void ReportCalibration(Status& status) = 0;
  virtual void ReportScale(Status& status) const = 0;

  // Of any thread:
  virtual int max_waiting_pairs() const = 0;
  virtual int max_held_pairs() const = 0;
  virtual bool saves_at_end() const = 0;
};

/// Reads PoseNodeOptions; throws std::invalid_argument naming a wrong parameter. `buffer` must
/// outlive it.
std::unique_ptr<PosePipeline> MakePosePipeline(const ros::NodeHandle& node,
                                               const ros::NodeHandle& private_node,
                                               const tf2::BufferCore& buffer);

}  // namespace arfm_vo
