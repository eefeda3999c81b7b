#include "arfm_vo/ros/odometry/map_pipeline.h"

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/console.h>

#include <algorithm>

#include "arfm_vo/base/process_usage.h"
#include "arfm_vo/driving/route.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/pose_message.h"
#include "arfm_vo/ros/node/parameters.h"
#include "arfm_vo/ros/node/worker.h"
#include "arfm_vo/ros/odometry/ba_node_options.h"
#include "arfm_vo/ros/odometry/map_outputs.h"
#include "arfm_vo/ros/odometry/map_shift.h"
#include "arfm_vo/ros/odometry/mount_log.h"
#include "arfm_vo/ros/odometry/trajectory_output.h"

namespace arfm_vo {

namespace {

using diagnostic_msgs::DiagnosticStatus;

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

class AdjustedMap : public MapPipeline {
 public:
  AdjustedMap(ros::NodeHandle node, const BaNodeOptions& options,
              std::function<bool()> is_stopping);

  void Add(const KeyframeStamped& message) override;
  void AdjustIfSettled() override;
  void PlaceRover(const geometry_msgs::PoseWithCovarianceStamped& stated,
                  const nav_msgs::OdometryConstPtr& odometry) override;
  void CountRefused(const std::exception& error) override;

  void Report(diagnostic_updater::DiagnosticStatusWrapper& status) const override;
  geometry_msgs::Transform MapFromOdom() const override {
    return ToTransformMessage(told_.Get().map_from_odom);
  }
  std::string SaveTrajectory() const override { return trajectory_output_.Save(trajectory_.Get()); }
  bool saves_at_end() const override { return trajectory_output_.is_enabled(); }
  const MapTransformOptions& transform() const override { return options_.transform; }

 private:
  /// How adjusting fares; told to the diagnostics while the worker may be busy.
  struct Figures {
    int num_keyframes = 0, num_landmarks = 0, num_loops = 0, num_adjustments = 0, num_failed = 0;
    uint32_t num_refused = 0;
    std::string refusal;  ///< why the newest keyframe was refused; empty where it was not
    bool is_adjusting = false;
    int iteration = 0;
    double cost = 0;
    double last_ms = 0, longest_ms = 0;
    double columns_sigma_px = 0;
    CorrectionBelief::Estimate radial_px, focal_length_excess;
    Rigid3 map_from_odom;
  };

  std::optional<MapUpdate> Adjust();
  void PublishMap();
  void TellOfCalibration(const CorrectionBelief& learnt);
  void Tell();
  Rigid3 NewestMapFromOdom() const { return map_from_adjusted_ * map_.map_from_odom(); }

