#include "arfm_vo/ros/rover/move_base_server.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <utility>

#include "arfm_vo/ros/rover/chassis_publisher.h"

namespace arfm_vo {
namespace {

ros::NodeHandle CalledBy(ros::CallbackQueue& queue, ros::NodeHandle node) {
  node.setCallbackQueue(&queue);
  return node;
}

}  // namespace

MoveBaseServer::MoveBaseServer(ros::NodeHandle& node, Drive drive, std::function<void()> cancel)
    : ActionServer(CalledBy(queue_, node), "move_base", false),
      drive_(std::move(drive)),
      clicks_(CalledBy(queue_, node)
                  .subscribe("move_base_simple/goal", 10, &MoveBaseServer::TakeClick, this)) {
  registerGoalCallback([this](GoalHandle goal) { Take(std::move(goal)); });
  registerCancelCallback([this, cancel = std::move(cancel)](const GoalHandle& goal) {
    if (driven_ && goal == *driven_) cancel();
  });
  start();
}

void MoveBaseServer::Spin() {
  constexpr int kMaxCalls = 10;
  for (int i = 0; i < kMaxCalls; ++i) {
    if (queue_.callOne(ros::WallDuration()) != ros::CallbackQueue::Called) return;
    // actionlib takes stamps as they come: adding to the largest throws, out of whatever is next.
    const ros::Time now = ros::Time::now();
    for (auto& goal : status_list_)
      goal.handle_destruction_time_ = std::min(goal.handle_destruction_time_, now);
    last_cancel_ = std::min(last_cancel_, now);
  }
}

void MoveBaseServer::TakeClick(const geometry_msgs::PoseStamped& pose) {
  const auto asked = boost::make_shared<move_base_msgs::MoveBaseActionGoal>();
  asked->header = pose.header;
  asked->goal.target_pose = pose;
  goalCallback(asked);
}

void MoveBaseServer::Take(GoalHandle goal) {
  // A handle hides the action's header, and fills a stamp that is missing with the time of arrival.
  const move_base_msgs::MoveBaseActionGoal& asked = *status_list_.back().goal_;
  geometry_msgs::PoseStamped pose = asked.goal.target_pose;
  if (pose.header.stamp.isZero()) pose.header.stamp = asked.header.stamp;
  const std::string flaw = drive_(pose);
  if (!flaw.empty()) return goal.setRejected(Result(), flaw);
  goal.setAccepted();
  driven_ = std::move(goal);
}

bool MoveBaseServer::Tell(const GoalResult& result) {
  if (!driven_) return false;
  GoalHandle goal = *std::exchange(driven_, std::nullopt);
  const std::string text = ToMessage(result).text;
  const bool is_by_hand =
      result.reason == StopReason::kNone || result.reason == StopReason::kStopped;
  if (result.outcome == GoalOutcome::kArrived) {
    goal.setSucceeded(Result(), text);
  } else if (result.outcome == GoalOutcome::kBlocked || !is_by_hand) {
    goal.setAborted(Result(), text);
  } else {
    goal.setCanceled(Result(), text);
  }
  return result.outcome == GoalOutcome::kBlocked;
}

void MoveBaseServer::Tell(const geometry_msgs::PoseStamped& base) {
  if (!driven_) return;
  Feedback feedback;
  feedback.base_position = base;
  driven_->publishFeedback(feedback);
}

}  // namespace arfm_vo
