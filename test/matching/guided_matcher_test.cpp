#include "arfm_vo/matching/guided_matcher.h"

#include <gtest/gtest.h>

#include <limits>

#include "matching/random_features.h"

namespace arfm_vo {
namespace {

cv::Mat AxisDescriptor(int axis) {
  cv::Mat row = cv::Mat::zeros(1, 64, CV_32FC1);
  row.at<float>(0, axis) = 1;
  return row;
}

/// One feature whose descriptor points along `axis`.
void AddFeature(Features& features, float x, float y, int axis, float scale = 1.2f,
                int8_t sign = 1) {
  features.keypoints.push_back({x, y, scale, 0, 1, sign});
  features.descriptors.push_back(AxisDescriptor(axis));
}

int FindStereoMatchOf(const Keypoint& right, const StereoSearchOptions& options = {}) {
  Features left_features, right_features;
  AddFeature(left_features, 100, 50, 3);
  AddFeature(right_features, right.x, right.y, 3, right.scale, right.laplacian_sign);
  const auto found = FindStereoNeighbours(left_features, right_features, options);
  EXPECT_EQ(found.of_first[0].nearest, found.of_second[0].nearest);
  return found.of_first[0].nearest;
}

TEST(StereoNeighbours, AreOnNearRowsAtPossibleDisparitiesOfTheSameKind) {
  EXPECT_EQ(FindStereoMatchOf({90, 50, 1.2f, 0, 1, 1}), 0);
  EXPECT_EQ(FindStereoMatchOf({90, 51.4f, 1.2f, 0, 1, 1}), 0);
  EXPECT_EQ(FindStereoMatchOf({90, 51.6f, 1.2f, 0, 1, 1}), -1) << "rows differ";
  EXPECT_EQ(FindStereoMatchOf({90, 52, 1.7f, 0, 1, 1}), 0) << "the band grows with the scale";
  EXPECT_EQ(FindStereoMatchOf({101, 50, 1.2f, 0, 1, 1}), 0) << "the horizon";
  EXPECT_EQ(FindStereoMatchOf({103, 50, 1.2f, 0, 1, 1}), -1) << "farther than the horizon";
  EXPECT_EQ(FindStereoMatchOf({90, 50, 2.4f, 0, 1, 1}), -1) << "other scale";
  EXPECT_EQ(FindStereoMatchOf({90, 50, 1.2f, 0, 1, -1}), -1) << "other sign";
  StereoSearchOptions near_only;
  near_only.min_disparity_px = 5;
  near_only.max_disparity_px = 20;
  EXPECT_EQ(FindStereoMatchOf({79, 50, 1.2f, 0, 1, 1}, near_only), -1) << "too near";
  EXPECT_EQ(FindStereoMatchOf({96, 50, 1.2f, 0, 1, 1}, near_only), -1) << "too far";
}

TEST(StereoNeighbours, TheNearestDescriptorWinsAndTheSecondGivesTheRatio) {
  Features left, right;
  AddFeature(left, 100, 50, 3);
  AddFeature(right, 95, 50, 7);
  AddFeature(right, 80, 50, 3);
  AddFeature(right, 80, 60, 3);  // other row
  const auto found = FindStereoNeighbours(left, right, {});
  EXPECT_EQ(found.of_first[0].nearest, 1);
  EXPECT_FLOAT_EQ(found.of_first[0].second_squared_distance, 2);
  EXPECT_EQ(found.of_second[2].nearest, -1);
}

/// All pairs that the rules allow, one by one.
TEST(StereoNeighbours, AgreeWithTheDefinition) {
  const Features left = RandomFeatures(400, 1), right = RandomFeatures(400, 2);
  StereoSearchOptions options;
  options.max_row_difference_px = 4;
  const auto found = FindStereoNeighbours(left, right, options);
  int num_found = 0;
  for (int i = 0; i < left.size(); ++i) {
    Neighbours expected;
    for (int j = 0; j < right.size(); ++j) {
      const Keypoint &a = left.keypoints[i], &b = right.keypoints[j];
      const float ratio = std::max(a.scale, b.scale) / std::min(a.scale, b.scale);
      if (a.laplacian_sign != b.laplacian_sign || ratio > 1.5f || a.x < b.x || a.x > b.x + 256 ||
          std::abs(a.y - b.y) > 4 * std::max(a.scale, b.scale) / 1.2f) {
        continue;
      }
      const cv::Mat difference = left.descriptors.row(i) - right.descriptors.row(j);
      expected.Add(j, static_cast<float>(difference.dot(difference)));
    }
    EXPECT_EQ(found.of_first[i].nearest, expected.nearest);
    num_found += expected.nearest >= 0;
  }
  EXPECT_GT(num_found, 200);
}

TEST(StereoNeighbours, EmptyImagesGiveNothing) {
  EXPECT_TRUE(FindStereoNeighbours({}, RandomFeatures(3, 1), {}).of_first.empty());
  EXPECT_EQ(FindStereoNeighbours(RandomFeatures(3, 1), {}, {}).of_first.size(), 3u);
}

TEST(PredictedNeighbours, AreWithinTheRadius) {
  Features features;
  AddFeature(features, 103, 54, 3);
  const auto find = [&](float radius) {
    return FindPredictedNeighbours({{100, 50, radius, 0, 1}}, AxisDescriptor(3), features, 1.5)
        .of_first[0]
        .nearest;
  };
  EXPECT_EQ(find(5.01f), 0);
  EXPECT_EQ(find(4.99f), -1);
  EXPECT_EQ(find(1000), 0);
}

TEST(PredictedNeighbours, HaveTheExpectedScaleAndSign) {
  Features features;
  AddFeature(features, 100, 50, 3, 2.4f);
  const auto find = [&](float scale, int8_t sign) {
    return FindPredictedNeighbours({{100, 50, 9, scale, sign}}, AxisDescriptor(3), features, 1.5)
        .of_first[0]
        .nearest;
  };
  EXPECT_EQ(find(2, 1), 0);
  EXPECT_EQ(find(0, 1), 0) << "any scale";
  EXPECT_EQ(find(1.2f, 1), -1);
  EXPECT_EQ(find(2, -1), -1);
}

TEST(PredictedNeighbours, OutsideTheImageOrNotFiniteFindNothing) {
  Features features;
  AddFeature(features, 1, 1, 3);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Prediction& prediction : {Prediction{-50, -50, 20, 0, 1}, Prediction{nan, 1, 5, 0, 1},
                                       Prediction{1, 1, nan, 0, 1}, Prediction{1e9f, 1, 5, 0, 1}}) {
    const auto found = FindPredictedNeighbours({prediction}, AxisDescriptor(3), features, 1.5);
    EXPECT_EQ(found.of_first[0].nearest, -1);
  }
  EXPECT_TRUE(FindPredictedNeighbours({}, cv::Mat(), features, 1.5).of_first.empty());
}

TEST(PredictedNeighbours, FindNoisyCopiesOfAWholeImage) {
  const Features first = RandomFeatures(500, 3);
  const Features second = ReversedWithNoise(first, 0.1, 4);
  std::vector<Prediction> predictions;
  for (const Keypoint& k : first.keypoints)
    predictions.push_back({k.x + 6, k.y - 5, 20, k.scale, k.laplacian_sign});
  const auto found = FindPredictedNeighbours(predictions, first.descriptors, second, 1.5);
  for (int i = 0; i < first.size(); ++i) {
    EXPECT_EQ(found.of_first[i].nearest, 499 - i);
    EXPECT_EQ(found.of_second[499 - i].nearest, i);
  }
}

}  // namespace
}  // namespace arfm_vo
