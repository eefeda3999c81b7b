#include "arfm_vo/ros/pose_node.h"

#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/ros/conversions.h"
#include "arfm_vo/ros/image_conversion.h"
#include "arfm_vo/ros/mounted_session.h"
#include "arfm_vo/ros/parameters.h"
#include "arfm_vo/ros/stereo_input.h"
#include "arfm_vo/ros/trigger_service.h"

namespace arfm_vo {
namespace {

/// Images wait here for their features: more pairs than arfm_node works on and lets wait.
constexpr int kQueueSize = 10;

}  // namespace

void PoseNodeOptions::Check() const {
  algorithm.Check();
  mount.Check();
  output.Check();
  health.Check();
  Require(max_waiting_pairs >= 1, "max_waiting_pairs must be at least 1");
  Require(max_held_pairs >= 0, "max_held_pairs must not be negative");
}

PoseNode::PoseNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : options_(ReadParameters<PoseNodeOptions>(private_node)),
      mount_(buffer_, options_.mount),
      trajectory_output_(
          options_.trajectory_dir,
          NameTrajectoryFrame(options_.mount.base_frame, options_.trajectory_of_camera)),
      outputs_(node, options_.output, options_.mount.base_frame),
      session_(std::make_unique<Session>(options_.algorithm.odometry)),
      health_(options_.health),
      learned_(options_.learned),
      diagnostics_(node, private_node, private_node.getNamespace()),
      worker_(options_.max_waiting_pairs,
              [this](const std::exception& error) {
                health_.CountRefused(error.what());
                ROS_ERROR_THROTTLE(5, "pair refused: %s", error.what());
              }),
      transport_(node),
      pairing_(kQueueSize, [this](const auto& frame, const auto& left, const auto& right) {
        worker_.PostLossy([this, frame, left, right] { Process(*frame, left, right); });
      }) {
  if (options_.max_held_pairs > 0) worker_.Hold(options_.max_held_pairs);
  Offer(node, private_node);
  Subscribe(node, private_node);
}

PoseNode::~PoseNode() {
  if (!trajectory_output_.is_enabled()) return;
  try {
    TellAtEnd(Save());
  } catch (const std::exception& error) {
    TellAtEnd(std::string("ERROR: the trajectory is not saved: ") + error.what());
  }
}

void PoseNode::Offer(ros::NodeHandle node, ros::NodeHandle private_node) {
  diagnostics_.setHardwareID("arfm_vo");
  diagnostics_.add("odometry", &health_, &OdometryHealth::ReportOdometry);
  diagnostics_.add("calibration", [this](auto& status) { health_.ReportCalibration(status); });
  diagnostics_.add("scale", [this](auto& status) { health_.ReportScale(status); });
  timer_ = node.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) {
    worker_.Post([this] { diagnostics_.force_update(); });
  });
  reset_ = OfferTrigger(private_node, "reset", [this] {
    worker_.RunAndWait([this] { session_->StartEpoch(); });
    ROS_WARN("reset: the next pair begins a new map where the base stands");
    return std::string("the next pair begins a new map where the base stands");
  });
  save_ = OfferTrigger(private_node, "save_trajectory", [this] { return Save(); });
}

