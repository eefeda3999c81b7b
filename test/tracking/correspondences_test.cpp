#include "arfm_vo/tracking/correspondences.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "arfm_vo/base/belief.h"
#include "arfm_vo/pose/false_alarms.h"

namespace arfm_vo {
namespace {

class CorrespondencesTest : public ::testing::Test {
 protected:
  void Add(LandmarkId id, int num_agreed, int num_contradicted, double u = 0, double v = 0) {
    Landmark landmark{};
    landmark.id = id;
    landmark.num_agreed = num_agreed;
    landmark.num_contradicted = num_contradicted;
    landmark.normal_in_world.setZero();
    landmark.x_in_world = camera_.Triangulate(u + 1, v, 5);
    landmark.covariance.setZero();
    landmarks_.push_back(landmark);
    LandmarkObservation observation;
    observation.landmark = id;
    observation.pixels << u, v, u - 5, v;
    found_.Add(camera_, {}, landmarks_.back(), observation);
  }

  const StereoCamera camera_{400, 400, 320, 240, 0.2, 640, 480};
  std::deque<Landmark> landmarks_;
  Correspondences found_;
};

TEST_F(CorrespondencesTest, LandmarksThatAgreedCountMoreThanNewOnesAndContradictedOnesLeast) {
  Add(1, 0, 0);
  Add(2, 1, 0);
  Add(3, 2, 0);
  Add(4, 9, 0);
  Add(5, 0, 1);
  const auto& points = found_.points;
  EXPECT_LT(points[0].votes, points[1].votes);
  EXPECT_LT(points[1].votes, points[2].votes);
  EXPECT_LT(points[2].votes, points[3].votes);
  EXPECT_LT(points[4].votes, 0.5 * points[0].votes);
  EXPECT_GT(points[4].votes, 0);
  EXPECT_FALSE(points[0].is_proven);
  EXPECT_TRUE(points[1].is_proven);
}

TEST_F(CorrespondencesTest, ManyInOneCellCountAsFewDo) {
  for (int i = 0; i < 30; ++i) Add(i, 1, 0, 20 + i % 5, 20);
  for (int i = 0; i < 3; ++i) Add(30 + i, 1, 0, 300, 200);
  Add(33, 1, 0, 500, 400);
  found_.ShareVotes(camera_.width);
  double of_many = 0, of_three = 0;
  for (int i = 0; i < 30; ++i) of_many += found_.points[i].votes;
  for (int i = 30; i < 33; ++i) of_three += found_.points[i].votes;
  EXPECT_NEAR(of_many, of_three, 1e-9);
  EXPECT_NEAR(found_.points[33].votes, found_.points[30].votes, 1e-9) << "alone it counts no more";
}

TEST_F(CorrespondencesTest, SelectsByFlagAndSorts) {
  for (const LandmarkId id : {7, 3, 9, 1}) Add(id, 0, 0);
  const auto agree = found_.Select({1, 0, 1, 1}, 1), others = found_.Select({1, 0, 1, 1}, 0);
  ASSERT_EQ(agree.size(), 3u);
  EXPECT_EQ(agree[0].landmark, 1);
  EXPECT_EQ(agree[1].landmark, 7);
  EXPECT_EQ(agree[2].landmark, 9);
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(others[0].landmark, 3);
}

/// Two groups of landmarks, in the left and in the right half.
class GroundTest : public CorrespondencesTest {
 protected:
  void AddGroups(int num_agreed_left, int num_contradicted_right) {
    for (int i = 0; i < 120; ++i) {
      const bool is_left = i < 60;
      const double u = (is_left ? 0 : 320) + 5 * (i % 60), v = 8 * (i % 60);
      Add(i, is_left ? num_agreed_left : 0, is_left ? 0 : num_contradicted_right, u, v);
      flags_.push_back(is_left ? 1 : 2);
    }
  }
  /// `log_odds` and `arrived` are believed before.
  GroundBelief Weigh(char flag, double log_odds, double arrived) const {
    const auto prior = [&](double probability) {
      return LogLikelihoods{std::log(probability * Logistic(log_odds)),
                            std::log(probability * Logistic(-log_odds))};
    };
    return found_.Weigh(camera_, Rigid3(), flags_, flag, prior(1 - arrived), prior(arrived));
  }
  double LogOdds(char flag) const { return Weigh(flag, 0, 0).log_odds; }

