#include "arfm_vo/odometry/stereo_frontend.h"

#include <gtest/gtest.h>

#include "base/held_memory.h"

namespace arfm_vo {
namespace {

TEST(StereoFrontend, MemoryDoesNotGrowWithTheNumberOfPairs) {
  const StereoCamera camera{50, 50, 31.5, 23.5, 0.5, 64, 48};
  StereoFrontend frontend(camera, FrontendOptions());
  const cv::Mat grey = cv::Mat::zeros(camera.height, camera.width, CV_8UC1);
  double before_mb = 0;
  for (int i = 0; i < 600; ++i) {
    if (i == 100) before_mb = HeldMemoryMb();
    frontend.Process({0.1 * i, grey, grey});
  }
  EXPECT_LT(HeldMemoryMb() - before_mb, 0.1);
}

}  // namespace
}  // namespace arfm_vo