void PoseNode::Subscribe(ros::NodeHandle node, const ros::NodeHandle& private_node) {
  transforms_ = std::make_unique<TransformInput>(node, buffer_);
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  const image_transport::TransportHints hints("raw", no_delay, private_node);
  updates_ = node.subscribe<MapUpdateStamped>(
      "map_update", 2,
      [this](const MapUpdateStampedConstPtr& update) {
        worker_.Post([this, update] { ApplyUpdate(*update); });
      },
      ros::VoidConstPtr(), no_delay);
  tracks_ = node.subscribe<nav_msgs::Odometry>(
      "track_odometry", 50, [this](const nav_msgs::OdometryConstPtr& odometry) {
        const auto& place = odometry->pose.pose.position;
        worker_.Post([this, stamp_s = odometry->header.stamp.toSec(),
                      position = Eigen::Vector3d(place.x, place.y, place.z)] {
          health_.scale().AddTrack(stamp_s, position);
        });
      });
  left_ = transport_.subscribe(
      StereoTopic(node, "left/image_rect"), kQueueSize,
      [this](const sensor_msgs::ImageConstPtr& image) { pairing_.Add<1>(image); }, {}, hints);
  right_ = transport_.subscribe(
      StereoTopic(node, "right/image_rect"), kQueueSize,
      [this](const sensor_msgs::ImageConstPtr& image) { pairing_.Add<2>(image); }, {}, hints);
  frames_ = node.subscribe<Frame>(
      "features", kQueueSize, [this](const auto& frame) { pairing_.Add<0>(frame); }, {}, no_delay);
}

void PoseNode::Process(const Frame& message, const sensor_msgs::ImageConstPtr& left,
                       const sensor_msgs::ImageConstPtr& right) {
  Stopwatch stopwatch;
  const uint32_t num_dropped = CountDropped(message.pair_number);
  health_.CountDropped(num_dropped);
  if (!AcceptStamp(message.header.stamp)) return;
  const StereoCamera camera = FromMessage(message.camera);
  const StereoFrame frame = FromMessage(message);
  const StereoImages images{frame.stamp_s, ToGrey(left, "left/image_rect", window_),
                            ToGrey(right, "right/image_rect", window_)};
  images.Check();
  Require(images.left.cols == camera.width && images.left.rows == camera.height,
          "left/image_rect does not have the size that features tells of the camera");
  if (const auto known = learned_.ReadFor(camera)) session_->SetCorrection(camera, *known);
  const SessionUpdate pose =
      ProcessMounted(*session_, mount_, frame, camera, images, message.header,
                     trajectory_output_.is_enabled() ? &mounts_ : nullptr);
  if (pose.update.pose.status != PoseStatus::kNoTransform) worker_.Release();
  outputs_.Publish(pose, message, num_dropped);
  outputs_.PublishPicture(images.left, frame, pose, message.header);
  health_.Count(frame, pose, stopwatch.LapMs());
}

bool PoseNode::AcceptStamp(const ros::Time& stamp) {
  if (stamp == last_stamp_) return false;  // the same pair again
  if (stamp < last_stamp_) {
    ROS_WARN("time jumped back by %.3f s: starting anew", last_stamp_.toSec() - stamp.toSec());
    if (trajectory_output_.is_enabled())
      ROS_INFO("%s", trajectory_output_.Save(MakeTrajectory()).c_str());
    trajectory_output_.StartRun();
    mounts_.Clear();
    session_ = std::make_unique<Session>(options_.algorithm.odometry, session_->epoch() + 1);
    outputs_.ClearPath();
    health_.Clear();
  }
  last_stamp_ = stamp;
  return true;
}

uint32_t PoseNode::CountDropped(uint32_t pair_number) {
  const bool is_other_arfm_node = pair_number <= last_pair_;
  if (num_taken_ == 0 || is_other_arfm_node) {
    first_pair_ = pair_number;
    num_taken_ = 0;
  }
  last_pair_ = pair_number;
  ++num_taken_;
  return pair_number - first_pair_ + 1 - num_taken_;
}

void PoseNode::ApplyUpdate(const MapUpdateStamped& message) {
  session_->Offer(FromMessage(message), message.epoch);
}

Trajectory PoseNode::MakeTrajectory() const {
  const Trajectory of_camera = session_->MakeTrajectory();
  return options_.trajectory_of_camera ? of_camera : mounts_.OfBase(of_camera);
}

std::string PoseNode::Save() {
  Trajectory trajectory;
  worker_.RunAndWait([&] { trajectory = MakeTrajectory(); });
  return trajectory_output_.Save(trajectory);
}

}  // namespace arfm_vo
