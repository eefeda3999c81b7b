#pragma once

#include <map>
#include <optional>
#include <vector>

#include "arfm_vo/mapping/local_map.h"
#include "arfm_vo/mapping/map_update.h"
#include "arfm_vo/odometry/odometry_update.h"
#include "arfm_vo/odometry/trajectory.h"

namespace arfm_vo {

/// Remembers each frame of one epoch relative to its keyframe, so that what is found out later
/// about the keyframe moves the frame too. Of a long drive BoundFrames keeps fewer.
class TrajectoryLog {
 public:
  /// `first_frame` numbers the frames.
  explicit TrajectoryLog(size_t first_frame = 0) : first_frame_(first_frame) {}

  /// Takes a frame and where the keyframes of `map` are after it.
  void Add(const OdometryUpdate& update, const LocalMap& map);

  /// Takes a frame of which there is no pose.
  void AddLost(double stamp_s) { Push({stamp_s, false, 0, Rigid3()}); }

  /// Takes what a global adjustment found; the newest one counts.
  void Apply(const MapUpdate& update);

  /// The number of the frame that became a keyframe; that of the first frame for an unknown one.
  size_t FrameOf(KeyframeId keyframe) const;

  /// The pose of each frame in the adjusted world. Keyframes newer than the last adjustment hang on
  /// the newest one that took part. Lost frames are not interpolated.
  Trajectory Poses() const;

  /// Takes a pose in the odometry's world to that in the adjusted one; identity before the first
  /// adjustment.
  Rigid3 MapFromWorld() const;

 private:
  struct Frame {
    double stamp_s;
    bool is_tracked;
    KeyframeId keyframe;
    Rigid3 camera_from_keyframe;
  };
  struct KeyframePlace {
    size_t frame = 0;
    Rigid3 camera_from_world;
    std::optional<Rigid3> camera_from_map;
  };

  void Push(const Frame& frame);

  size_t first_frame_, num_frames_ = 0;
  std::vector<Frame> frames_;
  std::map<KeyframeId, KeyframePlace> keyframes_;
};

}  // namespace arfm_vo
