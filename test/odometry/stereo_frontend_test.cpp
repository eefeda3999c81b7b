#include "arfm_vo/odometry/stereo_frontend.h"

#include <gtest/gtest.h>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/allocator_interface.h>
#else
#include <malloc.h>
#endif

namespace arfm_vo {
namespace {

/// What is allocated and not freed, kB.
double HeldKb() {
#ifdef __SANITIZE_ADDRESS__
  return static_cast<double>(__sanitizer_get_current_allocated_bytes()) / 1e3;
#else
  return static_cast<double>(mallinfo2().uordblks) / 1e3;
#endif
}

TEST(StereoFrontend, MemoryDoesNotGrowWithTheNumberOfPairs) {
  const StereoCamera camera{50, 50, 31.5, 23.5, 0.5, 64, 48};
  StereoFrontend frontend(camera, FrontendOptions());
  const cv::Mat grey = cv::Mat::zeros(camera.height, camera.width, CV_8UC1);
  double before_kb = 0;
  for (int i = 0; i < 600; ++i) {
    if (i == 100) before_kb = HeldKb();
    frontend.Process({0.1 * i, grey, grey});
  }
  EXPECT_LT(HeldKb() - before_kb, 100);
}

}  // namespace
}  // namespace arfm_vo
