#include "arfm_vo/odometry/loop_closer.h"

#include <gtest/gtest.h>

#include "mapping/random_place.h"

namespace arfm_vo {
namespace {

/// Drives past places, sees each in two keyframes, and comes back to the first: there its landmarks
/// are new ones, their looks differ a little, and the path has drifted.
class LoopCloserTest : public ::testing::Test {
 protected:
  using Place = std::vector<RandomPoint>;

  LoopCloserTest() {
    options_.min_gap_keyframes = 6;
    for (int i = 0; i < 5; ++i) places_.push_back(MakeRandomPlace(engine_));
  }

  void SetUpAnew() {
    map_ = {};
    next_landmark_ = first_of_place_ = 0;
    sigma_m_ = 0.1;
  }

  /// Places lie 5 m apart.
  static Rigid3 PlaceFromWorld(size_t place) {
    return {Eigen::Quaterniond::Identity(), {-5.0 * static_cast<double>(place), 0, 0}};
  }

  /// A keyframe that sees a place: as the one before where `goes_on`, else as new landmarks. The
  /// path believes to be `drift_m` beside where it is.
  void Add(LoopCloser& closer, size_t number, const Rigid3& camera_from_place, double drift_m,
           bool goes_on) {
    const Place& place = places_[number];
    const Rigid3 drift(Eigen::Quaterniond::Identity(), {drift_m, 0, 0});
    const Rigid3 believed = camera_from_place * PlaceFromWorld(number) * drift;
    const int keyframe = static_cast<int>(map_.keyframes.size());
    if (!goes_on) first_of_place_ = next_landmark_;
    MapStore::Keyframe& added = map_.keyframes.emplace_back();
    added.id = keyframe;
    added.camera_from_world = believed;
    Eigen::Matrix<double, 6, 6> step_covariance = Eigen::Matrix<double, 6, 6>::Zero();
    step_covariance.diagonal() << Eigen::Vector3d::Constant(1e-6),
        Eigen::Vector3d::Constant(sigma_m_ * sigma_m_);
    for (int i = 0; i < kPoints; ++i) {
      const Eigen::Vector3d x = camera_from_place * place[i].x_in_place;
      const LandmarkId id = first_of_place_ + i;
      if (!goes_on) {
        MapStore::Point& point = map_.landmarks[id];
        point.x_in_world = believed.Inverse() * x;
        point.first_keyframe = keyframe;
        point.appearance = place[i].LookAgain(engine_);
        next_landmark_ = id + 1;
      }
      MapStore::Point& point = map_.landmarks.at(id);
      ++point.num_observations;
      point.last_keyframe = keyframe;
      const Eigen::Vector3d stereo = camera_.ProjectStereo(x);
      LandmarkObservation observation;
      observation.landmark = id;
      observation.pixels << stereo.x(), stereo.y(), stereo.z(), stereo.y();
      added.observations.push_back(observation);
    }
    map_.Settle(keyframe + 1 - options_.min_gap_keyframes, options_.max_points);
    closer.Add(map_, step_covariance, {});
  }

  /// Past all places: keyframes 0 to 9.
  void DriveOut(LoopCloser& closer) {
    for (size_t place = 0; place < places_.size(); ++place) {
      for (const bool goes_on : {false, true}) {
        const Rigid3 pose(Eigen::Quaterniond::Identity(), {0, 0, goes_on ? -0.1 : 0});
        Add(closer, place, pose, 0, goes_on);
        EXPECT_TRUE(closer.loops().empty()) << map_.keyframes.size();
      }
    }
  }

  /// `num` keyframes at a place.
  void Return(LoopCloser& closer, size_t place, double drift_m, int num) {
    for (int i = 0; i < num; ++i) Add(closer, place, return_, drift_m, i > 0);
  }

