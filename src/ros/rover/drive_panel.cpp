#include "arfm_vo/ros/rover/drive_panel.h"

#include <std_srvs/Trigger.h>

#include "arfm_vo/base/format.h"
#include "arfm_vo/ros/node/parameters.h"

namespace arfm_vo {
namespace {

using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::InteractiveMarkerFeedback;
using visualization_msgs::Marker;

constexpr double kHeight_m = 1.2;  ///< of the lower edge
constexpr double kTextHeight_m = 0.14, kButton_m = 0.3, kRow_m = 0.45;
/// chassis_node tells 5 times a second.
const ros::WallDuration kMaxSilence(2);
const char* const kName = "drive_panel";

Marker MakeMarker(int type, double y_m, double z_m, double size_m) {
  Marker marker;
  marker.type = type;
  marker.pose.position.y = y_m;
  marker.pose.position.z = z_m;
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = size_m;
  marker.color.r = marker.color.g = marker.color.b = marker.color.a = 1;
  return marker;
}

Marker MakeText(const std::string& text, double y_m, double z_m) {
  Marker marker = MakeMarker(Marker::TEXT_VIEW_FACING, y_m, z_m, kTextHeight_m);
  marker.text = text;
  return marker;
}

InteractiveMarkerControl MakeControl(const std::string& name) {
  InteractiveMarkerControl control;
  control.name = name;
  control.always_visible = true;
  control.orientation.w = 1;
  return control;
}

InteractiveMarkerControl MakeButton(const std::string& name, double y_m, double z_m, float red,
                                    float green) {
  InteractiveMarkerControl button = MakeControl(name);
  button.interaction_mode = InteractiveMarkerControl::BUTTON;
  button.markers = {MakeMarker(Marker::CUBE, y_m, z_m, kButton_m),
                    MakeText(name, y_m, z_m + kButton_m)};
  button.markers[0].color.r = red;
  button.markers[0].color.g = green;
  button.markers[0].color.b = 0.1f;
  return button;
}

}  // namespace

std::string Describe(const DriveStatus& status) {
  std::string text = status.state_text;
  if (status.reason != "none") text += ": " + status.reason;
  if (!status.has_goal) return text;
  return text + Format("\n%s, %.1f m to go", status.phase.c_str(), status.distance_to_goal_m);
}

DrivePanel::DrivePanel(ros::NodeHandle node, ros::NodeHandle private_node)
    : options_(ReadParameters<DrivePanelOptions>(private_node)), node_(node), server_(kName) {
  status_ = node_.subscribe("drive_status", 10, &DrivePanel::TakeStatus, this);
  Show(state_);
  timer_ = node_.createWallTimer(ros::WallDuration(0.5), [this](const ros::WallTimerEvent&) {
    if (heard_.isZero() || ros::WallTime::now() - heard_ < kMaxSilence) return;
    heard_ = {};
    Show("chassis_node is silent");
  });
}

void DrivePanel::TakeStatus(const DriveStatus& status) {
  heard_ = ros::WallTime::now();
  if (Describe(status) != state_) Show(Describe(status));
}

void DrivePanel::TakeClick(const InteractiveMarkerFeedback& feedback) {
  const std::string& name = feedback.control_name;
  if (name != "stop" && name != "start" && name != "home") return;
  // Persistent, as roscpp may close another connection before the answer is read (ros_comm #1976).
  ros::ServiceClient service = node_.serviceClient<std_srvs::Trigger>(
      "chassis_node/" + (name == "home" ? "drive_home" : name), /*persistent=*/true);
  std_srvs::Trigger call;
  const bool is_answered = service.call(call);
  answer_ = name + ": " +
            (is_answered ? call.response.message : "no answer from " + service.getService());
  ROS_INFO("%s", answer_.c_str());
  Show(state_);
}

visualization_msgs::InteractiveMarker DrivePanel::MakePanel() const {
  visualization_msgs::InteractiveMarker panel;
  panel.header.frame_id = options_.base_frame;
  panel.name = kName;
  panel.scale = 1;
  panel.pose.orientation.w = 1;
  InteractiveMarkerControl words = MakeControl("words");
  words.markers = {MakeText(state_ + "\n" + answer_, 0, kHeight_m + 2 * kRow_m)};
  panel.controls = {MakeButton("start", kRow_m, kHeight_m, 0.1f, 0.7f),
                    MakeButton("home", 0, kHeight_m, 0.9f, 0.7f),
                    MakeButton("stop", -kRow_m, kHeight_m, 0.9f, 0.1f), words};
  return panel;
}

void DrivePanel::Show(const std::string& state) {
  state_ = state;
  const auto take = [this](const visualization_msgs::InteractiveMarkerFeedbackConstPtr& feedback) {
    TakeClick(*feedback);
  };
  server_.insert(MakePanel(), take, InteractiveMarkerFeedback::BUTTON_CLICK);
  server_.applyChanges();
}

}  // namespace arfm_vo
