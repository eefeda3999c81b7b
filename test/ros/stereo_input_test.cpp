#include "arfm_vo/ros/stereo_input.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

TEST(StereoInputCounts, SayWhatIsMissing) {
  const StereoInputCounts before{10, 10, 10, 10, 10, 0};
  EXPECT_EQ((StereoInputCounts{12, 12, 12, 12, 12, 0}.Explain(before)), "");
  EXPECT_EQ((StereoInputCounts{12, 12, 10, 12, 10, 0}.Explain(before)),
            "no messages on left/camera_info");
  EXPECT_EQ((StereoInputCounts{10, 12, 10, 12, 10, 0}.Explain(before)),
            "no messages on left/image_rect, left/camera_info");
}

TEST(StereoInputCounts, SayThatStampsDiffer) {
  const StereoInputCounts before;
  EXPECT_EQ((StereoInputCounts{5, 5, 5, 5, 0, -0.0032}.Explain(before)),
            "left and right have different stamps (3200 us apart): synchronise the cameras");
  EXPECT_EQ((StereoInputCounts{5, 5, 5, 5, 0, 0}.Explain(before)),
            "images and camera_info have different stamps");
}

}  // namespace
}  // namespace arfm_vo
