#include "arfm_vo/matching/exact_matcher.h"

#include <gtest/gtest.h>

#include <limits>
#include <tuple>

#include "arfm_vo/matching/flann_matcher.h"
#include "matching/exact_kernel.h"
#include "matching/random_features.h"

namespace arfm_vo {
namespace {

/// The definition, in double.
std::vector<Neighbours> FindOneByOne(const Features& from, const Features& to) {
  std::vector<Neighbours> all(from.size());
  for (int i = 0; i < from.size(); ++i) {
    for (int j = 0; j < to.size(); ++j) {
      if (from.keypoints[i].laplacian_sign != to.keypoints[j].laplacian_sign) continue;
      double sum = 0;
      for (int k = 0; k < 64; ++k) {
        const double difference =
            double(from.descriptors.at<float>(i, k)) - to.descriptors.at<float>(j, k);
        sum += difference * difference;
      }
      all[i].Add(j, static_cast<float>(sum));
    }
  }
  return all;
}

void ExpectSame(const std::vector<Neighbours>& found, const std::vector<Neighbours>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].nearest, expected[i].nearest) << i;
    if (expected[i].nearest < 0) continue;
    EXPECT_NEAR(found[i].squared_distance, expected[i].squared_distance, 2e-6) << i;
    if (expected[i].second_squared_distance == Neighbours::kNone) {
      EXPECT_EQ(found[i].second_squared_distance, Neighbours::kNone) << i;
    } else {
      EXPECT_NEAR(found[i].second_squared_distance, expected[i].second_squared_distance, 2e-6) << i;
    }
  }
}

/// Unit descriptors along single axes, so that distances are known by hand.
Features AxisFeatures(const std::vector<int>& axes) {
  Features features;
  features.keypoints.resize(axes.size());
  features.descriptors = cv::Mat::zeros(static_cast<int>(axes.size()), 64, CV_32FC1);
  for (size_t i = 0; i < axes.size(); ++i)
    features.descriptors.at<float>(static_cast<int>(i), axes[i]) = 1;
  return features;
}

TEST(ExactMatcher, OfEqualCandidatesTheFirstWinsAndTheRatioIsOne) {
  const Features many = AxisFeatures(std::vector<int>(40, 5));
  const auto found = FindNeighboursExactly(AxisFeatures({5}), many);
  EXPECT_EQ(found.of_first[0].nearest, 0);
  EXPECT_FLOAT_EQ(found.of_first[0].Ratio(), 1);
}

class ExactMatcherSizes : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(ExactMatcherSizes, AgreesWithTheDefinitionBothWays) {
  const auto [num_first, num_second] = GetParam();
  const Features first = RandomFeatures(num_first, 1);
  const Features second = RandomFeatures(num_second, 2);
  const auto found = FindNeighboursExactly(first, second);
  ExpectSame(found.of_first, FindOneByOne(first, second));
  ExpectSame(found.of_second, FindOneByOne(second, first));
}

INSTANTIATE_TEST_SUITE_P(AroundTileBorders, ExactMatcherSizes,
                         testing::Combine(testing::Values(1, 2, 6, 7, 97),
                                          testing::Values(1, 15, 16, 17, 130)));

/// What a kernel finds for one-row-a-descriptor `first` among `second`, packed into panels.
struct KernelScores {
  std::vector<float> row_best, row_second, column_best, column_second;
  std::vector<int32_t> row_index, column_index;

  template <class Kernel>
  KernelScores(const Kernel& kernel, const cv::Mat& first, const cv::Mat& second) {
    const int num_panels = (second.rows + kPanelColumns - 1) / kPanelColumns;
    std::vector<float> panels(num_panels * kPanelColumns * kDescriptorSize);
    for (int i = 0; i < second.rows; ++i) {
      for (int k = 0; k < kDescriptorSize; ++k) {
        panels[(i / kPanelColumns * kDescriptorSize + k) * kPanelColumns + i % kPanelColumns] =
            second.at<float>(i, k);
      }
    }
    std::vector<const float*> rows;
    for (int i = 0; i < first.rows; ++i) rows.push_back(first.ptr<float>(i));
    for (auto* scores : {&row_best, &row_second}) scores->resize(first.rows);
    for (auto* scores : {&column_best, &column_second}) scores->resize(num_panels * kPanelColumns);
    row_index.resize(first.rows);
    column_index.resize(num_panels * kPanelColumns);
    kernel({rows.data(),
            first.rows,
            panels.data(),
            second.rows,
            {row_best.data(), row_second.data(), row_index.data()},
            {column_best.data(), column_second.data(), column_index.data()}});
  }
  auto All() const {
    return std::tie(row_best, row_second, row_index, column_best, column_second, column_index);
  }
};

