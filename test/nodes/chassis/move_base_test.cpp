#include <actionlib/client/simple_action_client.h>
#include <arfm_vo/MapStatus.h>
#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <move_base_msgs/MoveBaseAction.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>

#include <optional>
#include <string>
#include <vector>

#include "arfm_vo/driving/route.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "nodes/chassis/chassis_world.h"
#include "nodes/inbox.h"

// The action move_base of chassis_node, by actionlib's own client, and the way home.

namespace arfm_vo {
namespace {

using actionlib::SimpleClientGoalState;
using move_base_msgs::MoveBaseActionGoal;
using move_base_msgs::MoveBaseActionResult;
using move_base_msgs::MoveBaseFeedback;
using move_base_msgs::MoveBaseGoal;
using Client = actionlib::SimpleActionClient<move_base_msgs::MoveBaseAction>;

/// Ahead of the rover, without a stamp, as many clients send it.
MoveBaseGoal Ahead(double x_m) {
  MoveBaseGoal goal;
  goal.target_pose.header.frame_id = "base_link";
  goal.target_pose.pose.position.x = x_m;
  goal.target_pose.pose.orientation.w = 1;
  return goal;
}

class MoveBaseTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { world_ = new World; }
  static void TearDownTestSuite() { delete world_; }
  void SetUp() override {
    ASSERT_TRUE(world_->IsConnected());
    client_.emplace("move_base", false);
    ASSERT_TRUE(world_->RunUntil([this] {
      return client_->isServerConnected() && results_.has_publisher() && plans_.has_publisher();
    }));
  }
  void TearDown() override { world_->Call("stop"); }

  void Drive(const MoveBaseGoal& goal) {
    world_->Drive([&] {
      client_->sendGoal(goal, {}, {},
                        [this](const auto& feedback) { feedback_.push_back(*feedback); });
    });
  }
  static void ExpectEnd(const Client& client, const std::string& state, const std::string& text) {
    ASSERT_TRUE(world_->RunUntil([&] { return client.getState().isDone(); }));
    EXPECT_EQ(client.getState().toString(), state);
    EXPECT_NE(client.getState().getText().find(text), std::string::npos)
        << client.getState().getText();
  }
  static void ExpectToStandWithoutAGoal() {
    EXPECT_TRUE(
        world_->RunUntil([] { return world_->log_.last.IsZero() && !world_->status_.has_goal; }));
  }
  void ExpectPlan(size_t num_poses) {
    EXPECT_TRUE(world_->RunUntil([&] {
      return plans_.size() > 0 && plans_.last().poses.size() == num_poses;
    })) << num_poses;
  }

