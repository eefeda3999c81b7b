#include "arfm_vo/ros/odometry/mounted_session.h"

namespace arfm_vo {

SessionUpdate ProcessMounted(Session& session, const CameraMount& mount, const StereoFrame& frame,
                             const StereoCamera& camera, const StereoImages& images,
                             const std_msgs::Header& header, MountLog* mounts) {
  const auto base_from_camera = mount.BaseFromCamera(header.frame_id, header.stamp);
  if (!base_from_camera) {
    return session.Skip(frame.stamp_s, PoseStatus::kNoTransform, "no transform: " + mount.error());
  }
  if (mounts != nullptr) mounts->Add(frame.stamp_s, *base_from_camera);
  if (mount.IsSlewing(header.frame_id, header.stamp, *base_from_camera)) {
    return session.Skip(frame.stamp_s, PoseStatus::kHeadSlewing,
                        ToString(PoseStatus::kHeadSlewing));
  }
  return session.Process(frame, camera, images, *base_from_camera);
}

}  // namespace arfm_vo
