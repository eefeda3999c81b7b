#include "arfm_vo/base/belief.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

TEST(Belief, EvidenceMovesIt) {
  Belief belief(0.5);
  EXPECT_NEAR(belief.Probability(), 0.5, 1e-12);
  belief.Add(std::log(3));
  EXPECT_NEAR(belief.Probability(), 0.75, 1e-12);
}

TEST(Belief, WithoutEvidenceItGoesToItsPriorRates) {
  for (const double start : {0.001, 0.999}) {
    Belief belief(start);
    for (int i = 0; i < 1000; ++i) belief.Advance(0.1, 9, 1);
    EXPECT_NEAR(belief.Probability(), 0.9, 1e-9);
    Belief at_once(start);
    at_once.Advance(100, 9, 1);
    EXPECT_NEAR(at_once.Probability(), 0.9, 1e-9) << "whatever the steps";
  }
}

TEST(Belief, WhatAnotherThingExplainsAsWellTellsTheLess) {
  EXPECT_NEAR(LogRatioBeside(3, 0), 3, 1e-12);
  EXPECT_NEAR(LogRatioBeside(3, 1), 0, 1e-12);
  EXPECT_NEAR(std::exp(LogRatioBeside(std::log(9), 0.5)), 9 / (0.5 + 0.5 * 9), 1e-12);
  EXPECT_LT(LogRatioBeside(100, 0.01), std::log(100)) << "not more than its odds";
}

TEST(Belief, NoTimeChangesNothing) {
  Belief belief(0.3);
  belief.Advance(0, 60, 1);
  EXPECT_NEAR(belief.Probability(), 0.3, 1e-12);
}

TEST(Belief, ItTellsHowLikelyItHasEnded) {
  EXPECT_NEAR(Belief(0.8).Advance(1000, 1, 9), 0.8 * 0.9, 1e-9);
  EXPECT_NEAR(Belief(0.8).Advance(1e-3, 10, 10), 0.8 * 1e-4, 1e-7);
  EXPECT_EQ(Belief(0.8).Advance(0, 10, 10), 0);
}

TEST(Belief, ALimitOnlyLowersIt) {
  Belief belief(0.9);
  belief.Limit(10);
  EXPECT_NEAR(belief.Probability(), 0.9, 1e-12);
  belief.Limit(0);
  EXPECT_NEAR(belief.Probability(), 0.5, 1e-12);
}

}  // namespace
}  // namespace arfm_vo
