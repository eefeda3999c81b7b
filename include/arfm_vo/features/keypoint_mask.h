#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "arfm_vo/features/features.h"

namespace arfm_vo {

/// Where an image shows the vehicle itself, which moves with the camera: keypoints there tell of no
/// motion.
class KeypointMask {
 public:
  /// Hides what is black in a PNG file of `size`, and what is nearer to it than the patch around a
  /// keypoint reaches. An empty `path` hides nothing. Throws std::invalid_argument naming a file
  /// that cannot be read, has another size, or hides all or nothing.
  KeypointMask(const std::string& path, const cv::Size& size);

  bool Hides(const Keypoint& keypoint) const;
  /// The features that are not hidden, in their order.
  Features WithoutHidden(Features features) const;

 private:
  cv::Mat shows_;  // not zero where keypoints are used; empty: everywhere
};

}  // namespace arfm_vo
