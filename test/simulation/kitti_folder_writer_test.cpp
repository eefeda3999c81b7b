#include "arfm_vo/simulation/kitti_folder_writer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/simulation/scene.h"
#include "base/folder_test.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

const StereoCamera kFolderCamera{420, 421, 7.5, 5.5, 0.2, 16, 12};

class KittiFolderWriterTest : public FolderTest {
 protected:
  StereoImages Pair(double stamp_s, int grey) const {
    return {stamp_s, cv::Mat(12, 16, CV_8UC1, cv::Scalar(grey)),
            cv::Mat(12, 16, CV_8UC1, cv::Scalar(grey + 1))};
  }
  std::string File(const std::string& name) const { return (made_ / name).string(); }

  const fs::path made_ = folder_ / "made";
};

TEST_F(KittiFolderWriterTest, WritesWhatAKittiFolderHolds) {
  KittiFolderWriter writer(made_.string(), kFolderCamera);
  writer.Write(Pair(0, 10), Rigid3());
  writer.Write(Pair(0.5, 20), Rigid3(Eigen::Quaterniond::Identity(), {0.25, 0, -1}));
  writer.Close();
  EXPECT_EQ(ReadWholeFile(File("calib.txt")),
            "P0: 420 0 7.5 0 0 421 5.5 0 0 0 1 0\nP1: 420 0 7.5 -84 0 421 5.5 0 0 0 1 0\n");
  EXPECT_EQ(ReadWholeFile(File("times.txt")), "0\n0.5\n");
  EXPECT_EQ(ReadWholeFile(File("poses.txt")),
            "1 0 0 0 0 1 0 0 0 0 1 0\n"
            "1 0 0 0.25 0 1 0 0 0 0 1 -1\n");
  EXPECT_EQ(cv::imread(File("image_0/000001.png"), cv::IMREAD_UNCHANGED).at<uint8_t>(3, 4), 20);
  EXPECT_EQ(cv::imread(File("image_1/000001.png"), cv::IMREAD_UNCHANGED).at<uint8_t>(3, 4), 21);
}

TEST_F(KittiFolderWriterTest, LeavesNothingWhereItWasNotClosed) {
  {
    KittiFolderWriter writer(made_.string(), kFolderCamera);
    writer.Write(Pair(0, 10), Rigid3());
  }
  EXPECT_FALSE(fs::exists(made_));
  EXPECT_FALSE(fs::exists(made_.string() + ".unfinished"));
}

TEST_F(KittiFolderWriterTest, RefusesAFolderThatExists) {
  fs::create_directories(made_);
  EXPECT_THROW(KittiFolderWriter(made_.string(), kFolderCamera), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
