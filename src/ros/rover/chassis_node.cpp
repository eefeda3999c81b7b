#include "arfm_vo/ros/rover/chassis_node.h"

#include <std_srvs/Trigger.h>
#include <unistd.h>

#include <utility>

#include "arfm_vo/ros/node/parameters.h"
#include "arfm_vo/ros/node/services.h"

namespace arfm_vo {
namespace {

constexpr double kTick_s = 0.02;

std::string HostName() {
  char name[65] = {};
  return ::gethostname(name, sizeof(name) - 1) == 0 ? name : "";
}

ChassisNodeOptions ReadOptions(const ros::NodeHandle& private_node) {
  auto options = ReadParameters<ChassisNodeOptions>(private_node);
  std::string& rover = options.pilot.operator_watch.rover;
  if (rover.empty()) rover = HostName();
  Require(!ros::Time::isSimTime() || IsSimulatedBus(options.can),
          "use_sim_time is set, but can '" + options.can +
              "' is a real bus: simulated time is for udp:.. and vcan.. only");
  return options;
}

}  // namespace

ChassisNode::ChassisNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : options_(ReadOptions(private_node)),
      lock_(std::in_place, options_.can),
      transforms_(node, buffer_),
      sight_{buffer_, options_.map_frame, options_.odom_frame, options_.base_frame},
      goal_reader_{buffer_, options_.map_frame, options_.max_goal_age_s},
      driver_(options_.pilot, OpenCanBus(options_.can, ChassisLink::Filters())),
      publisher_(node, TrackKinematics(options_.pilot.kinematics), options_.map_frame,
                 options_.base_frame),
      check_(driver_, options_.pilot, options_.baseline_m),
      driven_(node),
      updater_(node, private_node) {
  updater_.setHardwareID("chassis on " + options_.can);
  updater_.add("driving", [this](auto& diagnostics) { Report(diagnostics); });
  if (!driver_.link().StandingStop())
    ROS_WARN(
        "no chassis_guard: where this process is killed or hangs, the last command stands "
        "until the chassis' own time-out");
  WaitForClock();
  Listen(node);
  challenge_ = node.advertise<OperatorChallenge>("operator_challenge", 1);
  Serve(private_node);
  move_base_ = std::make_unique<MoveBaseServer>(
      node, [this](const auto& goal) { return Drive(goal); },
      [this] { driver_.pilot().CancelRoute(); });
  // Simulated time may run faster or slower than the wall's: then it sets the pace too.
  if (ros::Time::isSimTime())
    timer_ = node.createTimer(ros::Duration(kTick_s), [this](const ros::TimerEvent&) { Tick(); });
  steady_timer_ = node.createSteadyTimer(ros::WallDuration(kTick_s),
                                         [this](const ros::SteadyTimerEvent&) { Tick(); });
}

void ChassisNode::Listen(ros::NodeHandle& node) {
  const auto subscribe = [&](const char* topic, auto callback) {
    subscribers_.push_back(
        node.subscribe(topic, 10, callback, this, ros::TransportHints().tcpNoDelay()));
  };
  subscribe("goal", &ChassisNode::TakeGoal<geometry_msgs::PoseStamped>);
  subscribe("waypoints", &ChassisNode::TakeGoal<nav_msgs::Path>);
  subscribe("cmd_vel", &ChassisNode::TakeVelocity);
  subscribe("emergency_stop", &ChassisNode::TakeEmergencyStop);
  subscribe("operator_answer", &ChassisNode::TakeAnswer);
  subscribe("odom", &ChassisNode::TakeOdometry);
  subscribe("status", &ChassisNode::TakeOdometryStatus);
  subscribers_.push_back(node.subscribe("/diagnostics", 100, &StartCheck::Take, &check_));
}

void ChassisNode::Serve(ros::NodeHandle& private_node) {
  const auto serve = [&](const char* name, std::function<Reply()> act) {
    using Event = ros::ServiceEvent<std_srvs::Trigger::Request, std_srvs::Trigger::Response>;
    const auto answer = [this, act, name](Event& event) {
      const Reply reply = act();
      Tick();
      event.getResponse().success = reply.is_accepted;
      event.getResponse().message = reply.text;
      ROS_INFO("%s called by %s: %s", name, event.getCallerName().c_str(), reply.text.c_str());
      return true;
    };
    ros::AdvertiseServiceOptions options;
    options.initBySpecType<Event>(private_node.resolveName(name),
                                  boost::function<bool(Event&)>(answer));
    servers_.push_back(private_node.advertiseService(options));
  };
  Pilot& pilot = driver_.pilot();
  serve("start", [this] { return Start(); });
  serve("check", [this] { return Reply{Check(true).empty(), "start-up check" + Check(false)}; });
  serve("stop", [&pilot] { return pilot.Stop(), Reply{true, "stopped"}; });
  serve("cancel", [&pilot] { return pilot.CancelRoute(), Reply{true, "no goal"}; });
  serve("drive_home", [this] {
    try {
      const std::string flaw = Follow([way = driven_.PlanHome(base_)] { return way; });
      return Reply{flaw.empty(), flaw.empty() ? "drives home" : flaw};
    } catch (const std::invalid_argument& error) {
      return Reply{false, error.what()};
    }
  });
  serve("clear_errors", [this] { return ClearErrors(); });
  serve("set_datum", [&pilot] { return pilot.SetDatum(); });
  serve("release_emergency_stop", [&pilot] {
    return pilot.ReleaseEmergencyStops(), Reply{true, "released"};
  });
}

Reply ChassisNode::Start() {
  const DriveState state = driver_.pilot().Status().state;
  const bool begins = state == DriveState::kStandby || state == DriveState::kBlocked;
  const std::string flaws = begins ? Check(true) : "";
  if (!flaws.empty()) return {false, "not started:" + flaws};
  driver_.ReleaseGuard();
  return driver_.pilot().Start(clock_.Now());
}

Reply ChassisNode::ClearErrors() {
  const DriveState state = driver_.pilot().Status().state;
  const auto& measured = driver_.link().Readings().motion;
  const bool is_at_rest = state != DriveState::kDriving && state != DriveState::kWarning &&
                          (!measured || measured->motion.IsZero());
  if (!is_at_rest) return {false, "not sent: the rover moves"};
  driver_.link().SendClearErrors();
  return {true, "sent"};
}

void ChassisNode::Tick() {
  const double now_s = clock_.Now();
  if (now_s > last_tick_s_) clock_moved_ = ros::SteadyTime::now();
  last_tick_s_ = now_s;
  if (const double step_s = clock_.TakeStep()) driver_.pilot().ObserveClockSet(now_s, step_s);
  // Not by driving time: simulated time may stand still, or run slowly.
  ChallengeOperator(ros::SteadyTime::now().toSec());
  Look(now_s);
  move_base_->Spin();
  driver_.Tick(now_s);
  publisher_.Publish(now_s, driver_);
  TellResults();
  updater_.update();
}

void ChassisNode::ChallengeOperator(double steady_s) {
  const auto challenge =
      driver_.pilot().operator_watch().Advance(steady_s, uint64_t{random_()} << 32 | random_());
  if (!challenge) return;
  challenge_.publish(ToMessage(*challenge));
}

void ChassisNode::Look(double now_s) {
  const bool is_clock_stalled =
      (ros::SteadyTime::now() - clock_moved_).toSec() > options_.max_clock_stall_s;
  const auto sighting = sight_.Look();
  if (!sighting || is_clock_stalled) return driver_.pilot().ObserveNoPose();
  if (sighting->MapAge(ros::Time::now()) > options_.max_map_age_s)
    return driver_.pilot().ObserveNoPose(StopReason::kMapStale);
  if (sighting->stamp != base_.header.stamp) {
    seen_s_ = clock_.At(sighting->stamp);
    base_ = sight_.BaseInMap(*sighting);
    move_base_->Tell(base_);
  }
  driver_.pilot().ObservePose(now_s, {seen_s_, sighting->odom_from_base, sighting->map_from_odom});
}

void ChassisNode::Report(Diagnostics& diagnostics) const {
  FillDiagnostics(driver_.pilot().Status(), driver_.link(), diagnostics);
  diagnostics.add("rover", options_.pilot.operator_watch.rover);
  FillDiagnostics(driver_.pilot().operator_watch(), diagnostics);
  diagnostics.add("tf refused, from the future", transforms_.num_from_future());
  diagnostics.add("odometry refused, from the future", num_odometry_refused_);
}

void ChassisNode::TellResults() {
  for (const GoalResult& result : driver_.pilot().TakeResults()) {
    publisher_.Publish(result);
    // What has ended for its client is not driven to after the next start.
    if (move_base_->Tell(result)) driver_.pilot().CancelRoute();
  }
}

template <class Goal>
std::string ChassisNode::Drive(const Goal& goal) {
  return Follow([&] {
    goal_reader_.RequireFresh(goal.header, ros::Time::now());
    return Route{goal_reader_.Read(goal)};
  });
}

std::string ChassisNode::Follow(const std::function<Route()>& read) {
  try {
    const Route route = read();
    const Reply reply = driver_.pilot().SetRoute(route);
    Require(reply.is_accepted, reply.text);
    TellResults();  // of the goal that is replaced
    publisher_.PublishPlan(base_, route);
    return "";
  } catch (const std::invalid_argument& error) {
    publisher_.PublishRefusal(error.what());
    return error.what();
  }
}

template <class Goal>
void ChassisNode::TakeGoal(const Goal& goal) {
  if (Drive(goal).empty()) Tick();
}

void ChassisNode::TakeVelocity(const ros::MessageEvent<const geometry_msgs::Twist>& event) {
  PlanarMotion motion;
  try {
    motion = ReadVelocity(*event.getConstMessage());
  } catch (const std::invalid_argument& error) {
    ROS_WARN_THROTTLE(1, "%s", error.what());
  }
  const Reply reply = driver_.pilot().SetVelocity(clock_.Now(), motion, event.getPublisherName());
  if (!reply.is_accepted) ROS_WARN_THROTTLE(1, "%s", reply.text.c_str());
}

void ChassisNode::TakeEmergencyStop(const ros::MessageEvent<const std_msgs::Bool>& event) {
  driver_.pilot().SetEmergencyStop(event.getPublisherName(), event.getConstMessage()->data);
  Tick();
}

void ChassisNode::TakeAnswer(const OperatorChallenge& answer) {
  driver_.pilot().operator_watch().ObserveAnswer(ros::SteadyTime::now().toSec(),
                                                 {answer.rover, answer.sequence, answer.number});
}

void ChassisNode::TakeOdometry(const nav_msgs::Odometry& odometry) {
  const PoseUncertainty uncertainty = ToUncertainty(odometry, clock_.At(odometry.header.stamp));
  if (!driver_.pilot().ObserveUncertainty(clock_.Now(), uncertainty)) ++num_odometry_refused_;
}

void ChassisNode::TakeOdometryStatus(const ros::MessageEvent<const OdometryStatus>& event) {
  const OdometryStatus& status = *event.getConstMessage();
  const double taken_s = clock_.At(status.header.stamp);
  driver_.pilot().ObserveEpoch(epochs_.Read(event), taken_s);
  driver_.pilot().picture_watch().Observe(ToPicture(status, taken_s));
}

}  // namespace arfm_vo
