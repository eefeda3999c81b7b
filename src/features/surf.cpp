#include "arfm_vo/features/surf.h"

#include "arfm_vo/base/check.h"
#include "arfm_vo/image/integral_image.h"
#include "fast_surf.h"

namespace arfm_vo {

class Surf::Workspace {
 public:
  IntegralImage integral;
  FastMaximumFinder finder;
};

void SurfOptions::Check() const {
  detector.Check();
  Require(threads >= 1 && threads <= 64, "surf.threads must be in 1..64");
}

Surf::Surf(const SurfOptions& options)
    : options_(options), workspace_(std::make_unique<Workspace>()) {
  options_.Check();
}

Surf::~Surf() = default;

Features Surf::Extract(const cv::Mat& grey) {
  workspace_->integral.Compute(grey);
  Features features;
  const IntegralImage& integral = workspace_->integral;
  if (options_.use_fast_path) {
    const auto maxima = workspace_->finder.Find(integral, options_.detector, options_.threads);
    features.keypoints = SelectKeypoints(integral, maxima, options_.detector);
    DescribeFast(integral, options_.descriptor, options_.threads, features);
  } else {
    features.keypoints =
        SelectKeypoints(integral, FindMaxima(integral, options_.detector), options_.detector);
    SurfDescriptor(options_.descriptor).Describe(integral, features);
  }
  return features;
}

}  // namespace arfm_vo
