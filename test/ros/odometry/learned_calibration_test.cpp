#include "arfm_vo/ros/odometry/learned_calibration.h"

#include <gtest/gtest.h>
#include <ros/time.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "arfm_vo/configuration/learned_correction_file.h"
#include "base/folder_test.h"

namespace arfm_vo {
namespace {

const StereoCamera kLearningCamera{400, 400, 320, 240, 0.3, 640, 480};

CorrectionBelief Learned(double column_px) {
  CorrectionBelief correction = CorrectionBelief::Isotropic(0.1);
  correction.mean.coefficients_px[0] = column_px;
  return correction;
}

/// An empty folder that is ROS's own.
class LearnedCalibrationTest : public FolderTest {
 protected:
  LearnedCalibrationTest() { ::setenv("ROS_HOME", folder_.c_str(), 1); }
  ~LearnedCalibrationTest() override { ::unsetenv("ROS_HOME"); }
  std::filesystem::path File() const {
    return folder_ / "arfm_vo" / NameLearnedCorrection(kLearningCamera);
  }
};

TEST_F(LearnedCalibrationTest, ADriveBeginsWithWhatTheLastOneTold) {
  LearnedCalibration first(true);
  EXPECT_FALSE(first.ReadFor(kLearningCamera));
  first.Write(Learned(0.25));
  EXPECT_TRUE(std::filesystem::exists(File()));
  LearnedCalibration second(true);
  const auto known = second.ReadFor(kLearningCamera);
  ASSERT_TRUE(known);
  EXPECT_EQ(known->mean.coefficients_px, Learned(0.25).mean.coefficients_px);
  EXPECT_FALSE(second.ReadFor(kLearningCamera)) << "once";
}

TEST_F(LearnedCalibrationTest, WhatHasNotChangedIsNotWrittenAgain) {
  LearnedCalibration learned(true);
  learned.ReadFor(kLearningCamera);
  learned.Write(Learned(0.25));
  std::filesystem::remove(File());
  learned.Write(Learned(0.25));
  EXPECT_FALSE(std::filesystem::exists(File()));
  learned.Write(Learned(0.5));
  EXPECT_TRUE(std::filesystem::exists(File()));
}

TEST_F(LearnedCalibrationTest, SwitchedOffItNeitherReadsNorWrites) {
  LearnedCalibration earlier(true);
  earlier.ReadFor(kLearningCamera);
  earlier.Write(Learned(0.25));
  LearnedCalibration off(false);
  EXPECT_FALSE(off.ReadFor(kLearningCamera));
  std::filesystem::remove(File());
  off.Write(Learned(0.5));
  EXPECT_FALSE(std::filesystem::exists(File()));
}

TEST_F(LearnedCalibrationTest, WithoutACameraNothingIsWritten) {
  LearnedCalibration learned(true);
  learned.Write(Learned(0.25));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "arfm_vo"));
}

TEST_F(LearnedCalibrationTest, AFileThatIsNoneStopsNothing) {
  std::filesystem::create_directories(folder_ / "arfm_vo");
  std::ofstream(File()) << "neither: [here";
  EXPECT_FALSE(LearnedCalibration(true).ReadFor(kLearningCamera));
}

TEST_F(LearnedCalibrationTest, AFolderThatCannotBeMadeStopsNothing) {
  ros::Time::init();  // the warning's
  std::ofstream(folder_ / "arfm_vo") << "no folder";
  LearnedCalibration learned(true);
  EXPECT_FALSE(learned.ReadFor(kLearningCamera));
  learned.Write(Learned(0.25));
  EXPECT_TRUE(std::filesystem::is_regular_file(folder_ / "arfm_vo"));
}

}  // namespace
}  // namespace arfm_vo
