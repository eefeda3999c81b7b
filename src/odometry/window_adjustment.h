#pragma once

#include <future>
#include <optional>

#include "arfm_vo/bundle_adjustment/pose_information.h"
#include "arfm_vo/odometry/local_bundle.h"

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
  /// What is given must stay as it is until Take().
  void Start(const StereoCamera& camera, const StereoCorrection& correction, const LocalMap& map,
             const LocalBundleOptions& options);
  /// Waits for what was started; nothing where nothing was.
  std::optional<AdjustedWindow> Take();

 private:
  std::future<AdjustedWindow> pending_;
};

}  // namespace arfm_vo
