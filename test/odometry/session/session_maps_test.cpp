#include "session_fixture.h"

namespace arfm_vo {
namespace {

TEST_F(SessionTest, ANewMapKnowsNothingOfWhatContradictedTheOneBefore) {
  for (int i = 0; i < 6; ++i) Step(0.1 * i);
  StepWithObject(0.6);
  const TexturedWall elsewhere(2);
  SessionUpdate pose;
  for (int i = 0; i < 20 && pose.epoch < 2; ++i) pose = StepBefore(elsewhere);
  ASSERT_TRUE(pose.keyframe);
  EXPECT_GT(pose.keyframe->landmarks.size(), 100u);
  for (const Landmark& landmark : pose.keyframe->landmarks) {
    EXPECT_EQ(landmark.num_contradicted, 0) << landmark.keypoint.x << ", " << landmark.keypoint.y;
  }
}

TEST_F(SessionTest, StartsANewEpochWhereItMayBeWhenItWasLostTooLong) {
  Step(0);
  Step(0.05);
  const double before = Step(0.1).covariance(0, 0);
  for (int i = 0; i < 7; ++i) Step(0.1, 0, true);  // 0.7 s
  const TexturedWall elsewhere(2);
  const SessionUpdate found = StepBefore(elsewhere);
  ASSERT_TRUE(found.IsTracked()) << found.text;
  EXPECT_EQ(found.epoch, 2u);
  EXPECT_NEAR(found.odom_from_base.translation.x(), 0.5, 0.03);  // 0.5 m/s for 0.8 s
  EXPECT_GT(found.covariance(0, 0), before + 0.1);
}

TEST_F(SessionTest, BeginsAnewOnGroundThatTheMapDoesNotKnow) {
  const TexturedWall elsewhere(2);
  for (const int num_known : {4, 1}) {
    session_ = Session(Options());
    for (int i = 0; i < num_known; ++i) Step(0.3 * i);
    int num_unknown = 0;
    SessionUpdate pose;
    for (int i = 0; i < 5; ++i) {
      pose = StepBefore(elsewhere, {Eigen::Quaterniond::Identity(), {0, 0, -0.3 * i}});
      num_unknown += !pose.IsTracked();
    }
    EXPECT_EQ(num_unknown, 2);
    EXPECT_EQ(pose.epoch, 2u);
    const double error_m = pose.odom_from_base.translation.x() - 0.3 * (num_known + 4);
    EXPECT_LT(std::abs(error_m), 3 * std::sqrt(pose.covariance(0, 0))) << "its speed unknown at 1";
  }
}

TEST_F(SessionTest, DoubtsANewMapThatMovesOtherwiseThanTheOneBefore) {
  LocalOdometryOptions options;
  options.restart_after_lost_s = 0;
  // What hides the wall from now on and goes with the camera, and what soon hides that.
  const TexturedWall object(2), nearer_object(3);
  for (const uint32_t num_objects : {1, 2}) {
    session_ = Session(options);
    for (int i = 0; i < 4; ++i) Step(0.3 * i);
    int num_doubted = 0, num_named = 0;
    for (int i = 4; i < 34; ++i) {
      const SessionUpdate pose = StepBefore(num_objects == 2 && i > 6 ? nearer_object : object);
      const bool is_doubted = pose.epoch == 1 + num_objects && !pose.IsTracked();
      num_doubted += is_doubted;
      num_named += is_doubted && pose.update.reason == Reason::kNewMap;
      if (!pose.IsTracked()) continue;
      const double error_m = std::abs(pose.odom_from_base.translation.x() - 0.3 * i);
      EXPECT_LT(error_m, 3 * std::sqrt(pose.covariance(0, 0))) << num_objects << ", " << i;
    }
    EXPECT_NEAR(num_doubted * kInterval_s, 2, 0.15) << num_objects;
    EXPECT_EQ(num_named, num_doubted) << num_objects;
  }
}

TEST_F(SessionTest, BeginsNoEpochWithPairsWhosePicturesDoNotAgree) {
  for (int i = 0; i < 4; ++i) Step(0.3 * i);
  const TexturedWall elsewhere(2);
  for (int i = 0; i < 10; ++i) {
    stamp_s_ += kInterval_s;
    const StereoImages images = elsewhere.Render(stamp_s_, Rigid3());
    StereoFrame frame = frontend_.Process(images);
    ASSERT_GT(frame.points.size(), 100u);
    frame.row_agreement = 0.2;
    const SessionUpdate pose = session_.Process(frame, wall_.camera(), images, BaseFromCamera(0));
    EXPECT_FALSE(pose.IsTracked());
    EXPECT_EQ(pose.epoch, 1u) << i;
  }
}

TEST_F(SessionTest, AMapUpdateMovesTheTrajectoryAndNotThePose) {
  const SessionUpdate first = Step(0);
  Step(0.1);
  const MapUpdate update = MoveAhead(first, 1);
  session_.Offer(update, 7);  // of an epoch that is not
  EXPECT_NEAR(Step(0.2).odom_from_base.translation.x(), 0.2, 0.01);
  EXPECT_NEAR(session_.MakeTrajectory()[1].world_from_camera.translation.z(), 0.1, 0.01);
  session_.Offer(update, 1);
  EXPECT_NEAR(Step(0.3).odom_from_base.translation.x(), 0.3, 0.01);
  EXPECT_NEAR(session_.MakeTrajectory()[1].world_from_camera.translation.z(), 1.1, 0.01);
}

TEST_F(SessionTest, AnUpdateComesIntoForceAtItsFrameHoweverEarlyItIsOffered) {
  const SessionUpdate first = Step(0);
  const MapUpdate update = MoveAhead(first, 20);
  ASSERT_EQ(session_.TakeoverFrame(update), 3u);  // of frame 0, 1 + 20 / 10 later
  session_.Offer(update, 1);
  const auto adjusted_z = [&] {
    return session_.MakeTrajectory()[0].world_from_camera.translation.z() -
           session_.MakeTrajectory()[1].world_from_camera.translation.z();
  };
  Step(0);
  Step(0);
  EXPECT_NEAR(adjusted_z(), 0, 0.01);
  const Trajectory before = session_.MakeTrajectory();
  Step(0);
  EXPECT_EQ(session_.num_frames(), 4u);
  session_.Offer(update, 1);
  session_.TakeOffer();
  EXPECT_EQ(session_.MakeTrajectory().size(), 4u);
}

TEST_F(SessionTest, TheTrajectoryGoesOnThroughEpochsAndLostPairs) {
  Step(0, 0, true);
  for (int i = 0; i < 4; ++i) Step(0.05 * i);
  Step(0.2, 0, true);
  session_.StartEpoch();
  for (int i = 3; i < 6; ++i) Step(0.05 * i);
  const Trajectory trajectory = session_.MakeTrajectory();
  ASSERT_EQ(trajectory.size(), 9u);
  EXPECT_FALSE(trajectory[0].is_tracked);
  EXPECT_LT(trajectory[1].world_from_camera.translation.norm(), 1e-9);
  EXPECT_NEAR(trajectory[4].world_from_camera.translation.z(), 0.15, 0.01);
  EXPECT_FALSE(trajectory[5].is_tracked);
  EXPECT_NEAR(trajectory[6].world_from_camera.translation.z(), 0.2, 0.01);  // gone on in the dark
  EXPECT_NEAR(trajectory[8].world_from_camera.translation.z(), 0.3, 0.01);
  for (size_t i = 1; i < trajectory.size(); ++i)
    EXPECT_GT(trajectory[i].stamp_s, trajectory[i - 1].stamp_s);
}

}  // namespace
}  // namespace arfm_vo
