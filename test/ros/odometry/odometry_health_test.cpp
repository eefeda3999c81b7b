#include "arfm_vo/ros/odometry/odometry_health.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "ros/expect_throw.h"

namespace arfm_vo {
namespace {

using diagnostic_msgs::DiagnosticStatus;
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
  OdometryHealth health{OdometryHealthOptions()};
  for (int i = 0; i < 10; ++i) health.Count(FrameWithRows(row_residual_px), kTracked, 1);
  Wrapper status;
  health.ReportCalibration(status);
  return status.level;
}

TEST(OdometryHealth, PairsAreCounted) {
  OdometryHealth health{OdometryHealthOptions()};
  health.Count(FrameWithRows(0), kTracked, 1);
  health.Count(FrameWithRows(0), PoseWithStatus(PoseStatus::kTooFewFeatures, "dark"), 1);
  health.CountRefused("a pair without a picture");
  health.CountRefused("a pair without a picture");
  health.CountRefused("a pair without a picture");
  health.CountDropped(4);
  Wrapper status;
  health.ReportOdometry(status);
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

TEST(OdometryHealth, ASkewBetweenTheEyesIsToldInMilliseconds) {
  OdometryHealth health{OdometryHealthOptions()};
  SessionUpdate pose = kTracked;
  pose.update.skew = EyeSkew{-0.0101, 0.0002};
  health.Count(FrameWithRows(0.3), pose, 1);
  Wrapper status;
  health.ReportCalibration(status);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, "the right picture is taken 10.1 ms before the left one (sigma 0.2)");
}

TEST(OdometryHealth, OneBadPairDoesNotMoveTheMedian) {
  OdometryHealth health{OdometryHealthOptions()};
  for (int i = 0; i < 10; ++i) health.Count(FrameWithRows(i == 5 ? 3 : 0.2), kTracked, 1);
  Wrapper status;
  health.ReportCalibration(status);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
}

TEST(OdometryHealth, LostIsAnError) {
  OdometryHealth health{OdometryHealthOptions()};
  const auto report = [&] {
    Wrapper status;
    health.ReportOdometry(status);
    return status;
  };
  EXPECT_EQ(report().level, DiagnosticStatus::WARN);  // no pairs yet
  health.Count({}, kTracked, 1);
  EXPECT_EQ(report().level, DiagnosticStatus::OK);
  EXPECT_EQ(report().level, DiagnosticStatus::WARN);  // none since
  health.Count({}, PoseWithStatus(PoseStatus::kTooFewMatches, "too few matches"), 1);
  const Wrapper lost = report();
  EXPECT_EQ(lost.level, DiagnosticStatus::ERROR);
  EXPECT_THAT(lost.message, testing::HasSubstr("too few matches"));
  health.Count({}, PoseWithStatus(PoseStatus::kHeadSlewing, "head slewing"), 1);
  EXPECT_EQ(report().level, DiagnosticStatus::WARN);
  health.CountRefused("left/image_rect: the image is empty");
  EXPECT_EQ(report().level, DiagnosticStatus::ERROR);
}

/// What is told where the eyes see `ratio` times the way of the tracks.
Wrapper ReportScale(double ratio) {
  OdometryHealth health{OdometryHealthOptions()};
  for (int i = 0; i < 200; ++i) {
    health.scale().AddTrack(0.1 * i, {0.1 * i, 0, 0});
    SessionUpdate pose = kTracked;
    pose.update.stamp_s = 0.1 * i - 0.05;
    pose.odom_from_base.translation = {ratio * 0.1 * i, 0, 0};
    health.Count({}, pose, 1);
  }
  Wrapper status;
  health.ReportScale(status);
  return status;
}

TEST(OdometryHealth, AScaleThatDisagreesWithTheTracksIsTold) {
  EXPECT_EQ(ReportScale(1).level, DiagnosticStatus::OK);
  EXPECT_EQ(ReportScale(1.3).level, DiagnosticStatus::WARN);
  EXPECT_THAT(ReportScale(1.3).message, testing::HasSubstr("1.30"));
  EXPECT_EQ(ReportScale(2).level, DiagnosticStatus::ERROR);
}

TEST(OdometryHealth, OptionsAreChecked) {
  OdometryHealthOptions options;
  options.row_residual_error_px = 0.1;
  EXPECT_INVALID(OdometryHealth{options}, "row_residual_error_px");
}

}  // namespace
}  // namespace arfm_vo
