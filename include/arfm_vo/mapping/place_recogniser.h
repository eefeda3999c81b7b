#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "arfm_vo/geometry/stereo_correction.h"
#include "arfm_vo/mapping/landmark.h"
#include "arfm_vo/matching/appearance.h"
#include "arfm_vo/matching/descriptor_index.h"
#include "arfm_vo/pose/pose_estimator.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

/// RecognisedPlace::log_false_alarms from which on a place counts wherever it is. Ground that looks
/// alike everywhere gave down to -101 in a view of another place.
constexpr double kSureLogFalseAlarms = -300;

/// How a place is verified: it is not known again by a few points that fit by chance.
PoseEstimatorOptions RecognitionPose();

/// A point that a place shows.
struct PlacePoint {
  LandmarkId id = 0;
  Eigen::Vector3d x_in_place;  ///< m, in the frame of the place's left camera
  Appearance appearance;
};
using Place = std::vector<PlacePoint>;

/// A point that the camera sees now.
struct SeenPoint {
  LandmarkId id = 0;  ///< where it is a landmark
  Appearance appearance;
  PointObservation observation;  ///< where; its x_in_world is not known
};
/// All keypoints of a frame; those that both cameras see in both.
std::vector<SeenPoint> PointsSeen(const StereoCamera& camera, const StereoCorrection& correction,
                                  const StereoFrame& frame);

struct RecognisedPlace {
  int place = 0;  ///< its number
  /// World: the place's camera. The covariance is at least that of a place, whose points err
  /// together.
  PoseEstimate pose;
  /// Logarithm of how many poses as good chance is expected to give (a contrario: Moisan and
  /// Stival, IJCV 2004): how often so many matches would agree where each does as often as what is
  /// seen of one point agrees with the others.
  double log_false_alarms = 0;
  std::vector<std::pair<LandmarkId, LandmarkId>> same;  ///< (of the place, seen)
};

/// Finds the place that a view shows among places seen before, wherever the camera is believed to
/// be: each point seen votes for the places with the points that look most like it; those with most
/// votes are verified by the pose against their points (EPnP, RANSAC).
class PlaceRecogniser {
 public:
  /// Brings a point of a place up to date; false: it is not to be looked for.
  using Revise = std::function<bool(int place, PlacePoint& point)>;

  /// `pose`: how a place is verified.
  explicit PlaceRecogniser(const StereoCamera& camera,
                           const PoseEstimatorOptions& pose = RecognitionPose())
      : camera_(camera), pose_(pose) {
    camera.Check();
  }

  /// The next place, which is known by its number from 0 on. Some must have 25 points.
  void Add(Place place);
  /// Nothing where no place shows the view.
  std::optional<RecognisedPlace> Find(
      const std::vector<SeenPoint>& view,
      const Revise& revise = [](int, PlacePoint&) { return true; }) const;

 private:
  std::vector<int> CountVotes(const std::vector<SeenPoint>& view, const Revise& revise) const;
  std::optional<RecognisedPlace> Verify(int place, const std::vector<SeenPoint>& view,
                                        const Revise& revise) const;

  StereoCamera camera_;
  PoseEstimatorOptions pose_;
  std::vector<Place> places_;
  std::optional<DescriptorIndex> index_;      ///< made for the first place that has enough points
  std::vector<std::pair<int, int>> indexed_;  ///< [index_] (place, point)
};

}  // namespace arfm_vo
