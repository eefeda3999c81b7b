#include "arfm_vo/features/surf.h"

#include <opencv2/imgproc.hpp>

#include "arfm_vo/base/check.h"
#include "arfm_vo/image/integral_image.h"
#include "surf_stages.h"

namespace arfm_vo {

class Surf::Workspace {
 public:
  /// Of the same size; valid until the next call.
  const cv::Mat& Smooth(const cv::Mat& grey) {
    if (grey.empty()) return grey;
    // A region of interest ends at its edge: what lies beyond it is not the picture.
    cv::GaussianBlur(grey, smooth_, cv::Size(3, 3), 0, 0, cv::BORDER_DEFAULT | cv::BORDER_ISOLATED);
    return smooth_;
  }

  IntegralImage integral;
  MaximumFinder finder;

 private:
  cv::Mat smooth_;
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
  workspace_->integral.Compute(options_.smooth ? workspace_->Smooth(grey) : grey);
  Features features;
  const IntegralImage& integral = workspace_->integral;
  MaximumFinder& finder = workspace_->finder;
  const auto maxima = finder.Find(integral, options_.detector, options_.threads);
  features.keypoints = SelectKeypoints(integral, finder.scale_space(), maxima, options_.detector);
  DescribeKeypoints(integral, options_.descriptor, options_.threads, features);
  return features;
}

}  // namespace arfm_vo
