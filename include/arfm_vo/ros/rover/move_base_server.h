#pragma once

#include <actionlib/server/action_server.h>
#include <geometry_msgs/PoseStamped.h>
#include <move_base_msgs/MoveBaseAction.h>
#include <ros/callback_queue.h>

#include <functional>
#include <optional>
#include <string>

#include "arfm_vo/driving/pilot_status.h"

namespace arfm_vo {

/// Outlives the server that is called by it.
struct ActionQueue {
  ros::CallbackQueue queue_;
};

/// The action move_base: tells its clients what the pilot makes of their goals. One that comes by
/// move_base_simple/goal is a goal of the action too, as it is with the node move_base. The rover
/// has one goal, be it of a client or of another topic; a new one that is taken replaces it.
/// Whether a client still lives does not count. To be used by one thread.
class MoveBaseServer : private ActionQueue,
                       private actionlib::ActionServer<move_base_msgs::MoveBaseAction> {
 public:
  /// Drives to a goal, or says why not.
  using Drive = std::function<std::string(const geometry_msgs::PoseStamped&)>;

  /// A pose without a stamp gets that of its action's header. `cancel` drops the goal that is
  /// driven to.
  MoveBaseServer(ros::NodeHandle& node, Drive drive, std::function<void()> cancel);

  /// Takes what has come from clients since the last call, up to a bound: each tick.
  void Spin();
  /// What became of the goal that was driven to; it has ended for its client. Says whether the
  /// pilot keeps a client's goal that is blocked, and is to drop it.
  bool Tell(const GoalResult& result);
  /// Feedback: where the rover stands in the map.
  void Tell(const geometry_msgs::PoseStamped& base);

 private:
  void TakeClick(const geometry_msgs::PoseStamped& pose);
  void Take(GoalHandle goal);

  Drive drive_;
  std::optional<GoalHandle> driven_;
  ros::Subscriber clicks_;
};

}  // namespace arfm_vo
