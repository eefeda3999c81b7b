#include "arfm_vo/calibration/stereo_calibration.h"

#include <gmock/gmock.h>

#include <functional>
#include <utility>

#include "arfm_vo/calibration/rectification.h"
#include "base/random_normal.h"
#include "base/refusal.h"
#include "calibration/rendered_board.h"

namespace arfm_vo {
namespace {

using testing::HasSubstr;

const Chessboard kBoard{9, 6, 0.1};
constexpr int kWidth = 812;  ///< px, of a picture

/// Corners as the true rig would see them, with Gaussian noise.
class SyntheticPairs {
 public:
  explicit SyntheticPairs(uint32_t seed, BoardRig rig = BoardRig::Make(kWidth))
      : rig(rig), engine_(seed) {}

  std::vector<Rigid3> Poses(int count, double max_tilt_deg = 40) {
    return DrawBoardPoses(rig, kBoard, count, max_tilt_deg, engine_());
  }
  std::vector<CornerPair> See(const std::vector<Rigid3>& poses, double noise_px) {
    std::vector<CornerPair> pairs;
    for (const Rigid3& pose : poses)
      pairs.push_back(
          {std::to_string(pairs.size()), Disturb(ProjectBoard(rig.left, kBoard, pose), noise_px),
           Disturb(ProjectBoard(rig.right, kBoard, rig.right_from_left * pose), noise_px)});
    return pairs;
  }
  BoardCorners Disturb(BoardCorners corners, double noise_px) {
    for (cv::Point2f& corner : corners)
      corner += cv::Point2f(float(noise_px * RandomNormal(engine_)),
                            float(noise_px * RandomNormal(engine_)));
    return corners;
  }

  BoardRig rig;

