#pragma once

#include <Eigen/Core>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "arfm_vo/mapping/known_map.h"

namespace arfm_vo {

/// Where the newest keyframe of a drive stands in a known map.
struct FoundPlace {
  size_t keyframe = 0;     ///< of the map, that showed the view
  Rigid3 map_from_camera;  ///< in that keyframe's map frame
};

/// Finds where the keyframes of a drive stand in a known map, by what they see alone. One view may
/// be like another place's; a place is found where the motion between keyframes that were
/// recognised one after the other is that between the places that they were recognised at.
class PlaceFinder {
 public:
  explicit PlaceFinder(const StereoCamera& camera) : recogniser_(camera) {}
  /// Knows those from `first` on that have points, too.
  void Add(const std::vector<KnownKeyframe>& known, size_t first);

  /// Looks for the newest keyframe of a drive, `number`, among places of other frames than
  /// `own_frame`; `known` is what was added, where it lies by now. `camera_from_world` tells where
  /// any of the drive's keyframes is known to be by now.
  std::optional<FoundPlace> Find(const std::vector<SeenPoint>& view, int number,
                                 const std::function<Rigid3(int)>& camera_from_world,
                                 const std::vector<KnownKeyframe>& known, int own_frame);
  /// What was recognised before is of another drive, or of other frames.
  void ForgetSightings() { sightings_.clear(); }

 private:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  struct Sighting {
    int number = 0;  ///< of the drive's keyframe
    int frame = 0;   ///< of the place
    Rigid3 camera_from_map;
    Matrix6 covariance;  ///< of the steps of BoxPlus(camera_from_map, .)
  };
  static bool Agree(const Sighting& earlier, const Sighting& newest,
                    const Rigid3& newest_from_earlier);

  PlaceRecogniser recogniser_;
  std::vector<size_t> places_;      ///< [places of recogniser_] their keyframes
  std::deque<Sighting> sightings_;  ///< the newest ones
};

}  // namespace arfm_vo
