#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/mapping/local_map.h"
#include "arfm_vo/mapping/place_recogniser.h"

namespace arfm_vo {

/// Where a frame was taken that the archive knows.
struct ArchivedPlace {
  PoseEstimate pose;
  double log_false_alarms = 0;  ///< RecognisedPlace
  /// As pose.covariance, but against the first camera of all.
  Eigen::Matrix<double, 6, 6> covariance_from_start = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Keyframes that left the local map, as places to look for a frame that the map does not know. A
/// bounded number, spread over different views, denser in the recent past.
class KeyframeArchive {
 public:
  KeyframeArchive(const StereoCamera& camera, int max_keyframes)
      : camera_(camera), max_keyframes_(max_keyframes) {}

  /// Takes up a keyframe of `map`, newer than all before, with the landmarks that others see too.
  /// `covariance` is the keyframe's against the first camera of all.
  void Add(const Keyframe& keyframe, const LocalMap& map,
           const Eigen::Matrix<double, 6, 6>& covariance);
  /// Nothing where no keyframe shows the frame's view.
  std::optional<ArchivedPlace> Find(const StereoFrame& frame, const StereoCorrection& correction);

  int size() const { return static_cast<int>(views_.size()); }
  void Clear() { *this = KeyframeArchive(camera_, max_keyframes_); }

 private:
  struct View {
    KeyframeId keyframe = 0;
    Rigid3 camera_from_world;
    Eigen::Matrix<double, 6, 6> covariance;
    double distance_m = 1;  ///< of the landmarks, the median
    Place place;
  };
  static double Difference(const View& a, const View& b);
  void DropLeastMissed();

  StereoCamera camera_;
  int max_keyframes_;
  std::vector<View> views_;                    ///< by keyframe
  std::optional<PlaceRecogniser> recogniser_;  ///< of `views_`, where one was needed since
};

}  // namespace arfm_vo
