#include "arfm_vo/odometry/correspondences.h"

#include <gtest/gtest.h>

#include <deque>

namespace arfm_vo {
namespace {

class CorrespondencesTest : public ::testing::Test {
 protected:
  void Add(LandmarkId id, int num_agreed, bool is_suspect, double u = 0, double v = 0) {
    Landmark landmark{};
    landmark.id = id;
    landmark.num_agreed = num_agreed;
    landmark.is_suspect = is_suspect;
    landmark.normal_in_world.setZero();
    landmark.x_in_world.setZero();
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

TEST_F(CorrespondencesTest, KnownLandmarksCountMoreThanNewOnesAndSuspectOnesLeast) {
  Add(1, 0, false);
  Add(2, 1, false);
  Add(3, 2, false);
  Add(4, 9, false);
  Add(5, 0, true);
  const auto& points = found_.points;
  EXPECT_LT(points[0].votes, points[1].votes);
  EXPECT_LT(points[1].votes, points[2].votes);
  EXPECT_EQ(points[2].votes, points[3].votes);
  EXPECT_LT(points[4].votes, 0.5 * points[0].votes);
  EXPECT_GT(points[4].votes, 0);
  EXPECT_FALSE(points[0].is_proven);
  EXPECT_TRUE(points[1].is_proven);
}

TEST_F(CorrespondencesTest, ManyInOneCellCountAsFewDo) {
  for (int i = 0; i < 30; ++i) Add(i, 1, false, 20 + i % 5, 20);
  for (int i = 0; i < 3; ++i) Add(30 + i, 1, false, 300, 200);
  Add(33, 1, false, 500, 400);
  found_.ShareVotes(camera_.width);
  double of_many = 0, of_three = 0;
  for (int i = 0; i < 30; ++i) of_many += found_.points[i].votes;
  for (int i = 30; i < 33; ++i) of_three += found_.points[i].votes;
  EXPECT_NEAR(of_many, of_three, 1e-9);
  EXPECT_NEAR(found_.points[33].votes, found_.points[30].votes, 1e-9) << "alone it counts no more";
}

TEST_F(CorrespondencesTest, SelectsByFlagAndSorts) {
  for (const LandmarkId id : {7, 3, 9, 1}) Add(id, 0, false);
  const auto agree = found_.Select({1, 0, 1, 1}, 1), others = found_.Select({1, 0, 1, 1}, 0);
  ASSERT_EQ(agree.size(), 3u);
  EXPECT_EQ(agree[0].landmark, 1);
  EXPECT_EQ(agree[1].landmark, 7);
  EXPECT_EQ(agree[2].landmark, 9);
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(others[0].landmark, 3);
}

/// Of 20 known landmarks 15 agree, of 20 new ones 5, of which 2 are suspect.
TEST_F(CorrespondencesTest, SharesAreOfKnownAndOfNewOnes) {
  std::vector<char> is_inlier;
  for (int i = 0; i < 40; ++i) {
    const bool is_known = i < 20;
    Add(i, is_known, i == 20 || i == 21);
    is_inlier.push_back(is_known ? i < 15 : i < 25);
  }
  const AgreeingShares shares = found_.Shares(is_inlier);
  EXPECT_EQ(shares.known, 0.75);
  EXPECT_EQ(shares.fresh, 0.25);
  EXPECT_EQ(shares.suspect, 0.1);
}

TEST_F(CorrespondencesTest, TooFewTellNoShare) {
  for (int i = 0; i < 38; ++i) Add(i, i < 19, false);
  const AgreeingShares shares = found_.Shares(std::vector<char>(38, 1));
  EXPECT_FALSE(shares.known);
  EXPECT_FALSE(shares.fresh);
  EXPECT_EQ(Correspondences().Shares({}).suspect, 0);
}

}  // namespace
}  // namespace arfm_vo
