#include "arfm_vo/mapping/place_recogniser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mapping/random_place.h"

namespace arfm_vo {
namespace {

/// Knows five places; what looks at one of them stands aside, and sees its points' looks a little
/// changed.
class PlaceRecogniserTest : public ::testing::Test {
 protected:
  using Points = std::vector<RandomPoint>;

  PlaceRecogniserTest() {
    for (int i = 0; i < 5; ++i) places_.push_back(MakeRandomPlace(engine_));
  }

  std::vector<SeenPoint> See(const Points& points) {
    std::vector<SeenPoint> view;
    for (const RandomPoint& point : points) {
      auto& [id, appearance, observation] = view.emplace_back();
      id = static_cast<LandmarkId>(view.size()) - 1;
      appearance = point.LookAgain(engine_);
      observation.pixels = camera_.ProjectStereo(aside_ * point.x_in_place);
    }
    return view;
  }

  /// Point i of place k is landmark kPoints * k + i.
  std::optional<RecognisedPlace> Find(
      const std::vector<SeenPoint>& view,
      const PlaceRecogniser::Revise& revise = [](int, PlacePoint&) { return true; }) {
    PlaceRecogniser recogniser(camera_);
    LandmarkId next = 0;
    for (const Points& points : places_) {
      Place place;
      for (const RandomPoint& point : points)
        place.push_back({next++, point.x_in_place, {point.descriptor.data(), point.sign}});
      recogniser.Add(place);
    }
    return recogniser.Find(view, revise);
  }

  RandomEngine engine_{7};
  StereoCamera camera_{400, 400, 320, 240, 0.2, 640, 480};
  std::vector<Points> places_;
  const Rigid3 aside_{ExpSO3({0.01, 0.1, -0.02}), Eigen::Vector3d(0.3, -0.05, 0.2)};
};

TEST_F(PlaceRecogniserTest, FindsThePlaceThePoseInItAndItsPoints) {
  const auto found = Find(See(places_[3]));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->place, 3);
  const Rigid3 error = found->pose.camera_from_world * aside_.Inverse();
  EXPECT_LT(error.translation.norm(), 1e-3);
  EXPECT_LT(error.Angle(), 1e-4);
  EXPECT_GT(found->same.size(), 0.9 * kPoints);
  for (const auto& [id, seen] : found->same) EXPECT_EQ(id, 3 * kPoints + seen);
}

/// The points of a place err together: many of them do not make a pose certain beyond that.
TEST_F(PlaceRecogniserTest, APoseIsNeverMoreCertainThanThePlaceItself) {
  const auto found = Find(See(places_[0]));
  ASSERT_TRUE(found);
  const Eigen::Matrix<double, 6, 1> variances = found->pose.covariance.diagonal();
  EXPECT_GE(variances.head<3>().minCoeff(), 2e-4 * 2e-4);
  EXPECT_GE(variances.tail<3>().minCoeff(), 5e-3 * 5e-3);
  EXPECT_LT(variances.tail<3>().maxCoeff(), 0.05 * 0.05);
}

TEST_F(PlaceRecogniserTest, DoesNotFindAnUnknownPlaceNorOneOfTooFewPoints) {
  EXPECT_FALSE(Find(See(MakeRandomPlace(engine_))));
  EXPECT_FALSE(Find({}));
  for (Points& points : places_) points.resize(24);
  EXPECT_FALSE(Find(See(places_[0])));
}

TEST_F(PlaceRecogniserTest, PointsThatLookAlikeAndLieElsewhereAreNoPlace) {
  Points points = places_[0];
  for (int i = 0; i < kPoints; ++i)
    points[i].x_in_place = places_[0][(i + 17) % kPoints].x_in_place;
  EXPECT_FALSE(Find(See(points)));
}

TEST_F(PlaceRecogniserTest, DarkOnBrightIsNotBrightOnDark) {
  Points points = places_[0];
  for (RandomPoint& point : points) point.sign = static_cast<int8_t>(-point.sign);
  EXPECT_FALSE(Find(See(points)));
}

TEST_F(PlaceRecogniserTest, AFewPointsThatLookAlikeAreNoPlace) {
  Points points = MakeRandomPlace(engine_);
  std::copy(places_[0].begin(), places_[0].begin() + 40, points.begin());
  const auto found = Find(See(points));
  ASSERT_TRUE(found);
  EXPECT_GE(found->same.size(), 30u);
  EXPECT_LE(found->same.size(), 40u);
  points = MakeRandomPlace(engine_);
  std::copy(places_[0].begin(), places_[0].begin() + 24, points.begin());
  EXPECT_FALSE(Find(See(points)));
}

/// Two points of one look that lie apart: neither is known again. Nearly at one place: both are.
TEST_F(PlaceRecogniserTest, PointsThatCannotBeToldApartAreNotMatched) {
  for (const double apart_m : {2.0, 0.002}) {
    Points& place = places_[0];
    place[0].x_in_place = Eigen::Vector3d(0, 0, 6);
    place[2].x_in_place = place[0].x_in_place + Eigen::Vector3d(apart_m, 0, 0);
    place[2].descriptor = place[0].descriptor;
    const auto found = Find(See(place));
    ASSERT_TRUE(found);
    const auto matched = std::count_if(found->same.begin(), found->same.end(), [](const auto& s) {
      return s.second == 0 || s.second == 2;
    });
    EXPECT_EQ(matched, apart_m > 1 ? 0 : 2);
  }
}

/// A place seen twice: both have all votes, and the one that shows more is taken.
TEST_F(PlaceRecogniserTest, OfPlacesAlikeTheOneThatShowsMoreOfTheViewIsTaken) {
  places_[4] = places_[1];
  places_[1].resize(60);
  const auto found = Find(See(places_[4]));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->place, 4);
}

TEST_F(PlaceRecogniserTest, PointsAreLookedForWhereTheyAreNow) {
  const Eigen::Vector3d moved(0, 0, 0.5);
  const std::vector<SeenPoint> view = See(places_[2]);
  const auto found = Find(view, [&](int place, PlacePoint& point) {
    EXPECT_EQ(point.id / kPoints, place);
    point.x_in_place += moved;
    point.id += 1000;
    return true;
  });
  ASSERT_TRUE(found);
  const Rigid3 expected = aside_ * Rigid3(Eigen::Quaterniond::Identity(), -moved);
  EXPECT_LT((found->pose.camera_from_world * expected.Inverse()).translation.norm(), 1e-3);
  for (const auto& [id, seen] : found->same) EXPECT_EQ(id, 1000 + 2 * kPoints + seen);
  EXPECT_FALSE(Find(view, [](int place, PlacePoint&) { return place != 2; }));
}

/// The bound that a pose must reach can be reached: a sample of points that agree is drawn.
TEST(RecognitionPose, DrawsEnoughSamplesForTheShareThatItAccepts) {
  const PoseEstimatorOptions options = RecognitionPose();
  const double good_sample = std::pow(options.min_inlier_share, kSamplePoints);
  EXPECT_GE(1 - std::pow(1 - good_sample, options.ransac.max_iterations), 0.99);
}

}  // namespace
}  // namespace arfm_vo