  std::vector<char> flags_;
};

TEST_F(GroundTest, NothingIsKnownOfTwoNewGroups) {
  AddGroups(0, 0);
  EXPECT_NEAR(LogOdds(1), LogOdds(2), 1e-9);
}

TEST_F(GroundTest, ThoseThatAgreedBeforeAreTheGround) {
  AddGroups(5, 0);
  EXPECT_GT(LogOdds(1), 2);
  EXPECT_LT(LogOdds(2), -2);
}

TEST_F(GroundTest, ThoseThatWereContradictedAreNot) {
  AddGroups(0, 5);
  EXPECT_GT(LogOdds(1), 2);
  EXPECT_LT(LogOdds(2), -2);
}

TEST_F(GroundTest, AGroupBesideTheGroundIsTheGround) {
  AddGroups(0, 0);
  for (size_t i = 0; i < 60; ++i) landmarks_[i].num_beside = 5;
  EXPECT_GT(LogOdds(1), 2);
  EXPECT_FALSE(found_.points[0].is_proven) << "no pose has told of it";
}

TEST_F(GroundTest, AsFewAsAgreeByChanceAreHardlyTheGround) {
  AddGroups(5, 0);
  for (const int num_agreeing : {30, 12, 5}) {
    for (int i = 0; i < 120; ++i) flags_[i] = i < num_agreeing;
    const double by_chance = LogFalseAlarms(camera_, found_.points, flags_, 1, Rigid3());
    EXPECT_EQ(LogOdds(1) < -std::max(2., by_chance), num_agreeing == 5) << num_agreeing;
  }
}

/// A group that may have come with something large: the left half is the ground known before.
class ArrivalTest : public GroundTest {
 protected:
  GroundBelief After(double num_agreed_left, bool left_agrees, bool right_agrees) {
    AddGroups(static_cast<int>(num_agreed_left), 0);
    for (size_t i = 0; i < landmarks_.size(); ++i) {
      const bool is_left = i < 60;
      if (!is_left) landmarks_[i].doubt = 3;
      flags_[i] = is_left ? left_agrees : right_agrees;
    }
    return Weigh(1, 4, 0.9);
  }
};

TEST_F(ArrivalTest, WhatMovesWithTheKnownGroundHasNotCome) {
  const GroundBelief after = After(5, true, true);
  EXPECT_LT(after.arrived, 0.1);
  EXPECT_GT(after.log_odds, 4);
}

TEST_F(ArrivalTest, WhatMovesOtherwiseThanTheKnownGroundHas) {
  const GroundBelief after = After(5, true, false);
  EXPECT_GT(after.arrived, 0.99);
  EXPECT_GT(after.log_odds, 4);
}

TEST_F(ArrivalTest, APoseOfWhatMayHaveComeIsNotTheKnownGrounds) {
  const GroundBelief after = After(5, false, true);
  EXPECT_GT(after.arrived, 0.5);
  EXPECT_LT(after.log_odds, 0);
}

/// Where nothing else is seen it is as likely as before that something came.
TEST_F(ArrivalTest, AloneItTellsNothing) {
  AddGroups(0, 0);
  for (Landmark& landmark : landmarks_) landmark.doubt = 3;
  flags_.assign(landmarks_.size(), 1);
  const GroundBelief after = Weigh(1, 0, 0.9);
  EXPECT_NEAR(after.arrived, 0.9, 0.02);
  EXPECT_NEAR(after.log_odds, std::log(0.1 / 0.9), 0.3);
}

/// Whatever the number of points, an image counts as a few observations.
TEST_F(GroundTest, MorePointsInTheSamePlacesTellNothingNew) {
  AddGroups(5, 0);
  const double once = LogOdds(1);
  AddGroups(5, 0);
  EXPECT_NEAR(LogOdds(1), once, 0.1 * once);
}

TEST_F(GroundTest, PointsBeyondTheBorderCountAsAtIt) {
  Add(0, 1, 0, -3, -3);
  Add(1, 1, 0, 642, 483);
  flags_ = {1, 1};
  EXPECT_TRUE(std::isfinite(LogOdds(1)));
}

}  // namespace
}  // namespace arfm_vo
