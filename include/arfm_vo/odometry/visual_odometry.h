#pragma once

#include <future>
#include <optional>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/odometry/placed_map.h"
#include "arfm_vo/odometry/session.h"
#include "arfm_vo/odometry/stereo_frontend.h"
#include "arfm_vo/odometry/trajectory.h"

namespace arfm_vo {

struct OdometryOptions {
  FrontendOptions frontend;
  LocalOdometryOptions odometry;
  bool adjust_globally = true;  ///< on the way, and at the end
  GlobalMapOptions global;

  void Check() const;
  ARFM_FIELDS(frontend, odometry, adjust_globally, global)
};

/// The whole chain in process: what arfm_node, pose_node and ba_node run, without ROS, and with the
/// adjustments on a thread. Repeatable: the same input gives the same output to the last bit.
class VisualOdometry {
 public:
  /// Throws std::invalid_argument where the camera or an option is wrong.
  VisualOdometry(const StereoCamera& camera, const OdometryOptions& options);
  VisualOdometry(VisualOdometry&&) = delete;  // a thread works on its map

  /// What an earlier drive learnt of the stereo correction; before the first pair.
  void SetCorrection(const CorrectionBelief& correction);

  /// Takes the next pair, later than the one before. Throws std::invalid_argument where the images
  /// do not fit the camera.
  SessionUpdate Process(const StereoImages& images);
  /// The same for a pair whose frame was made elsewhere.
  SessionUpdate Process(const FrameOnRequest& frame, const StereoImages& images);

  /// Global bundle adjustment over all keyframes and points (Fig. 4) where it is switched on, then
  /// the pose of every frame, relative to its refined keyframe.
  Trajectory Finish();
  int num_loops() const { return map_.num_loops(); }  ///< closed so far
  /// What the drive has told of the stereo correction, where adjustments are switched on.
  const std::optional<CorrectionBelief>& correction() const { return map_.correction(); }

 private:
  struct Added {
    KeyframeId newest;
    std::vector<PlacedKeyframe> others;  ///< that came after it, and wait for its adjustment
  };
  void AddWaiting();
  /// Begins an adjustment where the newest keyframe that was added calls for one.
  void TakeAdded();
  void TakeAdjustment();

  StereoCamera camera_;
  OdometryOptions options_;
  StereoFrontend frontend_;
  Session session_;
  PlacedMap map_;
  std::vector<PlacedKeyframe> waiting_;  ///< to join the map, in their order
  /// On a thread of their own, each of map_; what else uses it must wait.
  std::future<Added> added_;  ///< the next pair's images are looked at meanwhile
  std::future<std::optional<MapUpdate>> adjustment_;
  size_t adjusted_at_ = 0;  ///< the frame before which the adjustment is taken over
};

}  // namespace arfm_vo
