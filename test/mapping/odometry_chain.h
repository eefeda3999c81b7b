#pragma once

#include <utility>

#include "arfm_vo/odometry/placed_map.h"
#include "arfm_vo/odometry/session.h"
#include "arfm_vo/odometry/stereo_frontend.h"

namespace arfm_vo {

constexpr size_t kMaxPoints = 1000000;  ///< of a map

/// What arfm_node, pose_node and ba_node do, one after the other.
class OdometryChain {
 public:
  explicit OdometryChain(const StereoCamera& camera, const Rigid3& base_from_camera = {})
      : camera_(camera),
        base_from_camera_(base_from_camera),
        frontend_(camera, {}),
        session_(LocalOdometryOptions()),
        map_({}) {}

  SessionUpdate Process(const StereoImages& images) {
    const StereoFrame frame = frontend_.Process(images);
    SessionUpdate update = session_.Process(frame, camera_, images, base_from_camera_);
    if (update.keyframe) {
      map_.Add(*update.keyframe);
      if (map_.IsAdjustmentDue())
        if (auto result = map_.Adjust()) session_.Offer(std::move(*result), map_.epoch());
    }
    if (update.update.pose.IsMeasured())
      map_.Localise(frame, update.odom_from_base * base_from_camera_);
    return update;
  }
  PlacedMap& map() { return map_; }

 private:
  StereoCamera camera_;
  Rigid3 base_from_camera_;
  StereoFrontend frontend_;
  Session session_;
  PlacedMap map_;
};

}  // namespace arfm_vo
