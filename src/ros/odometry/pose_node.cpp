#include "arfm_vo/ros/odometry/pose_node.h"

#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/ros/input/stereo_input.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/stereo_messages.h"
#include "arfm_vo/ros/node/parameters.h"
#include "arfm_vo/ros/node/services.h"

namespace arfm_vo {
namespace {

/// Images wait here for their features: more pairs than arfm_node works on and lets wait.
constexpr int kPairQueueSize = 10;

}  // namespace

PoseNode::PoseNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : options_(ReadParameters<PoseNodeOptions>(private_node)),
      mount_(buffer_, options_.mount),
      trajectory_output_(options_.trajectory, options_.mount.base_frame),
      outputs_(node, options_.output, options_.mount.base_frame),
      session_(std::make_unique<Session>(options_.algorithm.odometry, 1, options_.senses)),
      learned_(options_.remember_calibration),
      diagnostics_(node, private_node, private_node.getNamespace()),
      requests_(node),
      worker_(options_.max_waiting_pairs,
              [this](const std::exception& error) { health_.CountRefused(error.what()); }),
      pairing_(kPairQueueSize, [this](const auto& frame, const auto& left, const auto& right) {
        worker_.PostLossy([this, frame, left, right] { Process(frame, left, right); });
      }) {
  if (options_.max_held_pairs > 0) worker_.Hold(options_.max_held_pairs);
  Offer(node, private_node);
  Subscribe(node, private_node);
}

PoseNode::~PoseNode() {
  if (trajectory_output_.is_enabled())
    TellSavedAtEnd("the trajectory is", [this] { return Save(); });
}

void PoseNode::Offer(ros::NodeHandle& node, ros::NodeHandle& private_node) {
  diagnostics_.setHardwareID("arfm_vo");
  diagnostics_.add("odometry", &health_, &OdometryHealth::ReportOdometry);
  diagnostics_.add("calibration", &health_, &OdometryHealth::ReportCalibration);
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

void PoseNode::Subscribe(ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  transforms_ = std::make_unique<TransformInput>(node, buffer_);
  if (options_.senses.use_imu || options_.senses.use_tracks) {
    senses_ =
        std::make_unique<SenseInputs>(node, options_.senses, options_.mount.base_frame, buffer_,
                                      worker_, [this]() -> Senses& { return session_->senses(); });
    diagnostics_.add("senses", senses_.get(), &SenseInputs::Report);
  }
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  const image_transport::TransportHints hints("raw", no_delay, private_node);
  updates_ = node.subscribe<MapUpdateStamped>(
      "map_update", 2,
      [this](const MapUpdateStampedConstPtr& update) {
        worker_.Post([this, update] { session_->Offer(FromMessage(*update), update->epoch); });
      },
      {}, no_delay);
  image_transport::ImageTransport transport(node);
  left_ = transport.subscribe(
      StereoTopic(node, "left/image_rect"), kPairQueueSize,
      [this](const sensor_msgs::ImageConstPtr& image) { pairing_.Add<1>(image); }, {}, hints);
  right_ = transport.subscribe(
      StereoTopic(node, "right/image_rect"), kPairQueueSize,
      [this](const sensor_msgs::ImageConstPtr& image) { pairing_.Add<2>(image); }, {}, hints);
  frames_ = node.subscribe<Frame>(
      "features", kPairQueueSize,
      [this](const StereoFrameStampedConstPtr& frame) {
        if (!requests_.Take(frame)) pairing_.Add<0>(frame);
      },
      {}, no_delay);
}

std::string PoseNode::Save() {
  std::string saved;
  worker_.RunAndWait([&] { saved = SaveTrajectory(); });
  return saved;
}

std::string PoseNode::SaveTrajectory() const {
  return trajectory_output_.Save(trajectory_output_.Select(session_->MakeTrajectory(), mounts_));
}

void PoseNode::Process(const StereoFrameStampedConstPtr& pair,
                       const sensor_msgs::ImageConstPtr& left,
                       const sensor_msgs::ImageConstPtr& right) {
  Stopwatch stopwatch;
  const uint32_t num_dropped = numbers_.CountMissing(pair->pair_number);
  health_.CountDropped(num_dropped);
  if (!AcceptStamp(pair->header.stamp)) return;
  const StereoCamera camera = FromMessage(pair->camera);
  StereoFrameStampedConstPtr message = pair;
  FrameOnRequest frame(FromMessage(*pair));
  if (!pair->has_features) {
    frame = FrameOnRequest(frame.Known(), [&] {
      message = requests_.Get(pair->header.stamp);
      return FromMessage(*message);
    });
  }
  const StereoImages images{frame.stamp_s(), ToGrey(left, "left/image_rect", window_),
                            ToGrey(right, "right/image_rect", window_)};
  images.Check();
  Require(images.left.cols == camera.width && images.left.rows == camera.height,
          "left/image_rect does not have the size that features tells of the camera");
  if (const auto known = learned_.ReadFor(camera)) session_->SetCorrection(camera, *known);
  const SessionUpdate pose =
      mount_.Process(frame, camera, images, pair->header, *session_, mounts_);
  requests_.Release(pair->header.stamp);
  outputs_.Publish(pose, *message, num_dropped);
  outputs_.PublishPicture(images.left, frame.Known(), pose, pair->header);
  const auto line =
      health_.Count(frame.Known(), pose, stopwatch.LapMs(), ros::SteadyTime::now().toSec());
  if (line && line->is_warning) ROS_WARN("%s", line->text.c_str());
  if (line && !line->is_warning) ROS_INFO("%s", line->text.c_str());
  if (pose.update.pose.status != PoseStatus::kNoTransform) worker_.Release();
}

bool PoseNode::AcceptStamp(const ros::Time& stamp) {
  if (stamp == last_stamp_) return false;  // the same pair again
  if (stamp < last_stamp_) {
    ROS_WARN("time jumped back by %.3f s: starting anew", last_stamp_.toSec() - stamp.toSec());
    if (trajectory_output_.is_enabled()) ROS_INFO("%s", SaveTrajectory().c_str());
    trajectory_output_.StartRun();
    mounts_.Clear();
    session_ = std::make_unique<Session>(options_.algorithm.odometry, session_->epoch() + 1,
                                         options_.senses);
    outputs_.ClearPath();
    health_.Clear();
  }
  last_stamp_ = stamp;
  return true;
}

}  // namespace arfm_vo
