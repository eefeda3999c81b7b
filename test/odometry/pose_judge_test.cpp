#include "odometry/pose_judge.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

const StereoCamera kCamera{700, 700, 320, 240, 0.5, 640, 480};

/// A pair of 40 points with this disparity, spread over the picture.
StereoFrame MakeFrame(double disparity_px) {
  StereoFrame frame;
  frame.stamp_s = 1;
  frame.features.descriptors = cv::Mat(40, 64, CV_32F, cv::Scalar(0.125));
  frame.num_right_keypoints = 40;
  for (int i = 0; i < 40; ++i) {
    Keypoint keypoint;
    keypoint.x = static_cast<float>(60 + 70 * (i % 8));
    keypoint.y = static_cast<float>(60 + 80 * (i / 8));
    keypoint.scale = 2;
    frame.features.keypoints.push_back(keypoint);
    StereoPoint point;
    point.keypoint = i;
    point.observation << keypoint.x, keypoint.y, keypoint.x - disparity_px;
    point.sigma_px = 0.3;
    point.x_in_camera = kCamera.Triangulate(keypoint.x, keypoint.y, disparity_px);
    frame.points.push_back(point);
  }
  return frame;
}

/// A map of such a pair, and the pair tracked in it, its points known or new.
class PoseJudgeTest : public testing::Test {
 protected:
  void Track(double disparity_px, bool are_known) {
    frame_ = MakeFrame(disparity_px);
    const Keyframe& keyframe =
        map_.AddKeyframe(frame_, cv::Mat(480, 640, CV_8UC1, cv::Scalar(0)), Rigid3(), {});
    tracked_.observations = keyframe.observations;
    tracked_.pose.status = PoseStatus::kTracked;
    std::vector<LandmarkId> expected;
    for (const LandmarkObservation& seen : keyframe.observations) {
      expected.push_back(seen.landmark);
    }
    if (are_known) map_.CountSightings(expected, keyframe.observations);
  }
  PoseJudge::Verdict Judge() {
    update_ = {};
    update_.pose = tracked_.pose;
    return judge_.Judge(map_, tracked_, update_);
  }
  void ExpectPose(PoseStatus status, const std::string& remark) const {
    EXPECT_EQ(update_.pose.status, status);
    EXPECT_EQ(update_.remark, remark);
  }

  LocalMap map_{kCamera, LocalMapOptions()};
  StereoFrame frame_;
  TrackedFrame tracked_;
  OdometryUpdate update_;
  PoseJudge judge_{kCamera};
};

TEST_F(PoseJudgeTest, BelievesWhatNobodyContests) {
  Track(35, true);
  judge_.Look(frame_);
  const PoseJudge::Verdict verdict = Judge();
  EXPECT_TRUE(verdict.is_believed);
  EXPECT_TRUE(verdict.are_depths_known);
  ExpectPose(PoseStatus::kTracked, "");
}

TEST_F(PoseJudgeTest, AContestedPoseOfNewPointsIsNoneAndMayBeToldLater) {
  Track(35, false);
  tracked_.pose.contest = 0.8;
  judge_.Look(frame_);
  EXPECT_FALSE(Judge().is_believed);
  ExpectPose(PoseStatus::kNoConsensus, "two groups of points move differently");
  EXPECT_TRUE(update_.is_disputed);
  EXPECT_TRUE(judge_.IsWary());
  judge_.Reset(false);
  EXPECT_FALSE(judge_.IsWary());
  judge_.Reset(true);
  EXPECT_TRUE(judge_.IsWary());
}

TEST_F(PoseJudgeTest, WhatKnownPointsDenyLeavesADoubt) {
  Track(35, true);
  judge_.Look(frame_);
  tracked_.shares.known = tracked_.shares.fresh = 0.9;
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(Judge().is_believed);
  tracked_.shares.known = 0.1;
  EXPECT_FALSE(Judge().is_believed);
  EXPECT_TRUE(judge_.IsDoubtful());
  tracked_.shares.known = 0.9;
  EXPECT_TRUE(Judge().is_believed);
  ExpectPose(PoseStatus::kDegraded, "two groups of points moved differently a moment ago");
}

TEST_F(PoseJudgeTest, TheLeftEyeAloneDegrades) {
  Track(35, true);
  frame_.right_is_repeated = true;
  judge_.Look(frame_);
  EXPECT_TRUE(Judge().is_believed);
  ExpectPose(PoseStatus::kDegraded,
             "the right camera repeats its picture, the left one alone tells");
}

TEST_F(PoseJudgeTest, PointsTooFarToTellTheLengthOfTheWayDegrade) {
  Track(0.4, true);
  judge_.Look(frame_);
  const PoseJudge::Verdict verdict = Judge();
  EXPECT_TRUE(verdict.is_believed);
  EXPECT_FALSE(verdict.are_depths_known);
  ExpectPose(PoseStatus::kDegraded, "most points are too far to tell how long the way is");
}

}  // namespace
}  // namespace arfm_vo
