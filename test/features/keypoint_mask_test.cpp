#include "arfm_vo/features/keypoint_mask.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "base/folder_test.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

class KeypointMaskTest : public FolderTest {
 protected:
  /// The left `num_hidden` columns of 100x60 are black.
  std::string Write(int num_hidden) const {
    cv::Mat mask(60, 100, CV_8UC1, cv::Scalar(255));
    if (num_hidden > 0) mask.colRange(0, num_hidden).setTo(0);
    const std::string path = folder_ / "mask.png";
    cv::imwrite(path, mask);
    return path;
  }
  std::string Refusal(const std::string& path) const {
    return RefusalOf([&] { KeypointMask(path, {100, 60}); });
  }
};

Features FeaturesAt(const std::vector<float>& columns) {
  Features features;
  features.descriptors.create(static_cast<int>(columns.size()), 64, CV_32FC1);
  for (size_t i = 0; i < columns.size(); ++i) {
    features.keypoints.push_back({columns[i], 30, 2, 0, 1, 1});
    features.descriptors.row(static_cast<int>(i)).setTo(columns[i]);
  }
  return features;
}

TEST_F(KeypointMaskTest, DropsWhatIsUnderItAndWhatIsNearerThanAPatch) {
  const KeypointMask mask(Write(40), {100, 60});
  const Features shown = mask.WithoutHidden(FeaturesAt({0, 39, 47, 48, 99}));
  ASSERT_EQ(shown.size(), 2);
  EXPECT_EQ(shown.keypoints[0].x, 48);
  EXPECT_EQ(shown.keypoints[1].x, 99);
  ASSERT_EQ(shown.descriptors.rows, 2);
  EXPECT_EQ(shown.descriptors.at<float>(0, 63), 48) << "descriptors stay with their keypoints";
  EXPECT_EQ(shown.descriptors.at<float>(1, 0), 99);
}

TEST_F(KeypointMaskTest, NoFileHidesNothing) {
  EXPECT_EQ(KeypointMask("", {100, 60}).WithoutHidden(FeaturesAt({0, 50})).size(), 2);
}

TEST_F(KeypointMaskTest, AWrongFileIsRefusedWithItsName) {
  EXPECT_EQ(Refusal(folder_ / "none.png"),
            "left_mask: " + (folder_ / "none.png").string() + ": cannot be read");
  EXPECT_NE(Refusal(Write(0)).find("black nowhere"), std::string::npos);
  EXPECT_NE(Refusal(Write(100)).find("black everywhere"), std::string::npos);
  cv::imwrite(folder_ / "small.png", cv::Mat::ones(10, 20, CV_8UC1));
  EXPECT_NE(Refusal(folder_ / "small.png").find("its size is 20x10, the camera's is 100x60"),
            std::string::npos);
}

}  // namespace
}  // namespace arfm_vo
