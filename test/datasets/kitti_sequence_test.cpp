#include "arfm_vo/datasets/kitti_sequence.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "arfm_vo/datasets/kitti_files.h"
#include "base/refusal.h"
#include "datasets/sequence_folder.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

/// What opening and reading the whole folder complains of.
std::string ErrorOf(const std::string& folder) {
  return RefusalOf([&] {
    KittiSequence sequence(folder);
    while (sequence.Next()) {
    }
  });
}

TEST(KittiSequence, GivesPairsStampsTruthAndCamera) {
  const SequenceFolder folder(3);
  folder.Write("times.txt", "0\n0.125\n0.5\n");
  KittiSequence sequence(folder.Path());
  EXPECT_EQ(sequence.size(), 3);
  EXPECT_TRUE(sequence.camera() == (StereoCamera{700, 700, 8, 6, 0.5, 16, 12}));
  const double stamps_s[] = {0, 0.125, 0.5};
  for (int i = 0; i < 3; ++i) {
    const auto pair = sequence.Next();
    ASSERT_TRUE(pair);
    pair->images.Check();
    EXPECT_EQ(pair->images.stamp_s, stamps_s[i]);
    EXPECT_EQ(pair->images.left.at<uint8_t>(3, 4), 10 * i);
    EXPECT_EQ(pair->images.right.at<uint8_t>(3, 4), 10 * i + 5);
    EXPECT_EQ(pair->true_world_from_camera->translation.z(), i);
  }
  EXPECT_FALSE(sequence.Next());
  EXPECT_FALSE(sequence.Next());
}

TEST(KittiSequence, WithoutTimesAndPosesItIsTenHertzAndWithoutTruth) {
  const SequenceFolder folder(2);
  fs::remove(folder.File("poses.txt"));
  KittiSequence sequence(folder.Path());
  EXPECT_FALSE(sequence.Next()->true_world_from_camera);
  EXPECT_EQ(sequence.Next()->images.stamp_s, 0.1);
}

TEST(KittiSequence, TakesEveryKthPairAndNotMoreThanAsked) {
  const SequenceFolder folder(7);
  KittiSequence sequence(folder.Path(), {3, 2});
  EXPECT_EQ(sequence.size(), 2);
  EXPECT_EQ(sequence.Next()->images.left.at<uint8_t>(0, 0), 0);
  const auto second = sequence.Next();
  EXPECT_EQ(second->images.left.at<uint8_t>(0, 0), 30);
  EXPECT_EQ(second->images.stamp_s, 0.3);
  EXPECT_EQ(second->true_world_from_camera->translation.z(), 3);
  EXPECT_FALSE(sequence.Next());
  EXPECT_EQ(KittiSequence(folder.Path(), {3}).size(), 3);
  EXPECT_THROW(KittiSequence(folder.Path(), {0}), std::invalid_argument);
  EXPECT_THROW(KittiSequence(folder.Path(), {1, 0}), std::invalid_argument);
}

TEST(KittiSequence, FindsThePosesOfTheOfficialLayout) {
  const SequenceFolder folder(2, "sequences/06");
  fs::create_directories(folder.Root() + "/poses");
  fs::rename(folder.File("poses.txt"), folder.Root() + "/poses/06.txt");
  EXPECT_TRUE(KittiSequence(folder.Path()).Next()->true_world_from_camera);
  EXPECT_TRUE(KittiSequence(folder.Path() + "/").Next()->true_world_from_camera);
}

TEST(KittiSequence, ReadsTheLayoutOfTheRawData) {
  const SequenceFolder folder(2, "2011_09_26/2011_09_26_drive_0001_sync");
  fs::create_directories(folder.File("image_00"));
  fs::create_directories(folder.File("image_01"));
  fs::rename(folder.File("image_0"), folder.File("image_00/data"));
  fs::rename(folder.File("image_1"), folder.File("image_01/data"));
  folder.Write("image_00/timestamps.txt",
               "2011-09-26 23:59:59.750000000\n2011-09-27 00:00:01.000000000\n");
  fs::remove(folder.File("calib.txt"));
  folder.Write("../calib_cam_to_cam.txt",
               "P_00: 1\nP_rect_00: 7e2 0 8 0 0 700 6 0 0 0 1 0\n"
               "P_rect_01: 700 0 8 -350 0 700 6 0 0 0 1 0\n");
  KittiSequence sequence(folder.Path());
  EXPECT_EQ(sequence.camera().baseline_m, 0.5);
  sequence.Next();
  EXPECT_EQ(sequence.Next()->images.stamp_s, 1.25);
}

TEST(KittiTimes, ADateThatIsNoneIsRefused) {
  const SequenceFolder folder(1);
  for (const char* date :
       {"-2147483648-01-01 00:00:00", "2011-13-26 13:02:25", "2011-09-32 13:02:25",
        "2011-09-26 24:02:25", "2011-09-26 13:60:25", "2011-09-26 13:02:61"}) {
    folder.Write("dates.txt", date);
    EXPECT_THROW(ReadKittiTimes(folder.File("dates.txt")), std::invalid_argument) << date;
  }
}

TEST(KittiSequence, ColourImagesAreTurnedToGrey) {
  const SequenceFolder folder(1);
  cv::imwrite(folder.Left(0), cv::Mat(12, 16, CV_8UC3, cv::Scalar(0, 0, 200)));
  const auto pair = KittiSequence(folder.Path()).Next();
  EXPECT_EQ(pair->images.left.type(), CV_8UC1);
  EXPECT_NEAR(pair->images.left.at<uint8_t>(0, 0), 60, 1);  // 0.299 * 200
}

