#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <signal.h>
#include <std_msgs/Bool.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_listener.h>

#include "arfm_vo/ros/chassis_messages.h"
#include "arfm_vo/ros/chassis_node_options.h"
#include "arfm_vo/ros/chassis_publisher.h"
#include "arfm_vo/ros/driving_clock.h"
#include "arfm_vo/ros/goal_reader.h"
#include "arfm_vo/ros/parameters.h"
#include "arfm_vo/ros/rover_sight.h"

namespace arfm_vo {
namespace {

constexpr double kTick_s = 0.02;

/// Drives the chassis to goals by the pose that tf tells: goals and switches in, CAN frames out.
class ChassisNode {
 public:
  ChassisNode(ros::NodeHandle node, ros::NodeHandle private_node)
      : options_(ReadParameters<ChassisNodeOptions>(private_node)),
        listener_(buffer_),
        sight_(buffer_, options_.map_frame, options_.odom_frame, options_.base_frame),
        goal_reader_(buffer_, options_.map_frame),
        driver_(options_.pilot, OpenCanBus(options_.can, ChassisLink::Filters())),
        publisher_(node, TrackKinematics(options_.pilot.kinematics), options_.map_frame,
                   options_.base_frame) {
    updater_.setHardwareID("chassis on " + options_.can);
    updater_.add("driving", [this](diagnostic_updater::DiagnosticStatusWrapper& diagnostics) {
      FillDiagnostics(driver_.pilot().Status(), driver_.link(), diagnostics);
    });
    Listen(node);
    Serve(private_node);
    // In simulated time the clock itself sets the pace, and where it stands, the chassis stops.
    if (ros::Time::isSimTime())
      timer_ = node.createTimer(ros::Duration(kTick_s), [this](const auto&) { Tick(); });
    else
      steady_timer_ =
          node.createSteadyTimer(ros::WallDuration(kTick_s), [this](const auto&) { Tick(); });
  }

 private:
  void Listen(ros::NodeHandle& node) {
    const auto subscribe = [&](const char* topic, auto callback) {
      subscribers_.push_back(node.subscribe(topic, 10, callback, this));
    };
    subscribe("goal", &ChassisNode::TakeGoal);
    subscribe("waypoints", &ChassisNode::TakePath);
    subscribe("cmd_vel", &ChassisNode::TakeVelocity);
    subscribe("emergency_stop", &ChassisNode::TakeEmergencyStop);
    subscribe("odom", &ChassisNode::TakeOdometry);
  }

  void Serve(ros::NodeHandle& node) {
    const auto serve = [&](const char* name, std::function<Reply()> act) {
      using Trigger = std_srvs::Trigger;
      servers_.push_back(node.advertiseService<Trigger::Request, Trigger::Response>(
          name, [this, act](Trigger::Request&, Trigger::Response& response) {
            const Reply reply = act();
            Tick();
            response.success = reply.is_accepted;
            response.message = reply.text;
            return true;
          }));
    };
    Pilot& pilot = driver_.pilot();
    serve("start", [this, &pilot] { return pilot.Start(clock_.Now()); });
    serve("stop", [&pilot] { return pilot.Stop(), Reply{true, "stopped"}; });
    serve("cancel", [&pilot] { return pilot.CancelRoute(), Reply{true, "no goal"}; });
    serve("clear_errors", [this] { return driver_.link().SendClearErrors(), Reply{true, "sent"}; });
  }

  void Tick() {
    const double now_s = clock_.Now();
    Look(now_s);
    driver_.Tick(now_s);
    publisher_.Publish(now_s, driver_);
    updater_.update();
  }

  void Look(double now_s) {
    const auto sighting = sight_.Look();
    if (!sighting) return driver_.pilot().ObserveNoPose();
    const bool is_new = sighting->stamp != seen_;
    if (is_new) seen_s_ = clock_.At(sighting->stamp);
    seen_ = sighting->stamp;
    driver_.pilot().ObservePose(now_s, {seen_s_, sighting->map_from_base});
    if (is_new) driver_.pilot().ObserveOdometry(seen_s_, sighting->odom_from_base);
  }

  template <class Message>
  void TakeRoute(const Message& message) try {
    if constexpr (std::is_same_v<Message, nav_msgs::Path>)
      driver_.pilot().SetRoute(goal_reader_.Read(message));
    else
      driver_.pilot().SetRoute({goal_reader_.Read(message)});
    Tick();
  } catch (const std::invalid_argument& error) {
    ROS_WARN("%s", error.what());
    publisher_.PublishRefusal(error.what());
  }
  void TakeGoal(const geometry_msgs::PoseStamped& goal) { TakeRoute(goal); }
  void TakePath(const nav_msgs::Path& path) { TakeRoute(path); }

  void TakeVelocity(const geometry_msgs::Twist& twist) try {
    const Reply reply = driver_.pilot().SetVelocity(clock_.Now(), ReadVelocity(twist));
    if (!reply.is_accepted) ROS_WARN_THROTTLE(1, "%s", reply.text.c_str());
  } catch (const std::invalid_argument& error) {
    driver_.pilot().SetVelocity(clock_.Now(), {});
    ROS_WARN_THROTTLE(1, "%s", error.what());
  }

  void TakeEmergencyStop(const std_msgs::Bool& is_set) {
    driver_.pilot().SetEmergencyStop(is_set.data);
    Tick();
  }

  void TakeOdometry(const nav_msgs::Odometry& odometry) {
    driver_.pilot().ObserveUncertainty(ToUncertainty(odometry, clock_.At(odometry.header.stamp)));
  }

  const ChassisNodeOptions options_;
  DrivingClock clock_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  RoverSight sight_;
  GoalReader goal_reader_;
  ChassisDriver driver_;
  ChassisPublisher publisher_;
  ros::Time seen_;
  double seen_s_ = 0;
  diagnostic_updater::Updater updater_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> servers_;
  ros::Timer timer_;
  ros::SteadyTimer steady_timer_;
};

}  // namespace
}  // namespace arfm_vo

int main(int argc, char** argv) {
  ros::init(argc, argv, "chassis_node");
  for (const int signal : {SIGTERM, SIGHUP}) ::signal(signal, [](int) { ros::requestShutdown(); });
  try {
    arfm_vo::ChassisNode node({}, ros::NodeHandle("~"));
    ros::spin();  // the destructor leaves the rover standing
  } catch (const std::exception& error) {
    ROS_FATAL("chassis_node: %s", error.what());
    return 1;
  }
  return 0;
}