TEST_P(ExactMatcherSizes, BothKernelsGiveTheSameBits) {
  if (!CanSearchExactlyAvx2()) GTEST_SKIP() << "this CPU has one kernel";
  const auto [num_first, num_second] = GetParam();
  const cv::Mat first = RandomFeatures(num_first, 1).descriptors;
  const cv::Mat second = RandomFeatures(num_second, 2).descriptors;
  EXPECT_EQ(KernelScores(SearchExactlyBaseline, first, second).All(),
            KernelScores(SearchExactlyAvx2, first, second).All());
}

/// What holds of both searches.
class NeighbourSearch
    : public testing::TestWithParam<TwoWayNeighbours (*)(const Features&, const Features&)> {
 protected:
  static TwoWayNeighbours Find(const Features& first, const Features& second) {
    return GetParam()(first, second);
  }
};

TEST_P(NeighbourSearch, FindsNoisyCopiesBothWays) {
  const Features first = RandomFeatures(300, 1), second = ReversedWithNoise(first, 0.02, 2);
  const auto found = Find(first, second);
  int num_right = 0;
  for (int i = 0; i < 300; ++i) {
    num_right += found.of_first[i].nearest == 299 - i;
    num_right += found.of_second[299 - i].nearest == i;
  }
  EXPECT_GT(num_right, GetParam() == FindNeighboursExactly ? 599 : 570);
}

TEST_P(NeighbourSearch, DistancesAreSquaredEuclidean) {
  const auto found = Find(AxisFeatures({3, 63}), AxisFeatures({63, 7, 3}));
  EXPECT_EQ(found.of_first[0].nearest, 2);
  EXPECT_EQ(found.of_first[1].nearest, 0);
  EXPECT_FLOAT_EQ(found.of_first[0].squared_distance, 0);
  EXPECT_FLOAT_EQ(found.of_first[0].second_squared_distance, 2);
  EXPECT_FLOAT_EQ(found.of_second[1].squared_distance, 2);
}

TEST_P(NeighbourSearch, OneCandidateHasNoSecondAndNoneIsNoNeighbour) {
  const Features none, one = AxisFeatures({1}), some = AxisFeatures({1, 2});
  EXPECT_EQ(Find(some, one).of_first[1].nearest, 0);
  EXPECT_EQ(Find(some, one).of_first[1].second_squared_distance, Neighbours::kNone);
  EXPECT_TRUE(Find(none, some).of_first.empty());
  ASSERT_EQ(Find(none, some).of_second.size(), 2u);
  EXPECT_EQ(Find(none, some).of_second[0].nearest, -1);
  EXPECT_TRUE(Find(some, none).of_second.empty());
}

TEST_P(NeighbourSearch, WrongDescriptorShapeThrows) {
  Features narrow = AxisFeatures({1, 2}), short_of_one = narrow;
  narrow.descriptors = narrow.descriptors.colRange(0, 32);
  short_of_one.keypoints.pop_back();
  EXPECT_THROW(Find(narrow, AxisFeatures({1})), std::invalid_argument);
  EXPECT_THROW(Find(AxisFeatures({1}), short_of_one), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Both, NeighbourSearch,
                         testing::Values(&FindNeighboursExactly, &FindNeighboursByFlann));

TEST(ExactMatcher, DescriptorsThatAreNotFiniteAreNobodysNeighbours) {
  Features first = AxisFeatures({1, 2, 3}), second = AxisFeatures({1, 2, 3});
  first.descriptors.at<float>(1, 0) = std::numeric_limits<float>::quiet_NaN();
  second.descriptors.at<float>(2, 9) = std::numeric_limits<float>::infinity();
  const auto found = FindNeighboursExactly(first, second);
  EXPECT_EQ(found.of_first[1].nearest, -1);
  EXPECT_EQ(found.of_second[2].nearest, -1);
  EXPECT_EQ(found.of_first[0].nearest, 0);
  EXPECT_NE(found.of_first[2].nearest, 2);
}

}  // namespace
}  // namespace arfm_vo
