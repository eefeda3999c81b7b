#include <console_bridge/console.h>

#include <cmath>

#include "arfm_vo/driving/pilot.h"
#include "arfm_vo/odometry/placed_map.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "arfm_vo/ros/rover/chassis_inputs.h"
#include "arfm_vo/ros/rover/pan_tilt_node.h"
#include "fuzz/fuzz_targets.h"
#include "fuzz/message_editor.h"
#include "fuzz/promise.h"
#include "ros/valid_messages.h"

namespace arfm_vo {
namespace {

void ImportKeyframe(const std::string& input) {
  ByteSource bytes(input);
  PlacedMap map{GlobalMapOptions()};
  for (int i = 0; i < 3 && !bytes.IsEmpty(); ++i) {
    KeyframeStamped message = ValidKeyframe();
    message.id += i;
    EditSometimes(bytes, message);
    Takes([&] { map.Add(FromMessage(message)); });
  }
  Promise(map.map_from_odom().IsFinite(), "the map stands somewhere");
}

void ImportMapUpdate(const std::string& input) {
  ByteSource bytes(input);
  MapUpdateStamped message = ValidUpdate();
  EditSometimes(bytes, message);
  Takes([&] {
    const MapUpdate update = FromMessage(message);
    for (const auto& [id, pose] : update.keyframes)
      Promise(pose.IsFinite(), "keyframes are somewhere");
    for (const auto& [id, x] : update.landmarks) Promise(x.allFinite(), "landmarks are somewhere");
  });
}

void ImportHeadGoal(const std::string& input) {
  ByteSource bytes(input);
  sensor_msgs::JointState message = ValidHeadGoal();
  EditSometimes(bytes, message);
  Takes([&] {
    const PanTiltGoal goal = ReadGoal(message, PanTiltNodeOptions());
    Promise(goal.pan_rad || goal.tilt_rad, "a goal moves the head");
    for (const auto& angle : {goal.pan_rad, goal.tilt_rad})
      Promise(!angle || std::isfinite(*angle), "angles are finite");
  });
}

void ImportStatedPose(const std::string& input) {
  ByteSource bytes(input);
  geometry_msgs::PoseWithCovarianceStamped message = ValidStatedPose();
  EditSometimes(bytes, message);
  Takes([&] {
    Promise(FindMapShift(message, "map", Rigid3()).IsFinite(), "the map is moved somewhere");
  });
}

/// What chassis_node and pose_node make of tf and of an odometry.
void ImportSight(const std::string& input) {
  console_bridge::noOutputHandler();  // tf2 tells of each
  ByteSource bytes(input);
  tf2::BufferCore buffer;
  const RoverSight sight{buffer, "map", "odom", "base_link"};
  Pilot pilot{PilotOptions()};
  for (double now_s = 100; !bytes.IsEmpty(); now_s += 0.1) {
    for (geometry_msgs::TransformStamped transform : ValidTransforms(ros::Time(now_s)).transforms) {
      EditSometimes(bytes, transform);
      AddTransform(transform, bytes.Byte() % 8 == 0, ros::Time(now_s), "fuzz", buffer);
    }
    if (const auto seen = sight.Look())
      pilot.ObservePose(now_s, {now_s, seen->odom_from_base, seen->map_from_odom});
    nav_msgs::Odometry odometry = ValidOdometry(ros::Time(now_s));
    EditSometimes(bytes, odometry);
    const double stamp_s = odometry.header.stamp.toSec();
    pilot.ObserveUncertainty(now_s, ToUncertainty(odometry, stamp_s));
    pilot.ObserveEpoch(bytes.Byte() / 64, stamp_s);
    Promise(pilot.Tick(now_s).chassis_motion.IsZero(), "a rover that was not started stands");
    const double distance_m = pilot.Status().distance_to_goal_m;
    Promise(std::isfinite(distance_m), "what is told is finite");
  }
}

}  // namespace

std::vector<FuzzTarget> ImportTargets() {
  return {{"keyframe", ImportKeyframe},
          {"map_update", ImportMapUpdate},
          {"head_goal", ImportHeadGoal},
          {"stated_pose", ImportStatedPose},
          {"sight", ImportSight}};
}

}  // namespace arfm_vo
