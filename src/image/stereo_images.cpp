#include "arfm_vo/image/stereo_images.h"

#include "arfm_vo/base/check.h"

namespace arfm_vo {

void StereoImages::Check() const {
  Require(!left.empty() && !right.empty(), "stereo images: an image is empty");
  Require(left.type() == CV_8UC1 && right.type() == CV_8UC1,
          "stereo images: images must be 8 bit grey");
  Require(left.size() == right.size(), "stereo images: left and right differ in size");
}

}  // namespace arfm_vo