 private:
  RandomEngine engine_;
};

StereoCalibration Calibrate(const std::vector<CornerPair>& pairs, const BoardRig& rig) {
  return CalibrateStereo(pairs, kBoard, rig.image_size);
}

std::string MessageOf(const std::vector<CornerPair>& pairs, const BoardRig& rig) {
  return RefusalOf<CalibrationError>([&] { Calibrate(pairs, rig); });
}

TEST(StereoCalibration, ExactCornersGiveTheTrueRig) {
  SyntheticPairs synthetic(1);
  const auto calibration = Calibrate(synthetic.See(synthetic.Poses(10), 0), synthetic.rig);
  const BoardRig& truth = synthetic.rig;
  EXPECT_LT(calibration.stereo_rms_px, 1e-3);
  EXPECT_NEAR(calibration.left.matrix(0, 0), truth.left.matrix(0, 0), 0.05);
  EXPECT_NEAR(calibration.right.matrix(1, 1), truth.right.matrix(1, 1), 0.05);
  EXPECT_NEAR(calibration.left.matrix(0, 2), truth.left.matrix(0, 2), 0.05);
  EXPECT_NEAR(calibration.left.distortion.at<double>(0), truth.left.distortion.at<double>(0), 2e-3);
  EXPECT_LT((calibration.right_from_left.translation - truth.right_from_left.translation).norm(),
            2e-5);
  EXPECT_LT((calibration.right_from_left.rotation.conjugate() * truth.right_from_left.rotation)
                .vec()
                .norm(),
            2e-5);
  EXPECT_NEAR(calibration.left_precision.skew_px, 0, 0.02);
  EXPECT_EQ(calibration.pairs.size(), 10U);
}

TEST(StereoCalibration, NoiseStaysWithinTheStatedPrecision) {
  SyntheticPairs synthetic(2);
  const auto calibration = Calibrate(synthetic.See(synthetic.Poses(20), 0.1), synthetic.rig);
  const auto& [skew, skew_sigma, fx_sigma, fy_sigma, cx_sigma, cy_sigma] =
      calibration.left_precision;
  EXPECT_NEAR(calibration.stereo_rms_px, 0.1 * std::sqrt(2), 0.01);  // of both coordinates
  EXPECT_NEAR(calibration.left.matrix(0, 0), synthetic.rig.left.matrix(0, 0), 4 * fx_sigma);
  EXPECT_NEAR(calibration.left.matrix(1, 1), synthetic.rig.left.matrix(1, 1), 4 * fy_sigma);
  EXPECT_NEAR(calibration.left.matrix(0, 2), synthetic.rig.left.matrix(0, 2), 4 * cx_sigma);
  EXPECT_NEAR(calibration.left.matrix(1, 2), synthetic.rig.left.matrix(1, 2), 4 * cy_sigma);
  EXPECT_NEAR(skew, 0, 4 * skew_sigma);
  EXPECT_LT(fx_sigma, 1);
  EXPECT_LT(skew_sigma, 0.5);
}

TEST(StereoCalibration, SkewIsReported) {
  constexpr double kSkewPx = 2.5;
  SyntheticPairs synthetic(3);
  auto pairs = synthetic.See(synthetic.Poses(20), 0.05);
  const SingleCamera& camera = synthetic.rig.left;
  for (CornerPair& pair : pairs)
    for (cv::Point2f& corner : pair.left)
      corner.x += float(kSkewPx * (corner.y - camera.matrix(1, 2)) / camera.matrix(1, 1));
  const auto calibration = Calibrate(pairs, synthetic.rig);
  EXPECT_NEAR(calibration.left_precision.skew_px, kSkewPx, 0.15);
  EXPECT_NEAR(calibration.right_precision.skew_px, 0, 0.15);
}

TEST(StereoCalibration, CamerasOfDifferentFocalLength) {
  BoardRig rig = BoardRig::Make(kWidth);
  rig.right.matrix(0, 0) = rig.right.matrix(1, 1) = 600;
  SyntheticPairs synthetic(4, rig);
  const auto calibration = Calibrate(synthetic.See(synthetic.Poses(15), 0.1), rig);
  EXPECT_NEAR(calibration.left.matrix(0, 0), rig.left.matrix(0, 0), 3);
  EXPECT_NEAR(calibration.right.matrix(0, 0), 600, 3);
  EXPECT_NEAR(calibration.BaselineM(), 0.24, 0.001);
}

TEST(StereoCalibration, ABoardThatMovedBetweenTheExposuresIsLeftOut) {
  SyntheticPairs synthetic(5);
  const auto poses = synthetic.Poses(14);
  auto pairs = synthetic.See(poses, 0.1);
  Rigid3 moved = poses[3];
  moved.translation += Eigen::Vector3d(0.004, 0.003, 0);
  pairs[3].right = synthetic.See({moved}, 0.1)[0].right;
  pairs[8].right = pairs[9].right;  // of another moment altogether
  const auto calibration = Calibrate(pairs, synthetic.rig);
  ASSERT_EQ(calibration.left_out.size(), 2U);
  EXPECT_EQ(calibration.left_out[0].name, "8");
  EXPECT_THAT(calibration.left_out[0].reason, HasSubstr("cameras disagree"));
  EXPECT_EQ(calibration.left_out[1].name, "3");
  EXPECT_EQ(calibration.pairs.size(), 12U);
  EXPECT_NEAR(calibration.BaselineM(), 0.24, 0.0005);
}

TEST(StereoCalibration, CornersThatDoNotFitTheirCameraAreLeftOut) {
  SyntheticPairs synthetic(6);
  auto pairs = synthetic.See(synthetic.Poses(12), 0.1);
  pairs[5].left = synthetic.Disturb(pairs[5].left, 1);
  const auto calibration = Calibrate(pairs, synthetic.rig);
  ASSERT_EQ(calibration.left_out.size(), 1U);
  EXPECT_EQ(calibration.left_out[0].name, "5");
  EXPECT_THAT(calibration.left_out[0].reason, HasSubstr("left camera"));
}

TEST(StereoCalibration, TooFewViewsAreRefusedWithTheReasons) {
  SyntheticPairs synthetic(7);
  auto pairs = synthetic.See(synthetic.Poses(5), 0.1);
  pairs[2].left = synthetic.Disturb(pairs[2].left, 2);
  const std::string message = MessageOf(pairs, synthetic.rig);
  EXPECT_THAT(message, HasSubstr("too few views: 4 good pairs of 5"));
  EXPECT_THAT(message, HasSubstr("left out 2:"));
  pairs.resize(2);
  EXPECT_THAT(MessageOf(pairs, synthetic.rig), HasSubstr("too few views"));
  EXPECT_THAT(MessageOf({}, synthetic.rig), HasSubstr("too few views"));
}

TEST(StereoCalibration, PairsThatAreNotOfTwoCamerasAtOneMomentAreRefused) {
  const std::pair<const char*, std::function<void(std::vector<CornerPair>&)>> rows[] = {
      {"swapped",
       [](auto& pairs) {
         for (CornerPair& pair : pairs) std::swap(pair.left, pair.right);
       }},
      {"one camera is mirrored",
       [](auto& pairs) {
         for (CornerPair& pair : pairs)
           pair.right = AlignOrder(pair.left, MirrorCorners(pair.right, kBoard.Size(), kWidth),
                                   kBoard.Size());
       }},
      {"cameras do not agree", [](auto& pairs) {
         for (size_t i = 0; i + 1 < pairs.size(); ++i)
           std::swap(pairs[i].right, pairs[i + 1].right);
       }}};
  for (const auto& [complaint, spoil] : rows) {
    SyntheticPairs synthetic(9);
    auto pairs = synthetic.See(synthetic.Poses(9), 0.1);
    spoil(pairs);
    EXPECT_THAT(MessageOf(pairs, synthetic.rig), HasSubstr(complaint));
  }
}

TEST(StereoCalibration, ParallelViewsAreRefused) {
  SyntheticPairs synthetic(11);
  EXPECT_THAT(MessageOf(synthetic.See(synthetic.Poses(12, 0), 0.1), synthetic.rig),
              HasSubstr("parallel"));
  EXPECT_THAT(MessageOf(synthetic.See(synthetic.Poses(12, 0), 0), synthetic.rig),
              HasSubstr("parallel"));
  // Parallel to each other, slanted to the image.
  std::vector<Rigid3> slanted = synthetic.Poses(12, 0);
  for (Rigid3& pose : slanted) pose.rotation = ExpSO3({0.4, 0.3, 0}) * pose.rotation;
  EXPECT_THAT(MessageOf(synthetic.See(slanted, 0.1), synthetic.rig), HasSubstr("parallel"));
}

TEST(StereoCalibration, CamerasAboveEachOtherAreRefused) {
  BoardRig rig = BoardRig::Make(kWidth);
  rig.right_from_left.translation = {0.01, -0.2, 0};
  SyntheticPairs synthetic(12, rig);
  EXPECT_THAT(MessageOf(synthetic.See(synthetic.Poses(8), 0.1), rig),
              HasSubstr("not side by side"));
}

TEST(Rectification, RowsOfExactCornersAgreeAndP3IsMinusFxTimesBaseline) {
  SyntheticPairs synthetic(13);
  const auto calibration = Calibrate(synthetic.See(synthetic.Poses(10), 0), synthetic.rig);
  const Rectification rectification = Rectify(calibration);
  EXPECT_LT(MeasureRowResiduals(calibration, rectification).back(), 2e-3);
  const cv::Matx34d& p = rectification.right.projection;
  EXPECT_NEAR(p(0, 3), -p(0, 0) * synthetic.rig.BaselineM(), 0.02);
  const StereoCamera camera = rectification.Camera(calibration.image_size);
  EXPECT_NO_THROW(camera.Check());
  EXPECT_NEAR(camera.baseline_m, 0.24, 1e-4);
}

}  // namespace
}  // namespace arfm_vo
