#include "arfm_vo/ros/odometry/camera_mount.h"

#include <cmath>

#include "arfm_vo/base/check.h"
#include "arfm_vo/ros/messages/transforms.h"

namespace arfm_vo {
namespace {

constexpr double kSlewWindow_s = 0.1;  ///< over which the head's rate is measured

}  // namespace

CameraMount::CameraMount(const tf2::BufferCore& buffer, const CameraMountOptions& options)
    : buffer_(buffer), options_(options) {
  options.Check();
}

Rigid3 CameraMount::LookUp(const std::string& image_frame, const ros::Time& stamp) const {
  const std::string& camera = options_.camera_frame.empty() ? image_frame : options_.camera_frame;
  return LookUpTransform(buffer_, options_.base_frame, camera, stamp).target_from_source;
}

Rigid3 CameraMount::BaseFromCamera(const std::string& image_frame, const ros::Time& stamp) const {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(options_.tf_timeout_s);
  while (true) {
    try {
      return LookUp(image_frame, stamp);
    } catch (const std::invalid_argument&) {
      if (ros::WallTime::now() >= deadline) throw;
    }
    ros::WallDuration(0.001).sleep();
  }
}

bool CameraMount::IsSlewing(const std::string& image_frame, const ros::Time& stamp,
                            const Rigid3& base_from_camera) const {
  if (options_.max_slew_dps == 0 || stamp.toSec() < kSlewWindow_s) return false;
  try {
    const Rigid3 base_from_before = LookUp(image_frame, stamp - ros::Duration(kSlewWindow_s));
    const double turn_deg = (base_from_before.Inverse() * base_from_camera).Angle() * 180 / M_PI;
    return turn_deg > options_.max_slew_dps * kSlewWindow_s;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

SessionUpdate CameraMount::Process(const FrameOnRequest& frame, const StereoCamera& camera,
                                   const StereoImages& images, const std_msgs::Header& header,
                                   Session& session, MountLog& log) const {
  Rigid3 base_from_camera;
  try {
    base_from_camera = BaseFromCamera(header.frame_id, header.stamp);
  } catch (const std::invalid_argument& error) {
    return session.Skip(frame.stamp_s(), PoseStatus::kNoTransform,
                        std::string("no transform: ") + error.what());
  }
  log.Add(frame.stamp_s(), base_from_camera);
  if (IsSlewing(header.frame_id, header.stamp, base_from_camera))
    return session.Skip(frame.stamp_s(), PoseStatus::kHeadSlewing,
                        ToString(PoseStatus::kHeadSlewing));
  return session.Process(frame, camera, images, base_from_camera);
}

}  // namespace arfm_vo
