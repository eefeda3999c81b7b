#include "arfm_vo/ros/odometry/ba_node.h"

#include <arfm_vo/MapUpdateStamped.h>
#include <nav_msgs/Path.h>

#include <algorithm>
#include <boost/make_shared.hpp>

#include "arfm_vo/base/process_usage.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/display_messages.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "arfm_vo/ros/node/parameters.h"
#include "arfm_vo/ros/node/services.h"

namespace arfm_vo {
namespace {

constexpr double kTfPeriod_s = 0.05;
constexpr double kTfTolerance_s = 0.1;  ///< how far into the future a transform is said to hold
constexpr size_t kMaxPathPoses = 1000;  ///< of path_optimized; longer paths are thinned out
/// Without a new keyframe for so long, the newest ones are adjusted too, for the map as it is seen.
const ros::WallDuration kSettled(3);

GlobalMapOptions Paced(GlobalMapOptions options, double max_time_share) {
  options.solver.max_time_share = std::min(options.solver.max_time_share, max_time_share);
  return options;
}

/// By how much at least, at three standard deviations.
double SurelyOff(const CorrectionBelief::Estimate& estimate) {
  return std::abs(estimate.mean) - 3 * estimate.sigma;
}

}  // namespace

BaNode::BaNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : options_(ReadParameters<BaNodeOptions>(private_node)),
      updates_(node.advertise<MapUpdateStamped>("map_update", 2)),
      path_(node.advertise<nav_msgs::Path>("path_optimized", 1, true)),
      landmarks_(node.advertise<sensor_msgs::PointCloud2>("landmarks", 1, true)),
      map_status_(node.advertise<MapStatus>("map_status", 1, true)),
      map_text_(node.advertise<visualization_msgs::Marker>("map_status_text", 1, true)),
      trajectory_output_(options_.trajectory, "base"),
      learned_(options_.remember_calibration),
      map_(Paced(options_.algorithm.global, options_.max_time_share)),
      keeper_(options_.map, options_.map_frame),
      diagnostics_(node, private_node, private_node.getNamespace()),
      worker_(1,
              [this](const std::exception& error) {
                figures_.refusals.Add(error.what());
                told_.Set(figures_);
              }),
      pairs_(node, options_.camera_frame, [this](const TrackedPair& pair) {
        worker_.PostLossy([this, pair] { Localise(pair); });
      }) {
  diagnostics_.setHardwareID("arfm_vo");
  diagnostics_.add("global adjustment",
                   [this](Diagnostics& status) { told_.Get().Report(keeper_.told(), status); });
  Subscribe(node);
  save_ = OfferTrigger(private_node, "save_trajectory",
                       [this] { return trajectory_output_.Save(trajectory_.Get()); });
  save_map_ = OfferTrigger(private_node, "save_map", [this] { return SaveMap(); });
  timer_ = node.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) {
    diagnostics_.force_update();
    // Where no keyframe comes any more, the newest ones are adjusted too. The odometry is not told:
    // what it does must not depend on when its pairs come.
    worker_.PostLossy([this] {
      if (is_dirty_ && options_.algorithm.adjust_globally && ros::WallTime::now() > settles_)
        Adjust();
      keeper_.SaveIfDue(map_);
    });
  });
  if (options_.publish_tf)
    tf_timer_ = node.createTimer(ros::Duration(kTfPeriod_s),
                                 [this](const ros::TimerEvent&) { SendTransform(); });
}

BaNode::~BaNode() {
  if (trajectory_output_.is_enabled())
    TellSavedAtEnd("the keyframes are",
                   [this] { return trajectory_output_.Save(trajectory_.Get()); });
  if (keeper_.is_enabled()) TellSavedAtEnd("the map is", [this] { return SaveMap(); });
}

std::string BaNode::SaveMap() {
  std::string saved;
  worker_.RunAndWait([&] {
    if (is_dirty_ && options_.algorithm.adjust_globally) Adjust();
    saved = keeper_.Save(map_);
  });
  return saved;
}

void BaNode::Subscribe(ros::NodeHandle& node) {
  keyframes_ = node.subscribe<KeyframeStamped>("keyframe", 100,
                                               [this](const KeyframeStampedConstPtr& keyframe) {
                                                 worker_.Post([this, keyframe] { Add(*keyframe); });
                                               });
  stated_ = node.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
      "initialpose", 1, [this](const auto& stated) {
        worker_.Post(
            [this, stated, odometry = pairs_.newest_odometry()] { PlaceRover(*stated, odometry); });
      });
}

void BaNode::SendTransform() {
  const ros::Time stamp = ros::Time::now() + ros::Duration(kTfTolerance_s);
  if (stamp == sent_) return;  // simulated time jumped, and the timer catches up
  sent_ = stamp;
  broadcaster_.sendTransform(
      MakeTransform(stamp, options_.map_frame, options_.odom_frame, told_.Get().map_from_odom));
}

void BaNode::Add(const KeyframeStamped& message) {
  const PlacedKeyframe keyframe = FromMessage(message);
  if (const auto known = learned_.ReadFor(keyframe.camera))
    map_.SetCorrection(keyframe.camera, *known);
  keeper_.LoadFor(keyframe.camera, map_);
  if (!map_.Add(keyframe)) {
    ROS_WARN("the odometry started anew: the map is %s",
             keeper_.is_enabled() ? "looked for" : "forgotten");
    mounts_.Clear();
  }
  mounts_.Add(keyframe.keyframe.stamp_s, keyframe.base_from_camera);
  newest_ = message.header.stamp;
  is_dirty_ = true;
  figures_.num_keyframes = map_.num_keyframes();
  figures_.num_landmarks = map_.num_landmarks();
  figures_.num_loops = map_.num_loops();
  figures_.num_refused_loops = map_.num_refused_loops();
  figures_.refusals.Clear();
  Tell(false);
  settles_ = ros::WallTime::now() + kSettled;
  if (!options_.algorithm.adjust_globally || !map_.IsAdjustmentDue()) return;
  if (const std::optional<MapUpdate> update = Adjust()) {
    const auto result = boost::make_shared<MapUpdateStamped>(ToMessage(*update));
    result->header.stamp = newest_;
    result->header.frame_id = options_.map_frame;
    result->epoch = map_.epoch();
    updates_.publish(result);
  }
}

