#include "arfm_vo/calibration/calibration_report.h"

#include <gmock/gmock.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <opencv2/imgcodecs.hpp>

#include "arfm_vo/calibration/pair_detection.h"
#include "base/folder_test.h"
#include "base/refusal.h"
#include "base/shared_data.h"
#include "calibration/rendered_board.h"

namespace arfm_vo {
namespace {

using testing::HasSubstr;

namespace fs = std::filesystem;

class CalibrationFolder : public FolderTest {
 protected:
  /// Renders `count` pairs of the board into the folder.
  void Render(const BoardRig& rig, const Chessboard& board, int count, int seed) {
    int i = 10;
    for (const Rigid3& pose : DrawBoardPoses(rig, board, count, 40, seed)) {
      const std::string name = std::to_string(i++) + ".png";
      cv::imwrite((folder_ / ("left" + name)).string(),
                  RenderBoard(rig, rig.left, board, pose, 2 * i));
      cv::imwrite((folder_ / ("right" + name)).string(),
                  RenderBoard(rig, rig.right, board, rig.right_from_left * pose, 2 * i + 1));
    }
  }
  StereoCalibration Calibrate(const Chessboard& board) const {
    const DetectedPairs detected = DetectPairs(FindImagePairs(folder_), board, 5);
    StereoCalibration calibration = CalibrateStereo(detected.pairs, board, detected.image_size);
    calibration.left_out.insert(calibration.left_out.end(), detected.left_out.begin(),
                                detected.left_out.end());
    return calibration;
  }
  template <class Error>
  std::string MessageOf(const Chessboard& board) const {
    return RefusalOf<Error>([&] { Calibrate(board); });
  }
};

TEST_F(CalibrationFolder, RenderedPairsGiveFilesThatHoldTheRig) {
  const Chessboard board{9, 6, 0.1};
  Render(BoardRig::Make(650), board, 8, 21);
  cv::imwrite((folder_ / "left90.png").string(), cv::Mat(494, 650, CV_8U, cv::Scalar(90)));
  cv::imwrite((folder_ / "right90.png").string(), cv::Mat(494, 650, CV_8U, cv::Scalar(90)));
  const StereoCalibration calibration = Calibrate(board);
  ASSERT_EQ(calibration.left_out.size(), 1U);
  EXPECT_EQ(calibration.left_out[0].name, "90");
  EXPECT_EQ(calibration.left_out[0].reason, "board not found in either image");
  const Rectification rectification = Rectify(calibration);
  const fs::path output = folder_ / "made" / "here";
  WriteCalibration(output, FindImagePairs(folder_), calibration, rectification, board);
  const YAML::Node right = YAML::LoadFile((output / "right.yaml").string());
  EXPECT_EQ(right["camera_name"].as<std::string>(), "right");
  EXPECT_EQ(right["image_width"].as<int>(), 650);
  EXPECT_EQ(right["distortion_model"].as<std::string>(), "plumb_bob");
  EXPECT_EQ(right["distortion_coefficients"]["data"].size(), 5U);
  const auto p = right["projection_matrix"]["data"].as<std::vector<double>>();
  ASSERT_EQ(p.size(), 12U);
  EXPECT_NEAR(-p[3] / p[0], 0.24, 0.001);
  const auto k = right["camera_matrix"]["data"].as<std::vector<double>>();
  EXPECT_NEAR(k[0], 1412.5 * 0.4, 2);
  EXPECT_EQ(
      YAML::LoadFile((output / "left.yaml").string())["projection_matrix"]["data"][3].as<double>(),
      0);
  for (const char* file : {"report.md", "rectified.jpg", "coverage.png", "corners_10.jpg"})
    EXPECT_TRUE(fs::exists(output / file)) << file;
  for (const auto& entry : fs::directory_iterator(output))
    EXPECT_THAT(entry.path().string(), testing::Not(HasSubstr("partial")));
}

TEST_F(CalibrationFolder, APartOfTheBoardIsRefusedAsWrongBoardSize) {
  Render(BoardRig::Make(488), {9, 6, 0.1}, 5, 22);
  for (const Chessboard& asked : {Chessboard{8, 5, 0.1}, Chessboard{12, 7, 0.1}}) {
    const std::string message = MessageOf<CalibrationError>(asked);
    EXPECT_THAT(message, HasSubstr("wrong board size"));
    EXPECT_THAT(message, HasSubstr("9x6"));
  }
}

TEST_F(CalibrationFolder, AnImageOfAnotherSizeOrNoneIsNamed) {
  Render(BoardRig::Make(650), {9, 6, 0.1}, 5, 23);
  cv::imwrite((folder_ / "left14.png").string(), cv::Mat(100, 100, CV_8U, cv::Scalar(90)));
  EXPECT_THAT(MessageOf<std::invalid_argument>({9, 6, 0.1}), HasSubstr("left14.png"));
  fs::resize_file(folder_ / "left14.png", 20);
  EXPECT_THAT(MessageOf<std::invalid_argument>({9, 6, 0.1}), HasSubstr("cannot read image"));
}

double ReadFigure(const std::string& figures, const std::string& key) {
  const size_t place = figures.find(key + ": ");
  return place == std::string::npos ? NAN : std::stod(figures.substr(place + key.size() + 2));
}

TEST(Calibration, AgreesWithTheReferenceOfOpenCvsPairs) {
  const fs::path folder = FindShared("data/calibration/opencv_9x6");
  if (folder.empty()) GTEST_SKIP() << "no real calibration pairs in the shared data";
  const Chessboard board{9, 6, 1};
  const DetectedPairs detected = DetectPairs(FindImagePairs(folder), board, 5);
  const StereoCalibration calibration = CalibrateStereo(detected.pairs, board, detected.image_size);
  const std::string figures = FormatFigures(calibration, Rectify(calibration));
  EXPECT_EQ(ReadFigure(figures, "pairs_used"), 13);
  EXPECT_NEAR(ReadFigure(figures, "fx_left"), 535.739, 0.005 * 535.739);
  EXPECT_NEAR(ReadFigure(figures, "fx_right"), 539.588, 0.005 * 539.588);
  EXPECT_NEAR(ReadFigure(figures, "baseline_m"), 3.33810, 0.005 * 3.33810);
  EXPECT_LE(ReadFigure(figures, "stereo_rms_px"), 0.46);
  EXPECT_LE(ReadFigure(figures, "row_residual_median_px"), 0.25);
}

/// The paper's calibration, its board at 1624x1234 rendered with blur and noise: all its 63 pairs
/// where ARFM_VO_LONG is set, else 12 to save time.
TEST(Calibration, RecoversTheTruthFromThePapersBoard) {
  const Chessboard board;
  const BoardRig rig = BoardRig::Make();
  const int count = std::getenv("ARFM_VO_LONG") ? 63 : 12;
  std::vector<CornerPair> pairs;
  uint32_t image_id = 0;
  for (const Rigid3& pose : DrawBoardPoses(rig, board, count, 40, 63)) {
    const auto see = [&](const SingleCamera& camera, const Rigid3& camera_from_board) {
      return DetectCorners(RenderBoard(rig, camera, board, camera_from_board, image_id++),
                           board.Size());
    };
    const auto l = see(rig.left, pose), r = see(rig.right, rig.right_from_left * pose);
    if (l && r)
      pairs.push_back({std::to_string(pairs.size()), *l, AlignOrder(*l, *r, board.Size())});
  }
  const StereoCalibration calibration = CalibrateStereo(pairs, board, rig.image_size);
  EXPECT_EQ(static_cast<int>(calibration.pairs.size()), count);
  for (const auto& [side, truth] :
       {std::pair(calibration.left, rig.left), {calibration.right, rig.right}}) {
    EXPECT_NEAR(side.matrix(0, 0), truth.matrix(0, 0), 0.001 * truth.matrix(0, 0));
    EXPECT_NEAR(side.matrix(0, 2), truth.matrix(0, 2), 1);
    EXPECT_NEAR(side.matrix(1, 2), truth.matrix(1, 2), 1);
  }
  EXPECT_NEAR(calibration.BaselineM(), rig.BaselineM(), 0.001 * rig.BaselineM());
}

}  // namespace
}  // namespace arfm_vo
