#include "arfm_vo/ros/odometry/odometry_health.h"

#include <gmock/gmock.h>

#include <map>

#include "base/refusal.h"

namespace arfm_vo {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using testing::HasSubstr;
using Wrapper = diagnostic_updater::DiagnosticStatusWrapper;

StereoFrame FrameWithRows(double row_residual_px) {
  StereoFrame frame;
  for (const double part : {-1.0, 1.0, 1.0}) {
    StereoPoint point;
    point.row_residual_px = part * row_residual_px;
    frame.points.push_back(point);
  }
  return frame;
}

SessionUpdate PoseWithStatus(PoseStatus status, const std::string& text) {
  SessionUpdate pose;
  pose.update.pose.status = status;
  pose.update.pose.num_inliers = pose.HasPose() ? 50 : 0;
  pose.text = text;
  return pose;
}

const SessionUpdate kTracked = PoseWithStatus(PoseStatus::kTracked, "tracked");

int LevelOfRows(double row_residual_px) {
  OdometryHealth health;
  for (int i = 0; i < 10; ++i) health.Count(FrameWithRows(row_residual_px), kTracked, 1, 0);
  Wrapper status;
  health.ReportCalibration(status);
  return status.level;
}

class OdometryHealthTest : public testing::Test {
 protected:
  using Report = void (OdometryHealth::*)(Wrapper&);
  Wrapper Told(Report report) {
    Wrapper status;
    (health_.*report)(status);
    return status;
  }
  OdometryHealth health_;
};

TEST_F(OdometryHealthTest, PairsAreCounted) {
  health_.Count(FrameWithRows(0), kTracked, 1, 0);
  health_.Count(FrameWithRows(0), PoseWithStatus(PoseStatus::kTooFewFeatures, "dark"), 1, 0);
  health_.CountRefused("a pair without a picture");
  health_.CountRefused("a pair without a picture");
  health_.CountRefused("a pair without a picture");
  health_.CountDropped(4);
  const Wrapper status = Told(&OdometryHealth::ReportOdometry);
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_EQ(status.message, "pair refused: a pair without a picture");
  std::map<std::string, std::string> told;
  for (const auto& figure : status.values) told[figure.key] = figure.value;
  EXPECT_EQ(told["pairs"], "2");
  EXPECT_EQ(told["pairs without a pose"], "1");
  EXPECT_EQ(told["pairs refused"], "3");
  EXPECT_EQ(told["pairs dropped"], "4");
}

TEST(OdometryHealth, TheRowResidualWarnsAtHalfAPixelAndIsAnErrorAtOne) {
  EXPECT_EQ(LevelOfRows(0.3), DiagnosticStatus::OK);
  EXPECT_EQ(LevelOfRows(0.6), DiagnosticStatus::WARN);
  EXPECT_EQ(LevelOfRows(1.1), DiagnosticStatus::ERROR);
}

TEST_F(OdometryHealthTest, ASkewBetweenTheCamerasIsToldInMilliseconds) {
  SessionUpdate pose = kTracked;
  pose.update.skew = StereoSkew{-0.0101, 0.0002};
  health_.Count(FrameWithRows(0.3), pose, 1, 0);
  const Wrapper status = Told(&OdometryHealth::ReportCalibration);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, "the right picture is taken 10.1 ms before the left one (sigma 0.2)");
}

TEST_F(OdometryHealthTest, OneBadPairDoesNotMoveTheMedian) {
  for (int i = 0; i < 10; ++i) health_.Count(FrameWithRows(i == 5 ? 3 : 0.2), kTracked, 1, 0);
  const Wrapper status = Told(&OdometryHealth::ReportCalibration);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
}

TEST_F(OdometryHealthTest, LostIsAnError) {
  const auto report = [this] { return Told(&OdometryHealth::ReportOdometry); };
  EXPECT_EQ(report().level, DiagnosticStatus::WARN);  // no pairs yet
  health_.Count({}, kTracked, 1, 0);
  EXPECT_EQ(report().level, DiagnosticStatus::OK);
  EXPECT_EQ(report().level, DiagnosticStatus::WARN);  // none since
  health_.Count({}, PoseWithStatus(PoseStatus::kTooFewMatches, "too few matches"), 1, 0);
  const Wrapper lost = report();
  EXPECT_EQ(lost.level, DiagnosticStatus::ERROR);
  EXPECT_THAT(lost.message, testing::HasSubstr("too few matches"));
  health_.Count({}, PoseWithStatus(PoseStatus::kHeadSlewing, "head slewing"), 1, 0);
  EXPECT_EQ(report().level, DiagnosticStatus::WARN);
  health_.CountRefused("left/image_rect: the image is empty");
  EXPECT_EQ(report().level, DiagnosticStatus::ERROR);
}

