#include "arfm_vo/ros/input/stereo_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

using testing::HasSubstr;
const StereoTopics kTopics{"/cam/left/image_rect", "/cam/right/image_rect", "/cam/left/camera_info",
                           "/cam/right/camera_info", "/cam/ground_truth"};

TEST(StereoInputCounts, NameTheTopicsThatAreSilent) {
  const StereoInputCounts before{10, 10, 10, 10, 10, 0};
  EXPECT_EQ((StereoInputCounts{12, 12, 12, 12, 12, 0}.Explain(before, kTopics)), "");
  EXPECT_EQ((StereoInputCounts{12, 12, 10, 12, 10, 0}.Explain(before, kTopics)),
            "no messages on /cam/left/camera_info");
  EXPECT_EQ((StereoInputCounts{10, 12, 10, 12, 10, 0}.Explain(before, kTopics)),
            "no messages on /cam/left/image_rect, /cam/left/camera_info");
}

TEST(StereoInputCounts, TellByHowMuchStampsDiffer) {
  const StereoInputCounts before, apart{5, 5, 5, 5, 0, -0.0032};
  EXPECT_EQ(
      apart.Explain(before, kTopics),
      "/cam/left/image_rect and /cam/right/image_rect have different stamps (3.200 ms apart)");
  EXPECT_THAT(apart.Remedy(before, kTopics, {}), HasSubstr("approx_sync:=true"));
  EXPECT_EQ((StereoInputCounts{5, 5, 5, 5, 0, 0}.Explain(before, kTopics)),
            "images and camera_info have different stamps");
}

/// What is advised where nothing came.
std::string RemedyForSilence(const std::set<std::string>& published) {
  return StereoInputCounts().Remedy({}, kTopics, published);
}

TEST(StereoInputCounts, AdviseRectificationWhereRawImagesArePublished) {
  const std::string remedy = RemedyForSilence({"/cam/left/image_raw", "/cam/right/image_raw"});
  EXPECT_THAT(remedy, HasSubstr("/cam/left/image_raw"));
  EXPECT_THAT(remedy, HasSubstr("rectify:=true"));
}

TEST(StereoInputCounts, AdviseDecompressionWhereOnlyCompressedImagesArePublished) {
  EXPECT_THAT(RemedyForSilence({"/cam/left/image_rect/compressed"}),
              HasSubstr("/cam/left/image_rect/compressed is there"));
}

TEST(StereoInputCounts, ListTheImagesThatArePublishedElsewhere) {
  const std::string remedy =
      RemedyForSilence({"/camera/infra1/image_rect_raw", "/camera/infra2/image_rect_raw", "/odom"});
  EXPECT_THAT(remedy, HasSubstr("nobody publishes /cam/left/image_rect"));
  EXPECT_THAT(remedy, HasSubstr("/camera/infra1/image_rect_raw, /camera/infra2/image_rect_raw"));
  EXPECT_THAT(remedy, HasSubstr("left_image:="));
  EXPECT_THAT(remedy, testing::Not(HasSubstr("/odom")));
}

TEST(StereoInputCounts, TellThatNoImageIsPublishedAtAll) {
  EXPECT_THAT(RemedyForSilence({"/tf"}), HasSubstr("no image is published at all"));
}

TEST(StereoInputCounts, TellThatAPublisherIsSilent) {
  EXPECT_THAT(RemedyForSilence(
                  {kTopics.left_image, kTopics.right_image, kTopics.left_info, kTopics.right_info}),
              HasSubstr("/cam/left/image_rect has a publisher that sends nothing"));
}

}  // namespace
}  // namespace arfm_vo
