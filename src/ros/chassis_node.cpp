#include "arfm_vo/ros/chassis_node.h"

#include <std_srvs/Trigger.h>

#include <utility>

#include "arfm_vo/ros/chassis_messages.h"
#include "arfm_vo/ros/parameters.h"

namespace arfm_vo {
namespace {

constexpr double kTick_s = 0.02;

}  // namespace

ChassisNode::ChassisNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : options_(ReadParameters<ChassisNodeOptions>(private_node)),
      listener_(buffer_),
      sight_(buffer_, options_.map_frame, options_.odom_frame, options_.base_frame),
      goal_reader_(buffer_, options_.map_frame),
      driver_(options_.pilot, OpenCanBus(options_.can, ChassisLink::Filters())),
      publisher_(node, TrackKinematics(options_.pilot.kinematics), options_.map_frame,
                 options_.base_frame),
      updater_(node, private_node) {
  updater_.setHardwareID("chassis on " + options_.can);
  updater_.add("driving", [this](diagnostic_updater::DiagnosticStatusWrapper& diagnostics) {
    FillDiagnostics(driver_.pilot().Status(), driver_.link(), diagnostics);
  });
  Listen(node);
  Serve(private_node);
  SetPace(node);
}

void ChassisNode::Listen(ros::NodeHandle& node) {
  const auto subscribe = [&](const char* topic, auto callback) {
    subscribers_.push_back(node.subscribe(topic, 10, callback, this));
  };
  subscribe("goal", &ChassisNode::TakeGoal);
  subscribe("waypoints", &ChassisNode::TakePath);
  subscribe("cmd_vel", &ChassisNode::TakeVelocity);
  subscribe("emergency_stop", &ChassisNode::TakeEmergencyStop);
  subscribe("odom", &ChassisNode::TakeOdometry);
}

void ChassisNode::Serve(ros::NodeHandle& private_node) {
  const auto serve = [&](const char* name, std::function<Reply()> act) {
    using Trigger = std_srvs::Trigger;
    const auto answer = [this, act](Trigger::Request&, Trigger::Response& response) {
      const Reply reply = act();
      Tick();
      response.success = reply.is_accepted;
      response.message = reply.text;
      return true;
    };
    servers_.push_back(private_node.advertiseService<Trigger::Request, Trigger::Response>(
        name, boost::function<bool(Trigger::Request&, Trigger::Response&)>(answer)));
  };
  Pilot& pilot = driver_.pilot();
  serve("start", [this, &pilot] { return pilot.Start(clock_.Now()); });
  serve("stop", [&pilot] { return pilot.Stop(), Reply{true, "stopped"}; });
  serve("cancel", [&pilot] { return pilot.CancelRoute(), Reply{true, "no goal"}; });
  serve("clear_errors", [this] { return driver_.link().SendClearErrors(), Reply{true, "sent"}; });
}

void ChassisNode::SetPace(ros::NodeHandle& node) {
  // Simulated time may run faster or slower than the wall's: then it sets the pace, and the wall
  // only watches that it goes on.
  const bool is_simulated = ros::Time::isSimTime();
  if (is_simulated)
    timer_ = node.createTimer(ros::Duration(kTick_s), [this](const ros::TimerEvent&) { Tick(); });
  steady_timer_ = node.createSteadyTimer(ros::WallDuration(is_simulated ? 0.1 : kTick_s),
                                         [this](const ros::SteadyTimerEvent&) { Tick(); });
}

void ChassisNode::Tick() {
  const double now_s = clock_.Now();
  if (now_s > last_tick_s_) clock_moved_ = ros::WallTime::now();
  last_tick_s_ = now_s;
  Look(now_s);
  driver_.Tick(now_s);
  publisher_.Publish(now_s, driver_);
  updater_.update();
}

void ChassisNode::Look(double now_s) {
  const bool is_clock_stalled =
      (ros::WallTime::now() - clock_moved_).toSec() > options_.max_clock_stall_s;
  const auto sighting = sight_.Look();
  if (!sighting || is_clock_stalled) return driver_.pilot().ObserveNoPose();
  const bool is_new = sighting->stamp != seen_;
  if (is_new) seen_s_ = clock_.At(sighting->stamp);
  seen_ = sighting->stamp;
  driver_.pilot().ObservePose(now_s, {seen_s_, sighting->map_from_base});
  if (is_new) driver_.pilot().ObserveOdometry(seen_s_, sighting->odom_from_base);
}

template <class Message>
void ChassisNode::TakeRoute(const Message& message) {
  try {
    if constexpr (std::is_same_v<Message, nav_msgs::Path>) {
      driver_.pilot().SetRoute(goal_reader_.Read(message));
    } else {
      driver_.pilot().SetRoute({goal_reader_.Read(message)});
    }
    Tick();
  } catch (const std::invalid_argument& error) {
    ROS_WARN("%s", error.what());
    publisher_.PublishRefusal(error.what());
  }
}

void ChassisNode::TakeVelocity(const geometry_msgs::Twist& twist) {
  PlanarMotion motion;
  try {
    motion = ReadVelocity(twist);
  } catch (const std::invalid_argument& error) {
    ROS_WARN_THROTTLE(1, "%s", error.what());
  }
  const Reply reply = driver_.pilot().SetVelocity(clock_.Now(), motion);
  if (!reply.is_accepted) ROS_WARN_THROTTLE(1, "%s", reply.text.c_str());
}

void ChassisNode::TakeEmergencyStop(const std_msgs::Bool& is_set) {
  driver_.pilot().SetEmergencyStop(is_set.data);
  Tick();
}

void ChassisNode::TakeOdometry(const nav_msgs::Odometry& odometry) {
  driver_.pilot().ObserveUncertainty(ToUncertainty(odometry, clock_.At(odometry.header.stamp)));
}

}  // namespace arfm_vo
