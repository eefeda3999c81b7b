#include "arfm_vo/features/surf.h"

#include <opencv2/imgproc.hpp>
#include <vector>

#include "arfm_vo/base/check.h"
#include "arfm_vo/image/integral_image.h"
#include "surf_stages.h"

namespace arfm_vo {

namespace {

constexpr double kLeastPixels = 1e4;

/// From an image made of means of `size` x `size` pixels to that image.
void Enlarge(int size, std::vector<Keypoint>& keypoints) {
  const auto factor = static_cast<float>(size);
  for (Keypoint& keypoint : keypoints) {
    keypoint.x = factor * keypoint.x + 0.5F * (factor - 1);
    keypoint.y = factor * keypoint.y + 0.5F * (factor - 1);
    keypoint.scale *= factor;
  }
}

}  // namespace

class Surf::Workspace {
 public:
  /// The mean of each `size` x `size` pixels; valid until the next call.
  const cv::Mat& Reduce(const cv::Mat& grey, int size) {
    if (size == 1) return grey;
    const cv::Rect whole(0, 0, grey.cols / size * size, grey.rows / size * size);
    cv::resize(grey(whole), small_, whole.size() / size, 0, 0, cv::INTER_AREA);
    return small_;
  }
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
  cv::Mat small_, smooth_;
};

void SurfOptions::Check() const {
  detector.Check();
  Require(threads >= 1 && threads <= 64, "surf.threads must be in 1..64");
  Require(max_pixels >= kLeastPixels, "surf.max_pixels must be at least 10000");
}

Surf::Surf(const SurfOptions& options)
    : options_(options), workspace_(std::make_unique<Workspace>()) {
  options_.Check();
}

Surf::~Surf() = default;

Features Surf::Extract(const cv::Mat& grey) {
  int size = 1;
  while (static_cast<double>(grey.total()) > options_.max_pixels * size * size) size *= 2;
  const cv::Mat& reduced = workspace_->Reduce(grey, size);
  workspace_->integral.Compute(options_.smooth ? workspace_->Smooth(reduced) : reduced);
  Features features;
  const IntegralImage& integral = workspace_->integral;
  MaximumFinder& finder = workspace_->finder;
  const auto maxima = finder.Find(integral, options_.detector, options_.threads);
  features.keypoints = SelectKeypoints(integral, finder.scale_space(), maxima, options_.detector);
  DescribeKeypoints(integral, options_.descriptor, options_.threads, features);
  Enlarge(size, features.keypoints);
  return features;
}

}  // namespace arfm_vo
