#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "arfm_vo/base/random.h"

namespace arfm_vo {

/// A random texture known everywhere: Gaussian blobs of one size, so that an image of it moved by
/// any fraction of a pixel is exact but for the rounding to 8 bit.
class BlobTexture {
 public:
  BlobTexture(int size_px, double blob_sigma_px, int seed)
      : size_px_(size_px), blob_sigma_px_(blob_sigma_px) {
    RandomEngine engine(seed);
    const auto count = static_cast<int>(size_px * size_px / (4 * blob_sigma_px * blob_sigma_px));
    for (int i = 0; i < count; ++i) {
      const double x = RandomUnit(engine) * size_px, y = RandomUnit(engine) * size_px;
      blobs_.push_back({x, y, 120 * (RandomUnit(engine) - 0.5)});
    }
  }

  /// The texture magnified by `scale` about the middle and then moved by (dx, dy), with Gaussian
  /// noise.
  cv::Mat Render(double dx, double dy, double noise = 0, int seed = 1, double scale = 1) const {
    cv::Mat sum(size_px_, size_px_, CV_64F, cv::Scalar(128));
    const double middle = 0.5 * size_px_, sigma = blob_sigma_px_ * scale;
    const int reach = static_cast<int>(4 * sigma + 2);
    for (const auto& [blob_x, blob_y, height] : blobs_) {
      const double x = middle + (blob_x - middle) * scale + dx;
      const double y = middle + (blob_y - middle) * scale + dy;
      const int left = static_cast<int>(x), top = static_cast<int>(y);
      for (int v = std::max(0, top - reach); v < std::min(size_px_, top + reach); ++v) {
        for (int u = std::max(0, left - reach); u < std::min(size_px_, left + reach); ++u) {
          const double squared = (u - x) * (u - x) + (v - y) * (v - y);
          sum.at<double>(v, u) += height * std::exp(-squared / (2 * sigma * sigma));
        }
      }
    }
    AddNoise(sum, noise, seed);
    cv::Mat image;
    sum.convertTo(image, CV_8U);
    return image;
  }

 private:
  static void AddNoise(cv::Mat& image, double sigma, int seed) {
    RandomEngine engine(seed);
    for (int i = 0; i < static_cast<int>(image.total()); ++i) {
      double sum = -6;  // twelve uniform numbers make a good Gaussian
      for (int k = 0; k < 12; ++k) sum += RandomUnit(engine);
      image.ptr<double>()[i] += sigma * sum;
    }
  }

  int size_px_;
  double blob_sigma_px_;
  std::vector<std::array<double, 3>> blobs_;  ///< x, y, height
};

}  // namespace arfm_vo
