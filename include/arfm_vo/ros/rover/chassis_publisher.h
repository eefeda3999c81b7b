#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <optional>
#include <string>

#include "arfm_vo/driving/track_odometry.h"
#include "arfm_vo/hardware/chassis_driver.h"

namespace arfm_vo {

/// Tells by topics what the chassis and its pilot do: drive_status (latched, at 5 Hz and at every
/// change), goal_report and motion_warning (latched), slip, chassis_state, battery and track_odom.
class ChassisPublisher {
 public:
  ChassisPublisher(ros::NodeHandle& node, const TrackKinematics& kinematics, std::string map_frame,
                   std::string base_frame);

  /// Publishes what is due at driving time `now_s`; to be called after each tick.
  void Publish(double now_s, ChassisDriver& driver);
  void PublishRefusal(const std::string& reason);

 private:
  void PublishStatus(double now_s, const PilotStatus& status);
  void PublishTracks(const ChassisReadings& readings);
  void PublishSlow(const PilotStatus& status, const ChassisLink& link);

  TrackKinematics kinematics_;
  TrackOdometry track_odometry_;
  TrackHistory tracks_{1.0};
  std::string map_frame_, base_frame_;
  std::optional<PilotStatus> last_status_;
  std::optional<bool> last_warning_;
  double status_due_s_ = 0, tracks_due_s_ = 0, slow_due_s_ = 0;
  ros::Publisher status_, report_, warning_, slip_, chassis_, battery_, track_odom_;
};

}  // namespace arfm_vo
