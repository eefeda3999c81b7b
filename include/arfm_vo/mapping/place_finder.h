#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <vector>

#include "arfm_vo/mapping/known_map.h"

namespace arfm_vo {

/// Where a drive stands in a known map.
struct FoundPlace {
  size_t keyframe = 0;     ///< of the map, that showed the view
  Rigid3 map_from_camera;  ///< in that keyframe's map frame
  Rigid3 camera_from_keyframe;
  Eigen::Matrix<double, 6, 6> covariance;  ///< of the steps of BoxPlus(camera_from_keyframe, .)
};

/// Finds where a drive stands in a known map by what it sees alone. A place is found where a view
/// shows it as chance never makes one look like it, and some of the views before it did so too, as
/// the motion between them has it.
class PlaceFinder {
 public:
  /// So many views before one must agree with it, each verified by `pose`.
  explicit PlaceFinder(const StereoCamera& camera, int num_agreeing = 1,
                       const PoseEstimatorOptions& pose = RecognitionPose())
      : recogniser_(camera, pose), num_agreeing_(num_agreeing) {}
  /// Knows those from `first` on that have points, too.
  void Add(const std::vector<KnownKeyframe>& known, size_t first);

  /// Looks for a drive's next view among places of other frames than `own_frame` (-1: of all);
  /// `known` is what was added, where it lies by now.
  std::optional<FoundPlace> Find(const std::vector<SeenPoint>& view, const Rigid3& odom_from_camera,
                                 const std::vector<KnownKeyframe>& known, int own_frame = -1);
  /// Whether the last view was recognised, confirmed or not.
  bool has_recognised() const { return has_recognised_; }
  /// What was recognised before is of another drive, or of other frames.
  void ForgetSightings() { sightings_.clear(); }

 private:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  struct Sighting {
    Rigid3 odom_from_camera;
    int frame = 0;  ///< of the place
    Rigid3 camera_from_map;
    Matrix6 covariance;  ///< of the steps of BoxPlus(camera_from_map, .)
  };
  static bool Agree(const Sighting& earlier, const Sighting& newest);

  PlaceRecogniser recogniser_;
  int num_agreeing_;
  bool has_recognised_ = false;
  std::vector<size_t> places_;      ///< [places of recogniser_] their keyframes
  std::deque<Sighting> sightings_;  ///< the newest ones
};

}  // namespace arfm_vo