  RandomEngine engine_{7};
  StereoCamera camera_{400, 400, 320, 240, 0.2, 640, 480};
  LoopOptions options_;
  double sigma_m_ = 0.1;  ///< of a step
  std::vector<Place> places_;
  MapStore map_;
  LandmarkId next_landmark_ = 0, first_of_place_ = 0;
  const Rigid3 return_{ExpSO3({0.01, 0.1, -0.02}), Eigen::Vector3d(0.3, -0.05, 0.2)};
};

TEST_F(LoopCloserTest, BendsThePathWhereThreeKeyframesShowAnOldPlace) {
  LoopCloser closer(camera_, options_);
  DriveOut(closer);
  Return(closer, 0, 0.5, 5);  // 12 is looked at, and the two that follow
  ASSERT_EQ(closer.loops().size(), 1u);
  const PoseConstraint& loop = closer.loops()[0];
  EXPECT_LE(loop.first, 1);
  EXPECT_EQ(loop.second, 14);
  EXPECT_TRUE(closer.is_contradicted());
  const std::vector<Rigid3> bent = closer.Bend(map_);
  const Rigid3 error = bent[14] * (return_ * bent[0]).Inverse();
  EXPECT_LT(error.translation.norm(), 0.02);
  EXPECT_EQ(bent[0].translation, map_.keyframes[0].camera_from_world.translation);
  EXPECT_FALSE(closer.is_contradicted());
}

TEST_F(LoopCloserTest, TwoKeyframesOrWhatWasSeenAMomentAgoAreNoLoop) {
  for (const int min_gap_keyframes : {6, 30}) {
    SetUpAnew();
    options_.min_gap_keyframes = min_gap_keyframes;
    LoopCloser closer(camera_, options_);
    DriveOut(closer);
    Return(closer, 0, 0.5, min_gap_keyframes == 6 ? 4 : 5);
    EXPECT_TRUE(closer.loops().empty()) << min_gap_keyframes;
  }
}

/// 14 steps of 0.1 m: 0.37 m.
TEST_F(LoopCloserTest, RefusesALoopThatThePathCannotBeOffBy) {
  LoopCloser closer(camera_, options_);
  DriveOut(closer);
  Return(closer, 0, 2.5, 5);
  EXPECT_TRUE(closer.loops().empty());
  EXPECT_GE(closer.num_refused(), 1);
  EXPECT_FALSE(closer.has_news());
}

TEST_F(LoopCloserTest, WhatALoopHasToldCountsForTheNext) {
  for (const bool closes_one_before : {false, true}) {
    SetUpAnew();
    LoopCloser closer(camera_, options_);
    DriveOut(closer);
    if (closes_one_before) {
      Return(closer, 0, 0.5, 5);
      const std::vector<Rigid3> bent = closer.Bend(map_);
      for (size_t k = 0; k < bent.size(); ++k) map_.keyframes[k].camera_from_world = bent[k];
    }
    ASSERT_EQ(closer.loops().size(), closes_one_before);
    sigma_m_ = 0.001;
    Return(closer, 1, 0.8, 8);
    EXPECT_EQ(closer.loops().size() > closes_one_before, !closes_one_before);
    EXPECT_TRUE(closer.num_refused() > 0 || !closes_one_before);
  }
}

TEST_F(LoopCloserTest, ALoopThatAgreesIsKeptAndContradictsNothing) {
  LoopCloser closer(camera_, options_);
  DriveOut(closer);
  Return(closer, 0, 0, 5);
  EXPECT_EQ(closer.loops().size(), 1u);
  EXPECT_TRUE(closer.has_news());
  EXPECT_FALSE(closer.is_contradicted());
}

TEST_F(LoopCloserTest, ForgetsWhatIsLeftOutOfTheMapAndStillFindsTheRest) {
  options_.max_points = 2 * kPoints + 1;  // two places
  LoopCloser closer(camera_, options_);
  DriveOut(closer);
  Return(closer, 0, 0.5, 5);
  EXPECT_EQ(closer.loops().size(), 1u);
}

TEST_F(LoopCloserTest, RefusesOptionsThatLeaveNothing) {
  options_.min_gap_keyframes = 0;
  EXPECT_THROW(options_.Check(), std::invalid_argument);
  options_ = {};
  options_.max_points = 0;
  EXPECT_THROW(options_.Check(), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