/// Gives pairs of one second apart until something is told.
std::optional<ConsoleLine> Watch(OdometryHealth& health, double start_s, const SessionUpdate& pose,
                                 const StereoFrame& frame = {}) {
  for (double s = start_s; s < start_s + 10; ++s)
    if (const auto line = health.Count(frame, pose, 1, s)) return line;
  return std::nullopt;
}

TEST_F(OdometryHealthTest, TellsTheFirstPoseOnce) {
  const auto line = Watch(health_, 0, kTracked);
  ASSERT_TRUE(line);
  EXPECT_FALSE(line->is_warning);
  EXPECT_THAT(line->text, HasSubstr("the first pose is there"));
  EXPECT_FALSE(Watch(health_, 1, kTracked));
}

TEST_F(OdometryHealthTest, SaysWhyItIsLostAndWhenItIsBack) {
  health_.Count({}, kTracked, 1, 0);
  const auto lost =
      Watch(health_, 1, PoseWithStatus(PoseStatus::kTooFewFeatures, "too few features"));
  ASSERT_TRUE(lost);
  EXPECT_TRUE(lost->is_warning);
  EXPECT_THAT(lost->text, HasSubstr("too few features"));
  EXPECT_THAT(lost->text, HasSubstr("without texture"));
  const auto back = health_.Count({}, kTracked, 1, 5);
  ASSERT_TRUE(back);
  EXPECT_FALSE(back->is_warning);
  EXPECT_THAT(back->text, HasSubstr("after 5.0 s"));
}

/// With 500 features, of which so many are stereo points.
StereoFrame ToldFrame(int num_points) {
  StereoFrame frame;
  frame.features.keypoints.resize(500);
  frame.features.descriptors.create(500, 64, CV_32F);
  frame.points.resize(num_points);
  return frame;
}

TEST(OdometryHealth, WhatLastsIsWarnedOfWithItsRemedy) {
  const struct {
    PoseStatus status;
    const char* text;
    int num_points;
    std::vector<const char*> told;
  } kCases[] = {{PoseStatus::kNoTransform,
                 "no transform: tf base_link <- camera: no tree",
                 0,
                 {"base_link <- camera", "base_from_camera:="}},
                {PoseStatus::kNoTransform,
                 "Lookup would require extrapolation into the future.",
                 0,
                 {"tf_timeout_s"}},
                {PoseStatus::kTooFewFeatures, "too few", 0, {"the cameras not swapped"}},
                {PoseStatus::kTooFewMatches, "too few matches", 300, {"too fast"}}};
  for (const auto& [status, text, num_points, told] : kCases) {
    OdometryHealth health;
    const auto line = Watch(health, 0, PoseWithStatus(status, text), ToldFrame(num_points));
    ASSERT_TRUE(line) << text;
    EXPECT_TRUE(line->is_warning) << text;
    for (const char* part : told) EXPECT_THAT(line->text, HasSubstr(part));
  }
}

TEST_F(OdometryHealthTest, SaysWhyAPoseIsDegraded) {
  health_.Count({}, kTracked, 1, 0);
  const auto degraded =
      Watch(health_, 1, PoseWithStatus(PoseStatus::kDegraded, "the right camera is dark"));
  ASSERT_TRUE(degraded);
  EXPECT_TRUE(degraded->is_warning);
  EXPECT_EQ(degraded->text, "the right camera is dark");
  EXPECT_THAT(health_.Count({}, kTracked, 1, 20)->text, HasSubstr("tracked again"));
}

TEST_F(OdometryHealthTest, CountsAllPairsInTheTotals) {
  health_.Count({}, kTracked, 1, 0);
  health_.Count({}, PoseWithStatus(PoseStatus::kNoConsensus, "no consensus"), 1, 1);
  health_.Count({}, PoseWithStatus(PoseStatus::kNoTransform, "no transform"), 1, 2);
  health_.CountDropped(4);
  for (int i = 0; i < 5; ++i) health_.CountRefused("an image without pixels");
  EXPECT_EQ(health_.Totals(),
            "3 pairs: 1 with a pose, 1 lost, 0 degraded, 1 without tf or skipped while the head "
            "turned; 4 dropped, 5 refused");
}

}  // namespace
}  // namespace arfm_vo
