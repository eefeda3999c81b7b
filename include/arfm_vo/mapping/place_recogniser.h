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

struct PlaceRecogniserOptions {
  double max_distance = 0.6;  ///< of the descriptors of one point
  double max_ratio = 0.85;    ///< distance of the nearest over that of the nearest elsewhere
  int min_votes = 12;         ///< points of a view that look like those of a place
  int max_tries = 3;          ///< places, those with most votes first, that are verified
  DescriptorIndexOptions index;
  PoseEstimatorOptions pose = DefaultPose();

  /// A place is not known again by a few points that fit by chance.
  static PoseEstimatorOptions DefaultPose() {
    PoseEstimatorOptions options;
    options.min_inliers = 25;
    options.min_inlier_share = 0.25;
    options.sample_size = 4;
    options.ransac.max_iterations = 1800;  // finds a quarter that agrees at a probability of 0.999
    return options;
  }
  void Check() const;
};

/// A point that a place shows.
struct PlacePoint {
  LandmarkId id = 0;
  Eigen::Vector3d x_in_place;  ///< m, in the frame of the place's left camera
  Appearance appearance;
};
using Place = std::vector<PlacePoint>;

/// A point that the camera sees now.
struct SeenPoint {
  Appearance appearance;
  PointObservation observation;  ///< where; its x_in_world is not known
};
/// All keypoints of a frame; those that both eyes see in both.
std::vector<SeenPoint> PointsSeen(const StereoCamera& camera, const StereoCorrection& correction,
                                  const StereoFrame& frame);

struct RecognisedPlace {
  int place = 0;  ///< its number
  /// World: the place's camera. The covariance is at least that of a place, whose points err
  /// together.
  PoseEstimate pose;
  std::vector<std::pair<LandmarkId, int>> same;  ///< the place's points, and which of those seen
};

/// Finds the place that a view shows among places seen before, wherever the camera is believed to
/// be: each point seen votes for the places with the points that look most like it; those with most
/// votes are verified by the pose against their points (EPnP, RANSAC).
class PlaceRecogniser {
 public:
  /// Brings a point of a place up to date; false: it is not to be looked for.
  using Revise = std::function<bool(int place, PlacePoint& point)>;

  PlaceRecogniser(const StereoCamera& camera, const PlaceRecogniserOptions& options);

  /// The next place, which is known by its number from 0 on.
  void Add(Place place);
  std::optional<RecognisedPlace> Find(
      const std::vector<SeenPoint>& view,
      const Revise& revise = [](int, PlacePoint&) { return true; }) const;

 private:
  std::vector<int> FindMostAlike(const std::vector<SeenPoint>& view, const Revise& revise) const;
  std::vector<std::pair<int, int>> Match(const Place& place,
                                         const std::vector<SeenPoint>& view) const;
  std::optional<RecognisedPlace> Verify(int place, const std::vector<SeenPoint>& view,
                                        const Revise& revise) const;

  StereoCamera camera_;
  PlaceRecogniserOptions options_;
  std::vector<Place> places_;
  DescriptorIndex index_;
  std::vector<std::pair<int, int>> indexed_;  ///< [index_] (place, point)
};

}  // namespace arfm_vo
