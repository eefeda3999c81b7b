#pragma once

#include <future>

#include "arfm_vo/bundle_adjustment/pose_information.h"
#include "arfm_vo/odometry/local_bundle.h"
#include "arfm_vo/odometry/path_covariance.h"

namespace arfm_vo {

/// The newest keyframes, adjusted.
struct AdjustedWindow {
  LocalBundle bundle;
  BundleResult result;
  PoseInformation information;
};

/// Adjusts the newest keyframes on a thread of its own.
class WindowAdjustment {
 public:
  /// What is given must stay as it is until Finish().
  void Start(const StereoCamera& camera, const StereoCorrection& correction, const LocalMap& map,
             const LocalBundleOptions& options);
  /// Waits for what was started, and takes it over.
  void Finish(LocalMap& map, PathCovariance& covariance);

 private:
  std::future<AdjustedWindow> pending_;
};

}  // namespace arfm_vo
