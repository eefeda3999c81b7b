#include "arfm_vo/features/surf.h"

#include "arfm_vo/base/check.h"
#include "arfm_vo/image/integral_image.h"

namespace arfm_vo {

class Surf::Workspace {
 public:
  IntegralImage integral;
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
  features.keypoints = SurfDetector(options_.detector).Detect(workspace_->integral);
  SurfDescriptor(options_.descriptor).Describe(workspace_->integral, features);
  return features;
}

}  // namespace arfm_vo