  static World* world_;
  Inbox<nav_msgs::Path> plans_{"plan"};
  Inbox<MoveBaseActionResult> results_{"move_base/result"};
  std::optional<Client> client_;
  std::vector<MoveBaseFeedback> feedback_;
};

World* MoveBaseTest::world_ = nullptr;

TEST_F(MoveBaseTest, AGoalInALongStandbyIsRejected) {
  world_->Run(11);
  client_->sendGoal(Ahead(1));
  ExpectEnd(*client_, "REJECTED", "the rover is in standby");
  EXPECT_EQ(world_->log_.num_commands, 0);
}

TEST_F(MoveBaseTest, WhatIsNoGoalIsRejectedWithTheReason) {
  ASSERT_TRUE(world_->Start());
  const ros::Time now = ros::Time::now();
  const struct {
    const char* frame;
    double x_m;
    ros::Time of_action, of_pose;
    const char* text;
  } rows[] = {{"base_link", 1, ros::Time(), ros::Time(), "it has no stamp"},
              {"base_link", 1, now - ros::Duration(30), ros::Time(), "s old, older than 5"},
              {"base_link", 1, now, now - ros::Duration(30), "s old, older than 5"},
              {"base_link", 1, now + ros::Duration(30), ros::Time(), "in the future"},
              {"base_link", 60, now, ros::Time(), "60.0 m away, farther than 50.0 m"},
              {"moon", 1, now, ros::Time(), "frame 'moon'"}};
  ros::Publisher publisher = ros::NodeHandle().advertise<MoveBaseActionGoal>("move_base/goal", 10);
  ASSERT_TRUE(world_->RunUntil([&] { return publisher.getNumSubscribers() > 0; }));
  for (const auto& [frame, x_m, of_action, of_pose, text] : rows) {
    MoveBaseActionGoal goal;
    goal.goal_id.id = std::string("raw ") + std::to_string(&text - &rows[0].text);
    goal.header.stamp = of_action;
    goal.goal = Ahead(x_m);
    goal.goal.target_pose.header.stamp = of_pose;
    goal.goal.target_pose.header.frame_id = frame;
    const int num_before = results_.size();
    publisher.publish(goal);
    ASSERT_TRUE(world_->RunUntil([&] { return results_.size() > num_before; })) << text;
    EXPECT_EQ(results_.last().status.goal_id.id, goal.goal_id.id);
    EXPECT_EQ(results_.last().status.status, actionlib_msgs::GoalStatus::REJECTED);
    EXPECT_NE(results_.last().status.text.find(text), std::string::npos)
        << results_.last().status.text;
  }
}

TEST_F(MoveBaseTest, ArrivesWithFeedbackAndAPlan) {
  Drive(Ahead(0.4));
  ExpectPlan(2);
  EXPECT_EQ(plans_.last().header.frame_id, "map");
  const double goal_x_m = plans_.last().poses.back().pose.position.x;
  ExpectEnd(*client_, "SUCCEEDED", "arrived");
  ExpectPlan(0);
  ASSERT_GT(feedback_.size(), 5u);
  EXPECT_EQ(feedback_.back().base_position.header.frame_id, "map");
  EXPECT_NEAR(feedback_.back().base_position.pose.position.x, goal_x_m, 0.05);
  EXPECT_NEAR(world_->chassis_.plant().Pose().x_m, goal_x_m, 0.05);
}

TEST_F(MoveBaseTest, ANewGoalReplacesTheOldOneOfWhoeverItIs) {
  Drive(Ahead(40));
  Client other("move_base", false);
  ASSERT_TRUE(world_->RunUntil([&] { return other.isServerConnected(); }));
  other.sendGoal(Ahead(30));
  ExpectEnd(*client_, "PREEMPTED", "replaced");
  ASSERT_TRUE(world_->RunUntil([&] { return other.getState().toString() == "ACTIVE"; }));
  ros::Publisher rviz =
      ros::NodeHandle().advertise<geometry_msgs::PoseStamped>("move_base_simple/goal", 1);
  ASSERT_TRUE(world_->RunUntil([&] { return rviz.getNumSubscribers() > 0; }));
  geometry_msgs::PoseStamped clicked = Ahead(20).target_pose;
  clicked.header.stamp = ros::Time::now();
  rviz.publish(clicked);
  ExpectEnd(other, "PREEMPTED", "replaced");
  EXPECT_TRUE(world_->RunUntil([] { return world_->status_.has_goal; }));
  ExpectPlan(2);
  other.cancelAllGoals();
  ExpectToStandWithoutAGoal();
}

TEST_F(MoveBaseTest, CancelStopsTheRover) {
  Drive(Ahead(40));
  client_->cancelGoal();
  ExpectEnd(*client_, "PREEMPTED", "cancelled");
  ExpectToStandWithoutAGoal();
  EXPECT_EQ(world_->status_.state, DriveStatus::READY);
}

TEST_F(MoveBaseTest, AFaultAbortsAndTheGoalIsNotDrivenToLater) {
  Drive(Ahead(40));
  world_->SetEmergencyStop(true);
  ExpectEnd(*client_, "ABORTED", "software emergency stop is set");
  ExpectToStandWithoutAGoal();
  world_->SetEmergencyStop(false);
  EXPECT_TRUE(world_->Start());
  EXPECT_TRUE(world_->RunUntil([] { return world_->status_.state == DriveStatus::READY; }));
}

TEST_F(MoveBaseTest, TheGoalOfAClientThatIsGoneIsDrivenToAndAnybodyCancelsIt) {
  Drive(Ahead(40));
  client_.reset();
  world_->Run(2);
  EXPECT_GT(world_->log_.last.forward_mps, 0.09);
  Client other("move_base", false);
  ASSERT_TRUE(world_->RunUntil([&] { return other.isServerConnected(); }));
  other.cancelAllGoals();
  ExpectToStandWithoutAGoal();
}

TEST_F(MoveBaseTest, TheWayHomeIsDrivenByTheServiceOnceTheRoverIsFoundInTheMap) {
  ASSERT_TRUE(world_->Start());
  EXPECT_EQ(world_->Call("drive_home").message, "way home: ba_node tells no path_optimized");
  ros::NodeHandle node;
  const auto paths = node.advertise<nav_msgs::Path>("path_optimized", 1, true);
  const auto statuses = node.advertise<MapStatus>("map_status", 1, true);
  const auto stands = [] {
    return ProjectToPlane(world_->odom_from_world_ * world_->chassis_.plant().WorldFromBase());
  };
  const RoverPose start = stands();
  nav_msgs::Path path;
  path.header.frame_id = "map";
  for (const double way_m : {0.6, 0.3, 0.})
    path.poses.emplace_back().pose = ToPoseMessage(LiftFromPlane(Advance(start, way_m, 0)));
  paths.publish(path);
  const auto says = [](const std::string& text) {
    return world_->Call("drive_home").message.find(text) != std::string::npos;
  };
  MapStatus status;
  status.state = MapStatus::LOCALISING;
  statuses.publish(status);
  EXPECT_TRUE(world_->RunUntil([&] { return says("LOCALISING"); }));
  status.state = MapStatus::LOCALISED;
  statuses.publish(status);
  world_->reports_.clear();
  EXPECT_TRUE(world_->RunUntil([&] { return says("drives home"); }));
  EXPECT_TRUE(world_->RunUntil(
      [] { return !world_->reports_.empty() && world_->reports_.back().text == "arrived"; }));
  EXPECT_LT(Distance(stands(), Advance(start, 0.6, 0)), 0.06);
}

}  // namespace
}  // namespace arfm_vo
