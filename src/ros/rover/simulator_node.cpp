#include "arfm_vo/ros/rover/simulator_node.h"

#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/Imu.h>
#include <std_srvs/SetBool.h>
#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "arfm_vo/base/range_check.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "arfm_vo/ros/node/parameters.h"

namespace arfm_vo {
namespace {

constexpr uint64_t kStep_ns = 10'000'000;
/// So late that a clock may step back by hours.
constexpr uint64_t kStart_ns = 10'000'000'000'000;
const ros::WallDuration kPoll(0.002);
constexpr double kClockStep_s = 30;
/// Of the terrain that is shown.
constexpr double kHalfSide_m = 30, kCell_m = 0.5;
constexpr double kSunk_m = 0.05;  // what lies on the ground stays visible

}  // namespace

visualization_msgs::Marker MakeTerrainMarker(const Terrain& terrain, const Rigid3& map_from_world,
                                             const std::string& frame) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = frame;
  marker.ns = "terrain";
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose = ToPoseMessage(map_from_world);
  marker.scale.x = marker.scale.y = marker.scale.z = 1;
  marker.color.a = 1;
  const auto add = [&](double x, double y) {
    marker.points.emplace_back();
    marker.points.back().x = x;
    marker.points.back().y = y;
    marker.points.back().z = terrain.Height(x, y) - kSunk_m;
    const float light = static_cast<float>(std::clamp(terrain.Sunlight(x, y), 0.0, 2.0));
    marker.colors.emplace_back();
    marker.colors.back().r = 0.15f + 0.20f * light;
    marker.colors.back().g = 0.11f + 0.15f * light;
    marker.colors.back().b = 0.08f + 0.11f * light;
    marker.colors.back().a = 1;
  };
  const int num_cells = static_cast<int>(2 * kHalfSide_m / kCell_m);
  for (int i = 0; i < num_cells * num_cells; ++i) {
    const int column = i % num_cells, row = i / num_cells;
    const double x = -kHalfSide_m + kCell_m * column, y = -kHalfSide_m + kCell_m * row;
    for (const auto& [right, up] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
      add(x + right * kCell_m, y + up * kCell_m);
  }
  return marker;
}

void SimulatorNodeOptions::Check() const {
  Require(!can.empty(), "can must name a bus");
  RequireAbove(max_speed_up, 0, 1000, "max_speed_up");
  RequireInRange(max_latency_s, 0, 600, "max_latency_s");
  RequireInRange(max_wait_s, 0, 600, "max_wait_s");
  RequireInRange(pair_period_s, 0.02, 60, "pair_period_s");
  Require(start.size() == 3, "start must hold x, y and the heading");
  for (const double value : start)
    Require(std::abs(value) < terrain.side_m / 2, "start must lie on the terrain");
}

SimulatorNode::SimulatorNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : options_(ReadParameters<SimulatorNodeOptions>(private_node)),
      terrain_(options_.terrain, Corridor{}, options_.render.num_threads),
      renderer_(terrain_, options_.render),
      camera_(options_.rig.Camera()),
      map_from_world_(GroundOf(terrain_, options_.shape)(RoverPose{}).Inverse()),
      chassis_(
          OpenCanBus(options_.can),
          TrackedPlant(options_.plant, {options_.start[0], options_.start[1], options_.start[2]},
                       GroundOf(terrain_, options_.shape))),
      now_ns_(kStart_ns),
      head_(options_.head_port.empty() ? nullptr
                                       : std::make_unique<SimulatedPtuPort>(
                                             options_.head_port, SimulatedPtuOptions::Instant(),
                                             [this] { return 1e-9 * now_ns_; })),
      pair_due_ns_(now_ns_),
      stereo_(ros::NodeHandle(node, "stereo")),
      clock_(node.advertise<rosgraph_msgs::Clock>("/clock", 10)),
      truth_(node.advertise<nav_msgs::Odometry>("base_truth", 10)),
      ground_(node.advertise<visualization_msgs::Marker>(
          "terrain", 1,
          [this](const ros::SingleSubscriberPublisher& subscriber) {
            subscriber.publish(MakeTerrainMarker(terrain_, map_from_world_, options_.map_frame));
          })),
      imu_publisher_(node.advertise<sensor_msgs::Imu>("imu", 100)),
      status_subscriber_(node.subscribe<OdometryStatus>(
          "status", 10,
          [this](const OdometryStatusConstPtr& status) {
            odometry_done_ = std::max(odometry_done_, status->header.stamp);
          })),
      odometry_subscriber_(node.subscribe("odom", 10, &SimulatorNode::TakeOdometry, this)),
      report_subscriber_(node.subscribe("goal_report", 10, &SimulatorNode::TakeReport, this)),
      set_clock_(private_node.advertiseService(
          "set_clock",
          boost::function<bool(std_srvs::SetBool::Request&, std_srvs::SetBool::Response&)>(
              [this](auto& ahead, auto& answer) {
                clock_set_ += ros::Duration(ahead.data ? kClockStep_s : -kClockStep_s);
                return answer.success = true;
              }))) {}

void SimulatorNode::Run() {
  if (!head_)
    broadcaster_.sendTransform(
        MakeTransform(Stamp(), options_.base_frame, options_.camera_frame, BaseFromCamera()));
  WaitForSubscribers();
  while (ros::ok()) {
    // A reading of the head takes some ms of wall time on its line, in which it must not go far.
    const double speed_up =
        HasHeadMoved() ? std::min(1.0, options_.max_speed_up) : options_.max_speed_up;
    const ros::WallTime due = ros::WallTime::now() + ros::WallDuration(1e-9 * kStep_ns / speed_up);
    Step();
    ros::spinOnce();
    ros::WallTime::sleepUntil(due);
  }
}

void SimulatorNode::WaitForSubscribers() {
  ROS_INFO("waiting for subscribers of the stereo topics");
  while (ros::ok() && !stereo_.HasSubscribers()) {
    PublishClock();
    ros::spinOnce();
    ros::WallDuration(0.02).sleep();
  }
}

void SimulatorNode::WaitForOdometry() {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(options_.max_wait_s);
  while (ros::ok() && !HasOdometry() && ros::WallTime::now() < end) {
    ros::spinOnce();
    kPoll.sleep();
  }
  if (HasOdometry()) return;
  ROS_WARN("no odometry of a pair within %g s", options_.max_wait_s);
  odometry_done_ = pair_stamp_;
}

void SimulatorNode::Step() {
  const bool is_late = (Stamp() - pair_stamp_).toSec() >= options_.max_latency_s;
  if (is_late && !HasOdometry()) WaitForOdometry();
  now_ns_ += kStep_ns;
  PublishClock();
  chassis_.Tick(1e-9 * static_cast<double>(now_ns_));
  if (const auto read = imu_.Read(1e-9 * now_ns_, chassis_.plant().WorldFromBase())) {
    sensor_msgs::Imu reading;
    reading.header.stamp = Stamp();
    reading.header.frame_id = options_.base_frame;
    tf2::toMsg(read->rate_rad_s, reading.angular_velocity);
    tf2::toMsg(read->force_m_s2, reading.linear_acceleration);
    reading.orientation_covariance[0] = -1;  // it has none
    imu_publisher_.publish(reading);
  }
  if (now_ns_ < pair_due_ns_) return;
  pair_due_ns_ += static_cast<uint64_t>(std::llround(1e9 * options_.pair_period_s));
  TakePair();
}

bool SimulatorNode::HasHeadMoved() {
  if (!head_) return false;
  const std::array<double, 2> angles = {head_->Angle(PtuAxis::kPan), head_->Angle(PtuAxis::kTilt)};
  return std::exchange(head_angles_, angles) != angles;
}

Rigid3 SimulatorNode::BaseFromCamera() const {
  if (!head_) return BaseFromLeftCamera(options_.shape);
  // The unit tilts upward, BaseFromLeftCamera downward.
  return BaseFromLeftCamera(options_.shape, head_->Angle(PtuAxis::kPan),
                            -head_->Angle(PtuAxis::kTilt));
}

void SimulatorNode::TakePair() {
  const Rigid3 world_from_base = chassis_.plant().WorldFromBase();
  const Rigid3 world_from_camera = world_from_base * BaseFromCamera();
  const Rigid3 map_from_base = map_from_world_ * world_from_base;
  pair_stamp_ = Stamp();
  SequencePair pair;
  pair.images = renderer_.RenderPair(camera_, world_from_camera, num_pairs_++,
                                     Stamp().toSec() - kStampOffset_s);
  pair.true_world_from_camera = world_from_camera;
  stereo_.Publish(ToMessages(pair, camera_, options_.camera_frame));
  TrackPoint point;
  point.time_s = pair_stamp_.toSec();
  point.truth = ProjectToPlane(map_from_base);
  point.slope_deg = SlopeOf(world_from_base);
  drive_.track.push_back(point);
  nav_msgs::Odometry truth;
  truth.header.stamp = pair_stamp_;
  truth.header.frame_id = options_.map_frame;
  truth.child_frame_id = options_.base_frame;
  truth.pose.pose = ToPoseMessage(map_from_base);
  truth_.publish(truth);
}

void SimulatorNode::PublishClock() const {
  rosgraph_msgs::Clock clock;
  clock.clock = Stamp();
  clock_.publish(clock);
}

void SimulatorNode::TakeOdometry(const nav_msgs::Odometry& odometry) {
  for (auto point = drive_.track.rbegin(); point != drive_.track.rend(); ++point) {
    if (std::abs(point->time_s - odometry.header.stamp.toSec()) > 1e-3) continue;
    point->sight = ProjectToPlane(ToRigid3(odometry.pose.pose));
    point->is_tracked = true;
    return;
  }
}

void SimulatorNode::TakeReport(const GoalReport& report) {
  if (options_.picture.empty() || drive_.track.empty() || report.result == GoalReport::REFUSED)
    return;
  const TrackPoint& end = drive_.track.back();
  drive_.outcome = report.text;
  drive_.goal = {report.x_m, report.y_m, report.heading_rad};
  drive_.final_error_m = std::hypot(report.x_m - end.truth.x_m, report.y_m - end.truth.y_m);
  drive_.final_heading_error_deg =
      std::abs(WrapAngle(report.heading_rad - end.truth.heading_rad)) * 180 / M_PI;
  drive_.driven_m = chassis_.plant().DrivenDistance() - driven_before_m_;
  drive_.duration_s = end.time_s - drive_.track.front().time_s;
  for (const TrackPoint& point : drive_.track)
    drive_.steepest_deg = std::max(drive_.steepest_deg, point.slope_deg);
  try {
    SaveDrive(options_.picture, terrain_, RoverPose{}, drive_);
  } catch (const std::runtime_error& error) {
    ROS_ERROR("%s", error.what());
  }
  drive_.track.assign(1, TrackPoint(end));
  drive_.steepest_deg = 0;
  driven_before_m_ = chassis_.plant().DrivenDistance();
}

}  // namespace arfm_vo
