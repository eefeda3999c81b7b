#include "synthetic/simulated_run.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/pose/carry_covariance.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{707, 707, 601.9, 183.1, 0.5372, 1226, 370};

/// 0.8 m a frame, with a bend to the right that begins after 20 frames, over a slight hill.
std::vector<Rigid3> BentPath(int num_frames) {
  std::vector<Rigid3> path(num_frames);
  for (int i = 1; i < num_frames; ++i) {
    const Rigid3 step(ExpSO3({0.002, i > 20 ? 0.02 : 0, 0}), Eigen::Vector3d(0, 0, 0.8));
    path[i] = path[i - 1] * step;
  }
  return path;
}

OdometryOptions OnlineOnly() {
  OdometryOptions options;
  options.adjust_globally = false;
  return options;
}

TEST(SimulatedRun, WithoutNoiseThePathIsTheTruth) {
  SimulatedRunOptions options;
  options.simulator.noise_px = 0;
  options.simulator.outlier_fraction = 0;
  const SimulatedRun run = RunSimulated(kCamera, BentPath(40), options, OnlineOnly());
  EXPECT_EQ(run.num_untracked, 0);
  EXPECT_LT(run.OnlineError().ate_rmse_m, 1e-5);
}

TEST(SimulatedRun, NoFrameIsLostAndTheDriftIsSmallWithNoiseAndOutliers) {
  const SimulatedRun run = RunSimulated(kCamera, BentPath(60), {}, OnlineOnly());
  EXPECT_EQ(run.num_untracked, 0);
  EXPECT_LT(run.OnlineError().brief.translation_percent, 0.5);
}

TEST(SimulatedRun, ASkewBetweenTheCamerasIsFoundAndMadeUpFor) {
  SimulatedRunOptions options;
  EXPECT_FALSE(RunSimulated(kCamera, BentPath(40), options, OnlineOnly()).skew);
  for (const double skew_s : {0.004, -0.01}) {
    options.simulator.right_delay = skew_s * options.rate_hz;
    const SimulatedRun run = RunSimulated(kCamera, BentPath(40), options, OnlineOnly());
    ASSERT_TRUE(run.skew) << skew_s;
    EXPECT_NEAR(run.skew->s, skew_s, 0.0005);
    EXPECT_LT(run.skew->sigma_s, 0.0005);
    EXPECT_EQ(run.num_lost, 0);
    EXPECT_LT(run.OnlineError().brief.translation_percent, 2) << skew_s;
  }
}

TEST(SimulatedRun, WhereAllIsFarTheHeadingIsKnownAndThePlaceIsSaidNotToBe) {
  StereoCamera near_cameras = kCamera;
  near_cameras.baseline_m = 0.005;  // depths of 4..100 m are then 0.9..0.04 px
  SimulatedRunOptions options;
  options.simulator.noise_px = 0.3;
  const SimulatedRun run = RunSimulated(near_cameras, BentPath(40), options, OnlineOnly());
  EXPECT_EQ(run.num_lost, 0);
  const Rigid3 error = run.online.back().Inverse() * run.truth.back();
  EXPECT_LT(LogSO3(error.rotation).norm(), 0.002);
  const double sigma_m = std::sqrt(run.covariances.back().diagonal().tail<3>().sum());
  EXPECT_LT(error.translation.norm(), 3 * sigma_m);
  EXPECT_GT(sigma_m, 0.2 * run.online.back().translation.norm());
}

/// Of 0.3 m between two pairs, as of a wheel on a stone.
TEST(SimulatedRun, AJerkThatAllPointsTellOfIsBelieved) {
  std::vector<Rigid3> path = BentPath(40);
  for (size_t i = 25; i < path.size(); ++i) path[i].translation.y() += 0.3;
  const SimulatedRun run = RunSimulated(kCamera, path, {}, OnlineOnly());
  EXPECT_EQ(run.num_untracked, 0);
  EXPECT_LT((run.online.back().translation - run.truth.back().translation).norm(), 0.1);
}

/// The covariance that odom carries is honest: the errors of many drives, each counted in its own
/// standard deviations, spread as they should.
TEST(SimulatedRun, NeesOfThePoseInOdomIsWithinItsBounds) {
  constexpr int kRuns = 10, kFrames = 50;
  SimulatedRunOptions options;
  double at_end = 0, at_all = 0;
  for (int i = 0; i < kRuns; ++i) {
    options.simulator.seed = 100 + i;
    const SimulatedRun run = RunSimulated(kCamera, BentPath(kFrames), options, OnlineOnly());
    at_end += ComputeNees(run, kFrames - 1);
    for (int frame = 1; frame < kFrames; ++frame) at_all += ComputeNees(run, frame) / (kFrames - 1);
  }
  for (const double sum : {at_end, at_all}) {
    EXPECT_GT(sum, ChiSquareQuantile(6 * kRuns, 0.025));
    EXPECT_LT(sum, ChiSquareQuantile(6 * kRuns, 0.975));
  }
}

