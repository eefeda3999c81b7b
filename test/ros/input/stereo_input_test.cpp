#include "arfm_vo/ros/input/stereo_input.h"

#include <gmock/gmock.h>

#include <vector>

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

TEST(StereoInputCounts, AdviseByWhatIsPublishedWhereNothingCame) {
  const struct {
    std::set<std::string> published;
    std::vector<std::string> advice;
  } rows[] = {
      {{"/cam/left/image_raw", "/cam/right/image_raw"}, {"/cam/left/image_raw", "rectify:=true"}},
      {{"/cam/left/image_rect/compressed"}, {"/cam/left/image_rect/compressed is there"}},
      {{"/camera/infra1/image_rect_raw", "/camera/infra2/image_rect_raw", "/odom"},
       {"nobody publishes /cam/left/image_rect",
        "/camera/infra1/image_rect_raw, /camera/infra2/image_rect_raw", "left_image:="}},
      {{"/tf"}, {"no image is published at all"}},
      {{kTopics.left_image, kTopics.right_image, kTopics.left_info, kTopics.right_info},
       {"/cam/left/image_rect has a publisher that sends nothing"}}};
  for (const auto& [published, advice] : rows) {
    const std::string remedy = StereoInputCounts().Remedy({}, kTopics, published);
    for (const std::string& part : advice) EXPECT_THAT(remedy, HasSubstr(part));
    EXPECT_THAT(remedy, testing::Not(HasSubstr("/odom")));
  }
}

}  // namespace
}  // namespace arfm_vo
