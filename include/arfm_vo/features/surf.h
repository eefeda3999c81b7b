#pragma once

#include <limits>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/features/features.h"
#include "arfm_vo/features/surf_descriptor.h"
#include "arfm_vo/features/surf_detector.h"

namespace arfm_vo {

struct SurfOptions {
  SurfDetectorOptions detector;
  SurfDescriptorOptions descriptor;
  /// Smooth the image by (1 2 1) / 4 before: box filters and wavelets of whole pixels alias.
  bool smooth = true;
  int threads = 1;  ///< for one image
  /// Larger images are halved until they have no more: their smallest blobs are not needed.
  double max_pixels = std::numeric_limits<double>::infinity();

  /// Throws std::invalid_argument naming the key that is out of range.
  void Check() const;
  ARFM_FIELDS(detector, descriptor, smooth, threads, max_pixels)
};

/// Grey image to SURF features. Memory is kept from call to call, nothing else: the same image
/// gives the same features, whatever came before and however many threads work. Not to be shared
/// between threads: one object each.
class Surf {
 public:
  /// Throws std::invalid_argument where an option is wrong.
  explicit Surf(const SurfOptions& options);
  ~Surf();

  /// Features ordered by row, then column, of their maxima. Throws std::invalid_argument unless
  /// `grey` is CV_8UC1 and not empty.
  Features Extract(const cv::Mat& grey);

 private:
  class Workspace;
  SurfOptions options_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace arfm_vo
