#pragma once

#include <arfm_vo/DriveStatus.h>
#include <interactive_markers/interactive_marker_server.h>
#include <ros/ros.h>
#include <visualization_msgs/InteractiveMarker.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>

#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"

namespace arfm_vo {

struct DrivePanelOptions {
  std::string base_frame = "base_link";  ///< the panel stands above its origin

  void Check() const { Require(!base_frame.empty(), "base_frame must not be empty"); }
  ARFM_FIELDS(base_frame)
};

/// What the rover does, in words.
std::string Describe(const DriveStatus& status);

/// A panel above the rover in rviz (display InteractiveMarkers, tool Interact): what the rover does
/// in words, and a button each to start it, to stop it and to drive it home.
class DrivePanel {
 public:
  /// Throws std::invalid_argument naming a wrong parameter.
  DrivePanel(ros::NodeHandle node, ros::NodeHandle private_node);

 private:
  void TakeStatus(const DriveStatus& status);
  void TakeClick(const visualization_msgs::InteractiveMarkerFeedback& feedback);
  void Show(const std::string& state);
  visualization_msgs::InteractiveMarker MakePanel() const;

  const DrivePanelOptions options_;
  std::string state_ = "no drive_status", answer_;
  ros::WallTime heard_;  // the last drive_status
  ros::NodeHandle node_;
  interactive_markers::InteractiveMarkerServer server_;
  ros::Subscriber status_;
  ros::WallTimer timer_;
};

}  // namespace arfm_vo