/// A calibration as far off as it may be (in columns and rows by 0.4 to 0.8 px), another one in
/// each drive: the covariance knows of it from the first metre on.
TEST(SimulatedRun, NeesOfTheFirst20MetresIsWithinItsBoundsWithAWrongCalibration) {
  constexpr int kRuns = 16, kFrames = 26;
  const CorrectionBelief calibration = CorrectionBelief::OfCalibration(kCamera);
  const Eigen::LLT<CorrectionBelief::Matrix> root(calibration.covariance);
  SimulatedRunOptions options;
  options.is_calibrated = false;
  std::mt19937 engine(7);
  std::normal_distribution<double> normal;
  double sum = 0;
  for (int run_number = 0; run_number < kRuns; ++run_number) {
    StereoCorrection::Coefficients draw;
    for (int i = 0; i < draw.size(); ++i) draw[i] = normal(engine);
    options.simulator.displacement.coefficients_px = root.matrixL() * draw;
    options.simulator.seed = 300 + run_number;
    const SimulatedRun run = RunSimulated(kCamera, BentPath(kFrames), options, {});
    EXPECT_EQ(run.num_untracked, 0);
    for (int frame = 1; frame < kFrames; ++frame) sum += ComputeNees(run, frame) / (kFrames - 1);
  }
  std::printf("  mean NEES %.2f\n", sum / kRuns);
  EXPECT_GT(sum, ChiSquareQuantile(6 * kRuns, 0.025));
  EXPECT_LT(sum, ChiSquareQuantile(6 * kRuns, 0.975));
}

/// Three of its standard deviations before the drive: turns tell what straight ways do not.
TEST(SimulatedRun, AFocalLengthThatIsWrongIsLearntInTurns) {
  constexpr int kFocalLength = StereoCorrection::kNumField + LensBasis::kFocalLength;
  const double sigma_px =
      std::sqrt(CorrectionBelief::OfCalibration(kCamera).covariance(kFocalLength, kFocalLength));
  SimulatedRunOptions options;
  options.is_calibrated = false;
  options.simulator.noise_px = 0.2;
  options.simulator.displacement.coefficients_px[kFocalLength] = 3 * sigma_px;
  const auto learnt = [&](const std::vector<Rigid3>& path) {
    return RunSimulated(kCamera, path, options, {}).learnt.mean.coefficients_px[kFocalLength];
  };
  EXPECT_LT(learnt(BentPath(20)), sigma_px);  // straight
  EXPECT_GT(learnt(BentPath(100)), 1.5 * sigma_px);
}

/// A drive of 110 frames; then the camera is back where it was at frame 10, far out of the local
/// map.
SimulatedRun DriveAndBeCarriedBack(const OdometryOptions& options, int landmarks_in_view = 300) {
  std::vector<Rigid3> path = BentPath(110);
  for (int i = 10; i < 30; ++i) path.push_back(path[i]);
  SimulatedRunOptions simulation;
  simulation.simulator.landmarks_in_view = landmarks_in_view;
  simulation.simulator.rest_frames = 0;  // the old landmarks are seen at once
  return RunSimulated(kCamera, path, simulation, options);
}

TEST(Recovery, FindsAPlaceAgainThatLeftTheLocalMap) {
  const SimulatedRun run = DriveAndBeCarriedBack({});
  EXPECT_EQ(run.num_untracked, 0);
  EXPECT_EQ(run.epoch, 1u);
  for (size_t i = 110; i < 130; ++i) {
    EXPECT_LT((run.online[i].translation - run.truth[i].translation).norm(), 0.1) << i;
    EXPECT_LT((run.final[i].translation - run.truth[i].translation).norm(), 0.1) << i;
    EXPECT_LT(ComputeNees(run, i), ChiSquareQuantile(6, 0.9999)) << i;
  }
}

TEST(Recovery, WithoutTheArchiveSuchAPlaceStaysUnknown) {
  OdometryOptions options;
  options.odometry.archived_keyframes = 0;
  const SimulatedRun run = DriveAndBeCarriedBack(options);
  EXPECT_EQ(run.num_untracked, 2);  // then a new map is begun, elsewhere
  EXPECT_EQ(run.epoch, 2u);
  EXPECT_GT((run.online.back().translation - run.truth.back().translation).norm(), 10);
}

TEST(Recovery, APlaceFartherThanTheCameraMayHaveGoneMustBeSure) {
  EXPECT_EQ(DriveAndBeCarriedBack({}, 130).epoch, 2u);
}

/// What has never been seen is not mistaken for what has.
TEST(Recovery, DoesNotRecogniseANewPlace) {
  std::vector<Rigid3> path = BentPath(40);
  const Rigid3 away(ExpSO3({0, M_PI, 0}), Eigen::Vector3d(500, 0, 0));
  for (int i = 0; i < 5; ++i) path.push_back(away * path[i]);
  const SimulatedRun run = RunSimulated(kCamera, path, {}, OnlineOnly());
  EXPECT_EQ(run.num_untracked, 2);  // then a new map is begun
  EXPECT_EQ(run.epoch, 2u);
}

/// What each keyframe is said to add to the drift, against what odom states of the whole.
TEST(SimulatedRun, TheStepsOfThePathAddUpToWhatIsStatedOfTheWhole) {
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  Rigid3 before;
  SimulatedRunOptions simulation;
  simulation.on_keyframe = [&](const PlacedKeyframe& placed) {
    const Keyframe& keyframe = placed.keyframe;
    sum = CarryCovariance(keyframe.camera_from_world * before.Inverse(), sum) +
          keyframe.step_covariance;
    before = keyframe.camera_from_world;
  };
  const SimulatedRun run = RunSimulated(kCamera, BentPath(300), simulation, OnlineOnly());
  const double stated = run.covariances.back().diagonal().tail<3>().sum();
  EXPECT_NEAR(sum.diagonal().tail<3>().sum() / stated, 1, 0.5);
}

}  // namespace
}  // namespace arfm_vo
