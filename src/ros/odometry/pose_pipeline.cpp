#include "arfm_vo/ros/odometry/pose_pipeline.h"

#include <ros/console.h>

#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/image/grey_window.h"
#include "arfm_vo/ros/input/pair_numbers.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/image_conversion.h"
#include "arfm_vo/ros/node/parameters.h"
#include "arfm_vo/ros/odometry/mount_log.h"
#include "arfm_vo/ros/odometry/mounted_session.h"
#include "arfm_vo/ros/odometry/pose_node_options.h"
#include "arfm_vo/ros/odometry/trajectory_output.h"

namespace arfm_vo {

void PoseNodeOptions::Check() const {
  algorithm.Check();
  mount.Check();
  output.Check();
  health.Check();
  Require(max_waiting_pairs >= 1, "max_waiting_pairs must be at least 1");
  Require(max_held_pairs >= 0, "max_held_pairs must not be negative");
}

namespace {

class OdometryPipeline : public PosePipeline {
 public:
  OdometryPipeline(const ros::NodeHandle& node, const PoseNodeOptions& options,
                   const tf2::BufferCore& buffer);

  bool Process(const StereoFrameStamped& message, const sensor_msgs::ImageConstPtr& left,
               const sensor_msgs::ImageConstPtr& right) override;
  void Apply(const MapUpdateStamped& update) override {
    session_->Offer(FromMessage(update), update.epoch);
  }
  void AddTrack(const nav_msgs::Odometry& odometry) override;
  void CountRefused(const std::exception& error) override { health_.CountRefused(error.what()); }
  void StartEpoch() override { session_->StartEpoch(); }
  std::string SaveTrajectory() override { return trajectory_output_.Save(MakeTrajectory()); }

  void ReportOdometry(Status& status) override { health_.ReportOdometry(status); }
  void ReportCalibration(Status& status) override { health_.ReportCalibration(status); }
  void ReportScale(Status& status) const override { health_.ReportScale(status); }

  int max_waiting_pairs() const override { return options_.max_waiting_pairs; }
  int max_held_pairs() const override { return options_.max_held_pairs; }
  bool saves_at_end() const override { return trajectory_output_.is_enabled(); }

 private:
  bool AcceptStamp(const ros::Time& stamp);
  Trajectory MakeTrajectory() const;

  const PoseNodeOptions options_;
  const CameraMount mount_;
  TrajectoryOutput trajectory_output_;
  PoseOutputs outputs_;
  std::unique_ptr<Session> session_;
  MountLog mounts_;
  OdometryHealth health_;
  LearnedCalibration learned_;
  GreyWindow window_;
  ros::Time last_stamp_;
  PairNumbers numbers_;
};

OdometryPipeline::OdometryPipeline(const ros::NodeHandle& node, const PoseNodeOptions& options,
                                   const tf2::BufferCore& buffer)
    : options_(options),
      mount_(buffer, options_.mount),
      trajectory_output_(
          options_.trajectory_dir,
          NameTrajectoryFrame(options_.mount.base_frame, options_.trajectory_of_camera)),
      outputs_(node, options_.output, options_.mount.base_frame),
      session_(std::make_unique<Session>(options_.algorithm.odometry)),
      health_(options_.health),
      learned_(options_.learned) {}

bool OdometryPipeline::Process(const StereoFrameStamped& message,
                               const sensor_msgs::ImageConstPtr& left,
                               const sensor_msgs::ImageConstPtr& right) {
  Stopwatch stopwatch;
  const uint32_t num_dropped = numbers_.CountMissing(message.pair_number);
  health_.CountDropped(num_dropped);
  if (!AcceptStamp(message.header.stamp)) return false;
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
  outputs_.Publish(pose, message, num_dropped);
  outputs_.PublishPicture(images.left, frame, pose, message.header);
  health_.Count(frame, pose, stopwatch.LapMs());
  return pose.update.pose.status != PoseStatus::kNoTransform;
}

void OdometryPipeline::AddTrack(const nav_msgs::Odometry& odometry) {
  const auto& place = odometry.pose.pose.position;
  health_.scale().AddTrack(odometry.header.stamp.toSec(),
                           Eigen::Vector3d(place.x, place.y, place.z));
}

bool OdometryPipeline::AcceptStamp(const ros::Time& stamp) {
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

Trajectory OdometryPipeline::MakeTrajectory() const {
  const Trajectory of_camera = session_->MakeTrajectory();
  return options_.trajectory_of_camera ? of_camera : mounts_.OfBase(of_camera);
}

}  // namespace

std::unique_ptr<PosePipeline> MakePosePipeline(const ros::NodeHandle& node,
                                               const ros::NodeHandle& private_node,
                                               const tf2::BufferCore& buffer) {
  return std::make_unique<OdometryPipeline>(node, ReadParameters<PoseNodeOptions>(private_node),
                                            buffer);
}

}  // namespace arfm_vo
