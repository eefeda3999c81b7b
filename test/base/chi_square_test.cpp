#include "arfm_vo/base/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace arfm_vo {
namespace {

TEST(ChiSquare, AgreesWithTheTables) {
  EXPECT_NEAR(ChiSquareQuantile(1, 0.95), 3.841459, 1e-6);
  EXPECT_NEAR(ChiSquareQuantile(2, 0.95), 5.991465, 1e-6);
  EXPECT_NEAR(ChiSquareQuantile(3, 0.99), 11.344867, 1e-6);
  EXPECT_NEAR(ChiSquareQuantile(4, 0.99), 13.276704, 1e-6);
  EXPECT_NEAR(ChiSquareQuantile(6, 0.50), 5.348121, 1e-6);
  EXPECT_NEAR(ChiSquareQuantile(1200, 0.975), 1297.8, 0.1);
}

TEST(ChiSquare, QuantileUndoesProbability) {
  for (const int dof : {1, 2, 3, 4, 7}) {
    for (const double x : {0.01, 0.5, 3.0, 20.0}) {
      EXPECT_NEAR(ChiSquareQuantile(dof, ChiSquareProbability(dof, x)), x, 1e-4) << dof;
    }
  }
}

TEST(ChiSquare, NothingLiesBelowZero) {
  EXPECT_EQ(ChiSquareProbability(3, 0), 0);
  EXPECT_EQ(ChiSquareProbability(3, -1), 0);
  EXPECT_NEAR(ChiSquareQuantile(3, 0), 0, 1e-8);
}

TEST(ChiSquare, RefusesWrongUse) {
  EXPECT_THROW(ChiSquareProbability(0, 1), std::invalid_argument);
  EXPECT_THROW(ChiSquareQuantile(3, 1), std::invalid_argument);
  EXPECT_THROW(ChiSquareQuantile(3, -0.1), std::invalid_argument);
  EXPECT_THROW(ChiSquareQuantile(3, NAN), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