void BaNode::PlaceRover(const geometry_msgs::PoseWithCovarianceStamped& stated,
                        const nav_msgs::OdometryConstPtr& odometry) {
  try {
    Require(odometry != nullptr, "initialpose: there is no odom yet");
    const Rigid3 odom_from_base = ReadPose(odometry->pose.pose, "initialpose: odom: ");
    const Rigid3 map_from_base = map_.map_from_odom() * odom_from_base;
    const Rigid3 shift = FindMapShift(stated, options_.map_frame, map_from_base);
    map_.Move(shift, {shift * map_from_base, odom_from_base, PlanarCovariance(stated)});
    ROS_WARN("the rover is stated to stand at x %.2f m, y %.2f m: the map frame moves",
             stated.pose.pose.position.x, stated.pose.pose.position.y);
  } catch (const std::invalid_argument& error) {
    ROS_WARN("refused: %s", error.what());
    return;
  }
  Tell(true);
}

void BaNode::Localise(const TrackedPair& pair) {
  if (pair.epoch != map_.epoch()) return;
  try {
    Require(FromMessage(pair.frame->camera) == map_.camera(), "features are of another camera");
    map_.Localise(FromMessage(*pair.frame), pairs_.OdomFromCamera(pair));
  } catch (const std::invalid_argument& error) {
    ROS_WARN_THROTTLE(10, "the rover is not looked for in the map: %s", error.what());
  }
  TellMapState();
}

void BaNode::Tell(bool with_landmarks) {
  trajectory_.Set(trajectory_output_.Select(map_.MakeTrajectory(), mounts_));
  TellMapState();
  Publish(with_landmarks);
}

void BaNode::TellMapState() {
  figures_.map_from_odom = map_.map_from_odom();
  told_.Set(figures_);
  pairs_.Want(map_.localiser().state() == MapState::kLocalising);
  if (const auto status = keeper_.News(map_, newest_)) {
    map_status_.publish(*status);
    const std::vector<MapPose> poses = map_.BasePoses();
    map_text_.publish(MakeMapText(*status, poses.empty() ? Rigid3() : poses.back().map_from_base));
    if (status->state == MapStatus::LOCALISED) Publish(true);
  }
}

std::optional<MapUpdate> BaNode::Adjust() {
  const ros::WallTime start = ros::WallTime::now();
  is_dirty_ = false;
  figures_.is_adjusting = true;
  std::optional<MapUpdate> update = map_.Adjust([this](const BundleProgress& progress) {
    figures_.iteration = progress.iteration;
    figures_.cost = progress.cost;
    told_.Set(figures_);
    return !worker_.is_stopping();
  });
  ReturnFreeMemory();
  figures_.is_adjusting = false;
  figures_.last_ms = 1e3 * (ros::WallTime::now() - start).toSec();
  figures_.longest_ms = std::max(figures_.longest_ms, figures_.last_ms);
  ++figures_.num_adjustments;
  if (!update && map_.num_keyframes() > 1) ++figures_.num_failed;
  if (update) {
    learned_.Write(update->correction);
    WarnOfCalibration(update->correction);
  }
  Tell(update.has_value());
  return update;
}

void BaNode::WarnOfCalibration(const CorrectionBelief& learnt) {
  constexpr double kWarnPx = 1, kWarnShare = 1e-3;
  figures_.columns_sigma_px = learnt.MaxColumnSigma(map_.camera());
  const auto& radial_px = figures_.radial_px = learnt.LargestRadial();
  const auto& excess = figures_.focal_length_excess = learnt.FocalLengthExcess(map_.camera());
  const bool is_off = SurelyOff(radial_px) > kWarnPx || SurelyOff(excess) > kWarnShare;
  if (told_to_calibrate_ || !is_off) return;
  told_to_calibrate_ = true;
  ROS_WARN(
      "both images are off radially by up to %.1f px (sigma %.1f), their focal length by %.2f %% "
      "(sigma %.2f), which is made up for: calibrate the cameras anew, with the board in the "
      "corners too",
      radial_px.mean, radial_px.sigma, 100 * excess.mean, 100 * excess.sigma);
}

void BaNode::Publish(bool with_landmarks) const {
  const std::vector<MapPose> poses = map_.BasePoses();
  nav_msgs::Path path;
  path.header.stamp = newest_;
  path.header.frame_id = options_.map_frame;
  const size_t stride = 1 + poses.size() / kMaxPathPoses;
  for (size_t i = 0; i < poses.size(); ++i) {
    if (i % stride != 0 && i + 1 != poses.size()) continue;
    geometry_msgs::PoseStamped& place = path.poses.emplace_back();
    place.header.frame_id = options_.map_frame;
    place.header.stamp.fromSec(poses[i].stamp_s);
    place.pose = ToPoseMessage(poses[i].map_from_base);
  }
  path_.publish(path);
  if (!with_landmarks) return;
  sensor_msgs::PointCloud2 cloud = MakeLandmarkCloud(map_.Landmarks());
  cloud.header = path.header;
  landmarks_.publish(cloud);
}

}  // namespace arfm_vo
