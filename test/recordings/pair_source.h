#pragma once

#include <opencv2/core/mat.hpp>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/stereo_images.h"

namespace arfm_vo {

/// A pair of a recording as it would be without a fault, and what is true of it.
struct TruePair {
  StereoImages images;
  /// CV_32FC1, z of the left camera's pixels, m: infinity in the sky, 0 where it is not known.
  cv::Mat depth_m;
};

/// A recording whose truth is known, before a fault, light and noise are put in.
class PairSource {
 public:
  virtual ~PairSource() = default;
  virtual const StereoCamera& camera() const = 0;
  virtual int size() const = 0;
  virtual const Rigid3& WorldFromLeft(int pair) const = 0;
  virtual TruePair Take(int pair) const = 0;
};

}  // namespace arfm_vo