TEST(KittiSequence, TakesTheColourCamerasWhereTheGreyOnesAreNotThere) {
  const SequenceFolder folder(2);
  fs::rename(folder.File("image_0"), folder.File("image_2"));
  fs::rename(folder.File("image_1"), folder.File("image_3"));
  folder.Write("calib.txt", folder.Calibration("-350") +
                                "P2: 700 0 8 42 0 700 6 0 0 0 1 0\n"
                                "P3: 700 0 8 -238 0 700 6 0 0 0 1 0\n");
  KittiSequence sequence(folder.Path());
  EXPECT_EQ(sequence.camera().baseline_m, 0.4);
  EXPECT_EQ(sequence.size(), 2);
}

TEST(KittiSequence, TakesTheColourCamerasOfRawData) {
  const SequenceFolder folder(2);
  for (const auto& [from, to] : {std::pair("image_0", "image_02"), {"image_1", "image_03"}}) {
    fs::create_directory(folder.File(to));
    fs::rename(folder.File(from), folder.File(std::string(to) + "/data"));
  }
  fs::remove(folder.File("calib.txt"));
  folder.Write("calib_cam_to_cam.txt",
               "P_rect_00: 1\nP_rect_02: 700 0 8 42 0 700 6 0 0 0 1 0\n"
               "P_rect_03: 700 0 8 -238 0 700 6 0 0 0 1 0\n");
  EXPECT_EQ(KittiSequence(folder.Path()).camera().baseline_m, 0.4);
}

TEST(KittiSequenceErrors, MissingFolders) {
  const SequenceFolder folder(1);
  EXPECT_EQ(ErrorOf(folder.File("nowhere")), folder.File("nowhere") + ": no such folder");
  fs::remove_all(folder.File("image_1"));
  EXPECT_EQ(ErrorOf(folder.Path()), folder.File("image_1") + ": no such folder");
  fs::create_directory(folder.File("image_1"));
  EXPECT_EQ(ErrorOf(folder.Path()), folder.File("image_1") + ": holds no PNG images");
}

TEST(KittiSequenceErrors, UnequalImages) {
  const SequenceFolder folder(3);
  folder.WriteImage(folder.Right(1), 1, {16, 13});
  EXPECT_EQ(ErrorOf(folder.Path()), folder.Right(1) + ": is 16x13, the first image 16x12");
  fs::remove(folder.Right(1));
  EXPECT_EQ(ErrorOf(folder.Path()),
            folder.File("image_0") + " holds 3 images, " + folder.File("image_1") + " 2");
  fs::remove(folder.Left(2));
  EXPECT_EQ(ErrorOf(folder.Path()),
            folder.Left(1) + ": has no partner in " + folder.File("image_1"));
}

TEST(KittiSequenceErrors, TimesAndPoses) {
  const SequenceFolder folder(2);
  const std::string pose = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  const struct {
    std::string file, text, error;
  } rows[] = {{"poses.txt", pose, ": holds 1 lines for 2 pairs"},
              {"poses.txt", pose + "1 0 0 nan 0 1 0 0 0 0 1 0\n", ":2: 'nan' is not finite"},
              {"times.txt", "0\n0.1\n0.2\n", ": holds 3 lines for 2 pairs"},
              {"times.txt", "0.1\n0.1\n", ": time 2 is not later than the one before"},
              {"times.txt", "0\nnan\n", ":2: 'nan' is not finite"}};
  for (const auto& [file, text, error] : rows) {
    folder.Write("poses.txt", pose + pose);
    folder.Write(file, text);
    EXPECT_EQ(ErrorOf(folder.Path()), folder.File(file) + error);
  }
}

TEST(KittiSequenceErrors, Calibration) {
  const SequenceFolder folder(1);
  const std::string path = folder.File("calib.txt");
  const auto error_with = [&](const std::string& text) {
    folder.Write("calib.txt", text);
    const std::string error = ErrorOf(folder.Path());
    EXPECT_EQ(error.substr(0, path.size()), path);
    return error.substr(path.size());
  };
  EXPECT_EQ(error_with("P0: 700 0 8 0 0 700 6 0 0 0 1 0\n"), ": has no P1");
  EXPECT_EQ(error_with("P0: 700\n"), ": P0 holds 1 numbers instead of 12");
  const std::string bad_baseline = ": P0, P1: stereo camera: baseline must be in (0, 10) m, is ";
  EXPECT_EQ(error_with(folder.Calibration("0")), bad_baseline + "0.000000");
  EXPECT_EQ(error_with(folder.Calibration("350")), bad_baseline + "-0.500000");
  EXPECT_EQ(error_with(folder.Calibration("-350e3")), bad_baseline + "500.000000");
  EXPECT_EQ(error_with(folder.Calibration("nan")), ": P1: 'nan' is not finite");
  EXPECT_EQ(error_with(folder.Calibration("-x")), ": P1: '-x' is not a number");
  EXPECT_EQ(error_with(folder.Calibration("-350") + folder.Calibration("-350")),
            ": P0 stands twice");
  EXPECT_EQ(error_with("P0: 0 0 8 0 0 700 6 0 0 0 1 0\nP1: 0 0 8 -350 0 700 6 0 0 0 1 0\n"),
            ": P0, P1: stereo camera: fx must be positive, is 0.000000");
  EXPECT_EQ(error_with("P0: 700 0 8 0 0 700 6 0 0 0 1 0\nP1: 701 0 8 -350 0 700 6 0 0 0 1 0\n"),
            ": P0 and P1 differ in focal length or centre: not a rectified pair");
  fs::remove(path);
  EXPECT_EQ(ErrorOf(folder.Path()), path + ": cannot be read");
}

}  // namespace
}  // namespace arfm_vo
