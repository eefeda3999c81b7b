#include "arfm_vo/odometry/row_watch.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

bool IsSkewedAfter(RowWatch& watch, double row_agreement) {
  watch.Look(row_agreement);
  return watch.IsSkewed();
}

TEST(RowWatch, TrustsPairsOfWhichMostAgrees) {
  RowWatch watch;
  for (const double agreement : {0.95, 0.8, 0.6}) EXPECT_FALSE(IsSkewedAfter(watch, agreement));
}

TEST(RowWatch, ThreeGoodPairsInARowEndTheDistrust) {
  RowWatch watch;
  EXPECT_TRUE(IsSkewedAfter(watch, 0.3));
  EXPECT_TRUE(IsSkewedAfter(watch, 0.9));
  EXPECT_TRUE(IsSkewedAfter(watch, 0.9));
  EXPECT_TRUE(IsSkewedAfter(watch, 0.6));  // begins again
  EXPECT_TRUE(IsSkewedAfter(watch, 0.9));
  EXPECT_TRUE(IsSkewedAfter(watch, 0.9));
  EXPECT_FALSE(IsSkewedAfter(watch, 0.9));
}

}  // namespace
}  // namespace arfm_vo
