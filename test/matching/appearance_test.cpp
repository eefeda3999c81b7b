#include "arfm_vo/matching/appearance.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "matching/random_features.h"

namespace arfm_vo {
namespace {

TEST(Appearance, DistancesAreThoseOfTheDescriptorsAndInfiniteAcrossSigns) {
  const Features features = RandomFeatures(40, 1), alike = ReversedWithNoise(features, 0.03, 2);
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      const float *a = features.descriptors.ptr<float>(i), *b = alike.descriptors.ptr<float>(j);
      const float squared = Appearance(a, 1).SquaredDistance({b, 1});
      EXPECT_NEAR(std::sqrt(squared),
                  cv::norm(features.descriptors.row(i), alike.descriptors.row(j)), 0.02);
      EXPECT_EQ(Appearance(a, 1).SquaredDistance({b, -1}), std::numeric_limits<float>::infinity());
    }
  }
}

/// Of numbers that no unit vector holds, too.
TEST(Appearance, NumbersBeyondOneAreCut) {
  float numbers[64] = {2, -2, 1, -1};
  const Appearance appearance(numbers, -1);
  for (int i = 0; i < 64; ++i)
    EXPECT_EQ(appearance.descriptor[i], i >= 4 ? 0 : i % 2 == 0 ? 127 : -127) << i;
  EXPECT_EQ(appearance.laplacian_sign, -1);
}

}  // namespace
}  // namespace arfm_vo
