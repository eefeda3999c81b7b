#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "arfm_vo/pose/false_alarms.h"
#include "arfm_vo/pose/pose_estimator.h"
#include "point_spread.h"

namespace arfm_vo {

/// Generates and scores the hypotheses of RANSAC. What it is made of must outlive it.
class Consensus {
 public:
  Consensus(const StereoCamera& camera, const std::vector<PointObservation>& observations,
            const PoseEstimatorOptions& options);

  /// The poses in which the sample's points are seen so (P3P).
  std::vector<Rigid3> Solve(const std::vector<int>& sample) const;
  /// By all that agree: EPnP, then refined.
  std::optional<Rigid3> Improve(const std::vector<char>& is_inlier,
                                const PoseRefinementOptions& options) const;
  /// Fills [N] who agrees, and returns the score of MSAC, in votes.
  double Classify(const Rigid3& camera_from_world, std::vector<char>& is_inlier) const;

 private:
  /// NormalizedError of an observation, by its PointSpread.
  NormalizedReprojection FindError(int i, const Eigen::Matrix3d& rotation,
                                   const Eigen::Vector3d& translation) const;
  Eigen::Vector2d Ray(const PointObservation& observation) const {
    return {(observation.pixels.x() - camera_.cx) / camera_.fx,
            (observation.pixels.y() - camera_.cy) / camera_.fy};
  }

  const StereoCamera& camera_;
  const std::vector<PointObservation>& observations_;
  const int least_;  ///< fewer are no pose
  std::vector<PointSpread> spreads_;
};

}  // namespace arfm_vo
