#include "arfm_vo/ros/odometry/odometry_console.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

using testing::HasSubstr;

TEST(ConsoleWatch, TellsWhatLastsAndRepeatsItSeldom) {
  ConsoleWatch watch;
  int num_told = 0;
  for (int s = 0; s <= 25; ++s) num_told += watch.IsDue("problem", s);
  EXPECT_EQ(num_told, 3);  // at 2, 12 and 22 s
}

TEST(ConsoleWatch, DoesNotTellWhatPasses) {
  ConsoleWatch watch;
  for (int s = 0; s <= 30; ++s) EXPECT_FALSE(watch.IsDue(s % 2 ? "problem" : "", s)) << s;
}

SessionUpdate ToldPose(PoseStatus status, const std::string& text) {
  SessionUpdate pose;
  pose.update.pose.status = status;
  pose.text = text;
  return pose;
}

/// Gives pairs of one second apart until something is told.
std::optional<ConsoleLine> Watch(OdometryConsole& console, double start_s,
                                 const SessionUpdate& pose, const StereoFrame& frame = {}) {
  for (double s = start_s; s < start_s + 10; ++s)
    if (const auto line = console.Take(frame, pose, s)) return line;
  return std::nullopt;
}

const SessionUpdate kToldTracked = ToldPose(PoseStatus::kTracked, "tracked");

TEST(OdometryConsole, TellsTheFirstPoseOnce) {
  OdometryConsole console;
  const auto line = Watch(console, 0, kToldTracked);
  ASSERT_TRUE(line);
  EXPECT_FALSE(line->is_warning);
  EXPECT_THAT(line->text, HasSubstr("the first pose is there"));
  EXPECT_FALSE(Watch(console, 1, kToldTracked));
}

TEST(OdometryConsole, ATransformThatIsMissingIsNamedWithTheRemedy) {
  OdometryConsole console;
  const auto line =
      Watch(console, 0,
            ToldPose(PoseStatus::kNoTransform, "no transform: tf base_link <- camera: no tree"));
  ASSERT_TRUE(line);
  EXPECT_TRUE(line->is_warning);
  EXPECT_THAT(line->text, HasSubstr("base_link <- camera"));
  EXPECT_THAT(line->text, HasSubstr("base_from_camera:="));
}

TEST(OdometryConsole, ATransformThatComesLateIsTold) {
  OdometryConsole console;
  const auto line = Watch(
      console, 0,
      ToldPose(PoseStatus::kNoTransform, "Lookup would require extrapolation into the future."));
  ASSERT_TRUE(line);
  EXPECT_THAT(line->text, HasSubstr("tf_timeout_s"));
}

TEST(OdometryConsole, SaysWhyItIsLostAndWhenItIsBack) {
  OdometryConsole console;
  console.Take({}, kToldTracked, 0);
  const auto lost = Watch(console, 1, ToldPose(PoseStatus::kTooFewFeatures, "too few features"));
  ASSERT_TRUE(lost);
  EXPECT_TRUE(lost->is_warning);
  EXPECT_THAT(lost->text, HasSubstr("too few features"));
  EXPECT_THAT(lost->text, HasSubstr("without texture"));
  const auto back = console.Take({}, kToldTracked, 5);
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

TEST(OdometryConsole, EyesThatDoNotFitAreTold) {
  OdometryConsole console;
  const StereoFrame frame = ToldFrame(0);
  const auto line = Watch(console, 0, ToldPose(PoseStatus::kTooFewFeatures, "too few"), frame);
  ASSERT_TRUE(line);
  EXPECT_THAT(line->text, HasSubstr("the eyes not swapped"));
}

TEST(OdometryConsole, WhereEyesFitAndTheMapIsNotFoundTheMotionMayBeTooFast) {
  OdometryConsole console;
  const StereoFrame frame = ToldFrame(300);
  const auto line =
      Watch(console, 0, ToldPose(PoseStatus::kTooFewMatches, "too few matches"), frame);
  ASSERT_TRUE(line);
  EXPECT_THAT(line->text, HasSubstr("too fast"));
}

TEST(OdometryConsole, SaysWhyAPoseIsDegraded) {
  OdometryConsole console;
  console.Take({}, kToldTracked, 0);
  const auto degraded =
      Watch(console, 1, ToldPose(PoseStatus::kDegraded, "the right camera is dark"));
  ASSERT_TRUE(degraded);
  EXPECT_TRUE(degraded->is_warning);
  EXPECT_EQ(degraded->text, "the right camera is dark");
  EXPECT_THAT(console.Take({}, kToldTracked, 20)->text, HasSubstr("tracked again"));
}

TEST(OdometryConsole, CountsAllPairsInTheTotals) {
  OdometryConsole console;
  console.Take({}, kToldTracked, 0);
  console.Take({}, ToldPose(PoseStatus::kNoConsensus, "no consensus"), 1);
  console.Take({}, ToldPose(PoseStatus::kNoTransform, "no transform"), 2);
  EXPECT_EQ(console.Totals(4, 5),
            "3 pairs: 1 with a pose, 1 lost, 0 degraded, 1 without tf or skipped while the head "
            "turned; 4 "
            "dropped, 5 refused");
}

}  // namespace
}  // namespace arfm_vo
