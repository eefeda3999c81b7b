#include "arfm_vo/image/halved_images.h"

#include <opencv2/imgproc.hpp>

namespace arfm_vo {

HalvedImages Halve(const cv::Mat& grey) {
  HalvedImages halved;
  if (grey.empty()) return halved;
  cv::buildPyramid(grey, halved, kMostHalved);
  halved.erase(halved.begin());
  return halved;
}

}  // namespace arfm_vo
