#pragma once

#include <boost/container/flat_map.hpp>
#include <deque>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/mapping/keyframe.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

struct LocalMapOptions {
  int max_keyframes = 16;           ///< older ones leave the map with the points only they see
  int max_missed_frames = 8;        ///< in view, in a row: then a point is looked for no more
  int max_landmarks_in_view = 600;  ///< new points are added up to this number
  int grid_cell_px = 40;            ///< new points are spread over cells of this size
  double min_separation_px = 6;     ///< a new point keeps this distance from the known ones

  void Check() const;
  ARFM_FIELDS(max_keyframes, max_missed_frames, max_landmarks_in_view)
};

/// Side by side in memory: all of them are looked at in each frame.
using Landmarks = boost::container::flat_map<LandmarkId, Landmark>;

/// The points that the newest keyframes saw, and those keyframes (Fig. 3). A frame is localised
/// against all points in its field of view, whichever keyframe they come from.
class LocalMap {
 public:
  LocalMap(const StereoCamera& camera, const LocalMapOptions& options);

  /// Adds a keyframe of a localised frame. `tracked` are its observations of known landmarks,
  /// sorted by landmark; new landmarks are made from the stereo points that lie apart from them.
  /// `contradicting`: known ones that moved on their own; new ones among them are taken to.
  const Keyframe& AddKeyframe(const StereoFrame& frame, const cv::Mat& left,
                              const Rigid3& camera_from_world, const LandmarkObservations& tracked,
                              const LandmarkObservations& contradicting = {});

  /// The landmarks in the field of view of a camera, in front of it, sorted by id; without those
  /// that were missed too often of late.
  std::vector<const Landmark*> LandmarksInView(const Rigid3& camera_from_world,
                                               double border_px) const;

  /// Counts for each of the `expected` landmarks whether it is among `tracked` (sorted by
  /// landmark), which are the ground with this probability.
  void CountSightings(const std::vector<LandmarkId>& expected, const LandmarkObservations& tracked,
                      double probability = 1);
  /// Counts against those that were seen elsewhere than `tracked` says, most of all those that
  /// agree with a rival (all sorted by landmark).
  void CountContradictions(const LandmarkObservations& contradicting,
                           const LandmarkObservations& of_rival,
                           const LandmarkObservations& tracked, double probability);

  /// The probability that something large has come before the scene, to which new landmarks may
  /// belong that stand where known ones vanished.
  double arrived() const { return arrived_; }
  void SetArrived(double probability) { arrived_ = probability; }

  const std::deque<Keyframe>& keyframes() const { return keyframes_; }
  const Landmarks& landmarks() const { return landmarks_; }
  const Keyframe* FindKeyframe(KeyframeId id) const;
  KeyframeId next_keyframe() const { return next_keyframe_; }
  /// Those that no keyframe before the newest saw, sorted by id.
  std::vector<Landmark> NewestLandmarks() const;

  /// Moves a keyframe or landmark to its refined place; unknown ids are passed over.
  void MoveKeyframe(KeyframeId id, const Rigid3& camera_from_world);
  void MoveLandmark(LandmarkId id, const Eigen::Vector3d& x_in_world,
                    const Eigen::Matrix3d& covariance);
  /// Forgets that a keyframe saw a landmark; a landmark that nobody sees leaves the map.
  void RemoveObservation(KeyframeId keyframe, LandmarkId landmark);
  /// The right camera has turned since the keyframe before the newest.
  void Turn(const RightTurn& turn) { keyframes_.back().right_turn = turn; }
  /// Forgets what the right camera saw in the keyframes before this one.
  void ForgetRight(KeyframeId before);
  /// Applies `new_from_old` to the whole map: all poses and points.
  void Transform(const Rigid3& new_from_old);
  void Clear();

 private:
  void AddNewLandmarks(const StereoFrame& frame, const LandmarkObservations& contradicting,
                       Keyframe& keyframe);
  Landmark& AddLandmark(const StereoFrame& frame, const StereoPoint& point, Keyframe& keyframe);
  void RemoveOldestKeyframe();
  void MoveReference(Landmark& landmark, const Rigid3& old_from_world) const;

  StereoCamera camera_;
  LocalMapOptions options_;
  std::deque<Keyframe> keyframes_;
  Landmarks landmarks_;
  double arrived_ = 0;
  cv::Mat spare_image_;  ///< of a keyframe that left: fresh memory costs more than the copy
  KeyframeId next_keyframe_ = 0;
  LandmarkId next_landmark_ = 0;
};

}  // namespace arfm_vo