  const BaNodeOptions options_;
  const std::function<bool()> is_stopping_;
  MapOutputs outputs_;
  TrajectoryOutput trajectory_output_;
  LearnedCalibration learned_;
  PlacedMap map_;
  MountLog mounts_;
  Rigid3 map_from_adjusted_;  // moved where a person states where the rover stands
  ros::Time newest_;          // keyframe's stamp
  bool is_dirty_ = false;     // a keyframe came since the last adjustment
  ros::WallTime settles_;
  bool told_to_calibrate_ = false;
  Figures figures_;
  Shared<Figures> told_;
  Shared<Trajectory> trajectory_;  // of the keyframes
};

AdjustedMap::AdjustedMap(ros::NodeHandle node, const BaNodeOptions& options,
                         std::function<bool()> is_stopping)
    : options_(options),
      is_stopping_(std::move(is_stopping)),
      outputs_(node, options_.transform.map_frame, options_.max_path_poses),
      trajectory_output_(options_.trajectory_dir,
                         NameTrajectoryFrame("base", options_.trajectory_of_camera)),
      learned_(options_.learned),
      map_(Paced(options_.algorithm.global, options_.max_time_share)) {}

void AdjustedMap::CountRefused(const std::exception& error) {
  ++figures_.num_refused;
  figures_.refusal = error.what();
  told_.Set(figures_);
}

void AdjustedMap::Add(const KeyframeStamped& message) {
  const PlacedKeyframe keyframe = FromMessage(message);
  if (const auto known = learned_.ReadFor(keyframe.camera))
    map_.SetCorrection(keyframe.camera, *known);
  if (!map_.Add(keyframe)) {
    ROS_WARN("the odometry started anew: the map is forgotten");
    map_from_adjusted_ = Rigid3();
    mounts_.Clear();
  }
  if (trajectory_output_.is_enabled())
    mounts_.Add(keyframe.keyframe.stamp_s, keyframe.base_from_camera);
  newest_ = message.header.stamp;
  is_dirty_ = true;
  figures_.num_keyframes = map_.num_keyframes();
  figures_.num_landmarks = map_.num_landmarks();
  figures_.num_loops = map_.num_loops();
  figures_.refusal.clear();
  Tell();
  settles_ = ros::WallTime::now() + kSettled;
  if (!options_.algorithm.adjust_globally || !map_.IsAdjustmentDue()) return;
  if (const std::optional<MapUpdate> update = Adjust())
    outputs_.PublishUpdate(*update, map_.epoch(), newest_);
}

void AdjustedMap::PlaceRover(const geometry_msgs::PoseWithCovarianceStamped& stated,
                             const nav_msgs::OdometryConstPtr& odometry) {
  try {
    Require(odometry != nullptr, "initialpose: there is no odom yet");
    const Rigid3 odom_from_base = ToRigid3(odometry->pose.pose);
    Require(FindGoalFlaw(odom_from_base).empty(), "initialpose: odom is no pose");
    map_from_adjusted_ =
        FindMapShift(stated, options_.transform.map_frame, NewestMapFromOdom() * odom_from_base) *
        map_from_adjusted_;
    ROS_WARN("the rover is stated to stand at x %.2f m, y %.2f m: the map frame moves",
             stated.pose.pose.position.x, stated.pose.pose.position.y);
  } catch (const std::invalid_argument& error) {
    ROS_WARN("refused: %s", error.what());
    return;
  }
  Tell();
  PublishMap();
}

/// The odometry is not told: what it does must not depend on when its pairs come.
void AdjustedMap::AdjustIfSettled() {
  if (is_dirty_ && options_.algorithm.adjust_globally && ros::WallTime::now() > settles_) Adjust();
}

void AdjustedMap::Tell() {
  figures_.map_from_odom = NewestMapFromOdom();
  told_.Set(figures_);
  const Trajectory of_camera = map_.MakeTrajectory();
  trajectory_.Set(options_.trajectory_of_camera ? of_camera : mounts_.OfBase(of_camera));
}

std::optional<MapUpdate> AdjustedMap::Adjust() {
  const ros::WallTime start = ros::WallTime::now();
  is_dirty_ = false;
  figures_.is_adjusting = true;
  std::optional<MapUpdate> update = map_.Adjust([this](const BundleProgress& progress) {
    figures_.iteration = progress.iteration;
    figures_.cost = progress.cost;
    told_.Set(figures_);
    return !is_stopping_();
  });
  ReturnFreeMemory();
  const double seconds = (ros::WallTime::now() - start).toSec();
  figures_.is_adjusting = false;
  figures_.last_ms = 1e3 * seconds;
  figures_.longest_ms = std::max(figures_.longest_ms, figures_.last_ms);
  ++figures_.num_adjustments;
  if (!update && map_.num_keyframes() > 1) ++figures_.num_failed;
  Tell();
  if (update) {
    learned_.Write(update->correction);
    TellOfCalibration(update->correction);
    PublishMap();
  }
  return update;
}

void AdjustedMap::TellOfCalibration(const CorrectionBelief& learnt) {
  constexpr double kWarnPx = 1, kWarnShare = 1e-3;
  figures_.columns_sigma_px = learnt.MaxColumnSigma(map_.camera());
  const auto& radial_px = figures_.radial_px = learnt.LargestRadial();
  const auto& excess = figures_.focal_length_excess = learnt.FocalLengthExcess(map_.camera());
  told_.Set(figures_);
  const bool is_off = SurelyOff(radial_px) > kWarnPx || SurelyOff(excess) > kWarnShare;
  if (told_to_calibrate_ || !is_off) return;
  told_to_calibrate_ = true;
  ROS_WARN(
      "both images are off radially by up to %.1f px (sigma %.1f), their focal length by %.2f %% "
      "(sigma %.2f), which is made up for: calibrate the cameras anew, with the board in the "
      "corners too",
      radial_px.mean, radial_px.sigma, 100 * excess.mean, 100 * excess.sigma);
}

void AdjustedMap::PublishMap() {
  std::vector<MapPose> poses = map_.BasePoses();
  for (MapPose& pose : poses) pose.map_from_base = map_from_adjusted_ * pose.map_from_base;
  std::vector<LandmarkPoint> points = map_.Landmarks();
  for (LandmarkPoint& point : points) point.x_in_map = map_from_adjusted_ * point.x_in_map;
  outputs_.Publish(poses, points, newest_);
}

void AdjustedMap::Report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const Figures figures = told_.Get();
  if (!figures.refusal.empty())
    status.summary(DiagnosticStatus::ERROR, "keyframe refused: " + figures.refusal);
  else if (figures.num_failed > 0)
    status.summaryf(DiagnosticStatus::WARN, "%d adjustments found no solution", figures.num_failed);
  else
    status.summary(DiagnosticStatus::OK, figures.is_adjusting ? "adjusting" : "waiting");
  status.add("keyframes", figures.num_keyframes);
  status.add("landmarks", figures.num_landmarks);
  status.add("loops closed", figures.num_loops);
  status.add("adjustments", figures.num_adjustments);
  status.add("keyframes refused", figures.num_refused);
  status.add("iteration", figures.iteration);
  status.addf("cost", "%.1f", figures.cost);
  status.addf("time of the last adjustment (ms)", "%.0f", figures.last_ms);
  status.addf("time of the longest adjustment (ms)", "%.0f", figures.longest_ms);
  status.addf("rectification: columns known to (px)", "%.2f", figures.columns_sigma_px);
  status.addf("calibration: both images off radially by up to (px)", "%.1f, sigma %.1f",
              figures.radial_px.mean, figures.radial_px.sigma);
  status.addf("calibration: focal length of both images off by (%)", "%.2f, sigma %.2f",
              100 * figures.focal_length_excess.mean, 100 * figures.focal_length_excess.sigma);
}

}  // namespace

std::unique_ptr<MapPipeline> MakeMapPipeline(ros::NodeHandle node,
                                             const ros::NodeHandle& private_node,
                                             std::function<bool()> is_stopping) {
  return std::make_unique<AdjustedMap>(node, ReadParameters<BaNodeOptions>(private_node),
                                       std::move(is_stopping));
}

}  // namespace arfm_vo
