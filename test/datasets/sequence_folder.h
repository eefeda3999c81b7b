#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {

/// A KITTI odometry folder with tiny images under the system's temporary folder, gone with the
/// object. The grey value of every pixel of left image i is 10 i, of right image i 10 i + 5.
class SequenceFolder {
 public:
  explicit SequenceFolder(int num_pairs, const std::string& name = "sequence") {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = std::filesystem::temp_directory_path() /
            ("arfm_vo_" + std::string(test->test_suite_name()) + "_" + test->name());
    std::filesystem::remove_all(root_);
    path_ = root_ / name;
    for (const char* side : {"image_0", "image_1"})
      std::filesystem::create_directories(path_ / side);
    std::string poses;
    for (int i = 0; i < num_pairs; ++i) {
      WriteImage(Left(i), 10 * i);
      WriteImage(Right(i), 10 * i + 5);
      poses += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(i) + "\n";
    }
    Write("poses.txt", poses);
    Write("calib.txt", Calibration("-350"));
  }
  ~SequenceFolder() { std::filesystem::remove_all(root_); }

  /// fx = fy = 700, baseline -`p1_3` / 700 m.
  static std::string Calibration(const std::string& p1_3) {
    return "P0: 700 0 8 0 0 700 6 0 0 0 1 0\nP1: 700 0 8 " + p1_3 + " 0 700 6 0 0 0 1 0\n";
  }
  static std::string Name(int i) { return "00000" + std::to_string(i) + ".png"; }
  std::string Left(int i) const { return (path_ / "image_0" / Name(i)).string(); }
  std::string Right(int i) const { return (path_ / "image_1" / Name(i)).string(); }
  std::string File(const std::string& name) const { return (path_ / name).string(); }
  std::string Path() const { return path_.string(); }
  std::string Root() const { return root_.string(); }
  void Write(const std::string& name, const std::string& text) const {
    WriteWholeFile(File(name), text);
  }
  static void WriteImage(const std::string& path, int grey, cv::Size size = {16, 12}) {
    cv::imwrite(path, cv::Mat(size, CV_8UC1, cv::Scalar(grey)));
  }

 private:
  std::filesystem::path root_, path_;
};

}  // namespace arfm_vo
