#pragma once

#include <future>
#include <map>
#include <optional>
#include <vector>

#include "arfm_vo/odometry/global_map.h"
#include "arfm_vo/odometry/local_odometry.h"
#include "arfm_vo/odometry/stereo_frontend.h"
#include "arfm_vo/odometry/trajectory.h"

namespace arfm_vo {

struct OdometryOptions {
  FrontendOptions frontend;
  LocalOdometryOptions odometry;
  bool adjust_globally = true;  ///< at the end, and on long drives on the way
  /// What the first 10, 20, 40.. keyframes, up to this many, say of the stereo correction is taken
  /// over on the way: better poses as they come, at the cost of these adjustments. 0: never; the
  /// adjustment at the end finds the correction anyhow.
  int max_calibration_keyframes = 0;
  GlobalMapOptions global;

  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("frontend", frontend);
    visit("odometry", odometry);
    visit("adjust_globally", adjust_globally);
    visit("max_calibration_keyframes", max_calibration_keyframes);
    visit("global", global);
  }
};

/// Stereo visual odometry in process: the same floors as the node chain, without ROS. Repeatable:
/// the same input gives the same output to the last bit.
class VisualOdometry {
 public:
  /// Throws std::invalid_argument where the camera or an option is wrong.
  VisualOdometry(const StereoCamera& camera, const OdometryOptions& options);
  VisualOdometry(VisualOdometry&&) = delete;  // a thread works on its map

  /// Takes the next pair, later than the one before. Throws std::invalid_argument where the images
  /// do not fit the camera.
  OdometryUpdate Process(const StereoImages& images);
  /// The same for a pair whose frame was made elsewhere.
  OdometryUpdate Process(const StereoFrame& frame, const StereoImages& images);

  /// Global bundle adjustment over all keyframes and points (Fig. 4) where it is switched on, then
  /// the pose of every frame, relative to its refined keyframe.
  Trajectory Finish();
  int num_loops() const { return global_.num_loops(); }  ///< closed so far

 private:
  /// A frame's pose relative to the keyframe it was localised beside.
  struct Frame {
    double stamp_s;
    bool is_tracked;
    KeyframeId keyframe;
    Rigid3 camera_from_keyframe;
  };

  void Add(KeyframeRecord keyframe);
  void AdjustIfDue();
  void TakeAdjustment();
  void Remember(const OdometryUpdate& update);

  OdometryOptions options_;
  StereoFrontend frontend_;
  LocalOdometry local_;
  GlobalMap global_;
  int next_calibration_;                 ///< at this number of keyframes
  int next_adjustment_;                  ///< the same, of the global map for its own sake
  std::vector<KeyframeRecord> waiting_;  ///< for the end of the adjustment, to join the map
  std::future<std::optional<MapUpdate>> adjustment_;  ///< of global_; what else uses it must wait
  bool is_calibration_ = false;  ///< then the local map takes what the adjustment finds
  size_t adjusted_at_ = 0;       ///< the frame before which the adjustment is taken over
  std::vector<Frame> frames_;
  std::map<KeyframeId, Rigid3> keyframe_from_world_;
};

}  // namespace arfm_vo
