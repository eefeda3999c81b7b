#include "arfm_vo/simulation/noise_texture.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

TEST(NoiseTexture, HasMeanZeroAndDeviationOne) {
  const NoiseTexture texture(8, 0.01, 1);
  double sum = 0, squares = 0;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const double value = texture.Sample(x + 0.5, y + 0.5, 0);
      sum += value;
      squares += value * value;
    }
  }
  EXPECT_NEAR(sum / 65536, 0, 1e-4);
  EXPECT_NEAR(squares / 65536, 1, 1e-3);
}

TEST(NoiseTexture, RepeatsSeamlessly) {
  const NoiseTexture texture(7, 0, 2);
  for (const double x : {-0.3, 0.2, 127.7})
    EXPECT_DOUBLE_EQ(texture.Sample(x, 5.1, 0.5), texture.Sample(x + 128, 5.1 - 128, 0.5));
}

/// The brute-force mean over a footprint.
double DenseMean(const NoiseTexture& texture, const TextureFootprint& footprint) {
  double sum = 0;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      const Eigen::Vector2d p = footprint.center + ((i + 0.5) / 40 - 0.5) * footprint.along_u +
                                ((j + 0.5) / 40 - 0.5) * footprint.along_v;
      sum += texture.Sample(p.x(), p.y(), 0);
    }
  }
  return sum / 1600;
}

TEST(NoiseTexture, MeanOverASlantedFootprintFollowsTheDenseMeanWithoutShift) {
  const NoiseTexture texture(8, 0.01, 3);
  const Eigen::Vector2d long_side(9, 5), short_side(-0.6, 1.1);
  // The filtered signal is compared with the dense mean at offsets along the long side: it must
  // fit best where it is.
  double error[3] = {0, 0, 0}, power = 0;
  for (int k = 0; k < 400; ++k) {
    TextureFootprint footprint{{7.3 * k, 11.9 * k}, long_side, short_side};
    const double mean = texture.SampleMean(TextureProbes(footprint), 1);
    const Eigen::Vector2d center = footprint.center;
    for (int shift = -1; shift <= 1; ++shift) {
      footprint.center = center + 0.1 * shift * long_side;
      const double dense = DenseMean(texture, footprint);
      error[shift + 1] += (mean - dense) * (mean - dense);
      if (shift == 0) power += dense * dense;
    }
  }
  EXPECT_LT(error[1], 0.1 * power);
  EXPECT_LT(error[1], error[0]);
  EXPECT_LT(error[1], error[2]);
}

TEST(NoiseTexture, VanishesUnderAHugeFootprint) {
  const NoiseTexture texture(8, 0.01, 4);
  EXPECT_EQ(texture.SampleMean(TextureProbes({{1, 2}, {900, 0}, {0, 900}}), 1), 0);
}

}  // namespace
}  // namespace arfm_vo
