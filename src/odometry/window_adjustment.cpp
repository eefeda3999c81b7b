#include "window_adjustment.h"

namespace arfm_vo {

void WindowAdjustment::Start(const StereoCamera& camera, const StereoCorrection& correction,
                             const LocalMap& map, const LocalBundleOptions& options) {
  pending_ = std::async(std::launch::async, [&camera, &correction, &map, &options] {
    AdjustedWindow window;
    window.bundle = MakeLocalBundle(camera, correction, map, options.num_keyframes);
    const BundleProblem& problem = window.bundle.problem;
    window.result = AdjustBundle(problem, options.solver);
    window.information = FindPoseInformation(problem, window.result, options.solver);
    return window;
  });
}

void WindowAdjustment::Finish(LocalMap& map, PathCovariance& covariance) {
  if (!pending_.valid()) return;
  const AdjustedWindow adjusted = pending_.get();
  ApplyLocalBundle(adjusted.bundle, adjusted.result, map);
  covariance.Update(adjusted.bundle, adjusted.information);
}

}  // namespace arfm_vo
