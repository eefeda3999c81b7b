#include "arfm_vo/hardware/stereo_camera_device.h"

#include <gmock/gmock.h>

#include "base/refusal.h"
#include "hardware/simulated_cameras.h"

namespace arfm_vo {
namespace {

StereoCameraOptions Options() {
  StereoCameraOptions options;
  options.left_device = "left";
  options.right_device = "right";
  options.video.width = 8;
  options.video.height = 4;
  return options;
}

class StereoCameraTest : public testing::Test {
 protected:
  /// Steps through `duration_s`; counts pairs and checks that none is wrong.
  int Run(double duration_s) {
    int num_pairs = 0;
    for (const double end_s = world_.now_s + duration_s; world_.now_s < end_s;) {
      const auto pair = camera_.Step(0.25);
      if (!pair) continue;
      ++num_pairs;
      EXPECT_EQ(ReadNumber(pair->left), ReadNumber(pair->right));
      EXPECT_GT(pair->left.stamp_s, last_stamp_s_);
      last_stamp_s_ = pair->left.stamp_s;
    }
    return num_pairs;
  }

  SimulatedCameras world_;
  StereoCameraDevice camera_{Options(), world_.Environment()};
  double last_stamp_s_ = 0;
};

TEST_F(StereoCameraTest, PairsAllFramesOfHealthyCameras) {
  world_.faults[1].phase_s = 0.001;
  const int num_pairs = Run(10);
  EXPECT_NEAR(num_pairs, 100, 1);
  const StereoCameraStatus& status = camera_.status();
  EXPECT_TRUE(status.is_open);
  EXPECT_EQ(status.problem, "");
  EXPECT_NEAR(status.rate_hz, 10, 0.1);
  EXPECT_NEAR(status.skew_s, 0.001, 1e-9);
  EXPECT_EQ(status.num_unpaired_left + status.num_unpaired_right, 0);
}

TEST_F(StereoCameraTest, CountsTheLonelyFramesOfDroppedPartners) {
  world_.faults[1].drop_share = 0.3;
  const int num_pairs = Run(100);
  const StereoCameraStatus& status = camera_.status();
  EXPECT_NEAR(num_pairs, 700, 60);
  EXPECT_NEAR(status.num_unpaired_left, status.num_dropped, 2);
  EXPECT_EQ(status.num_unpaired_right, 0);
}

TEST_F(StereoCameraTest, CamerasOutOfStepGiveNoPairAndSayByHowMuch) {
  world_.faults[1].phase_s = 0.012;
  EXPECT_EQ(Run(5), 0);
  EXPECT_NEAR(camera_.status().rejected_skew_s, 0.012, 1e-9);
  EXPECT_EQ(camera_.status().problem, "no pairs yet");
  EXPECT_GT(camera_.status().num_unpaired_left, 40);
  EXPECT_TRUE(camera_.status().is_open);
}

TEST_F(StereoCameraTest, FramesStampedAtArrivalAreNotPaired) {
  world_.faults[1].late_stamp_share = 1;
  EXPECT_EQ(Run(5), 0);
}

TEST_F(StereoCameraTest, RecoversFromAnUnpluggedCamera) {
  Run(2);
  world_.faults[1].is_unplugged = true;
  EXPECT_EQ(Run(30), 0);
  EXPECT_FALSE(camera_.status().is_open);
  EXPECT_THAT(camera_.status().problem, testing::HasSubstr("device"));
  world_.faults[1].is_unplugged = false;
  EXPECT_GT(Run(6), 0);  // the longest wait is 5 s
  EXPECT_EQ(camera_.status().problem, "");
  EXPECT_EQ(camera_.status().num_opened, 2);
}

TEST_F(StereoCameraTest, RecoversFromASilentCameraByOpeningItAnew) {
  Run(2);
  world_.faults[0].is_silent = true;
  Run(1.5);
  EXPECT_THAT(camera_.status().problem, testing::HasSubstr("left camera gives no frames"));
  world_.faults[0].is_silent = false;
  EXPECT_GT(Run(5), 20);
  EXPECT_EQ(camera_.status().problem, "");
}

TEST_F(StereoCameraTest, WaitsLongerAfterEachFailureAndDoesNotSpin) {
  world_.faults[0].fails_to_read = true;
  Run(60);
  EXPECT_GT(camera_.status().num_failures, 10);
  EXPECT_LT(camera_.status().num_failures, 20);  // 0.2 s, 0.4 s, ... 5 s
  EXPECT_LT(world_.num_waits, 1000);
}

TEST_F(StereoCameraTest, CorruptedFramesAreNeverHandedOut) {
  world_.faults[0].corrupt_share = world_.faults[1].corrupt_share = 0.2;
  EXPECT_NEAR(Run(100), 640, 60);
  EXPECT_GT(camera_.status().num_corrupted, 300);
}

TEST_F(StereoCameraTest, NoWrongPairUnderRandomFaults) {
  RandomEngine engine(9);
  int num_pairs = 0;
  for (int spell = 0; spell < 400; ++spell) {
    for (CameraFaults& faults : world_.faults) {
      faults.drop_share = RandomBelow(3, engine) == 0 ? RandomUnit(engine) : 0;
      faults.corrupt_share = RandomBelow(3, engine) == 0 ? RandomUnit(engine) : 0;
      faults.late_stamp_share = RandomBelow(4, engine) == 0 ? 0.3 : 0;
      faults.jitter_s = RandomUnit(engine) * 0.03;
      faults.is_unplugged = RandomBelow(10, engine) == 0;
      faults.is_silent = RandomBelow(10, engine) == 0;
      faults.fails_to_read = RandomBelow(10, engine) == 0;
    }
    if (RandomBelow(3, engine) == 0) world_.now_s += RandomUnit(engine) * 0.7;  // held up
    num_pairs += Run(RandomUnit(engine) * 10);
  }
  EXPECT_GT(num_pairs, 1000);
  EXPECT_GT(camera_.status().num_opened, 50);
}

TEST_F(StereoCameraTest, TheLeftCamerasAutomaticExposureGoesToTheRight) {
  world_.exposure[0] = Exposure{0.004, 12};
  Run(2);
  ASSERT_TRUE(world_.exposure[1]);
  EXPECT_EQ(world_.exposure[1]->time_s, 0.004);
  EXPECT_EQ(world_.exposure[1]->gain, 12);
  EXPECT_EQ(camera_.status().exposure->time_s, 0.004);
}

TEST(SideBySideCamera, CutsItsPictureInTwo) {
  StereoCameraOptions options = Options();
  options.right_device.clear();
  SimulatedCameras world;
  StereoCameraDevice camera(options, world.Environment());
  std::optional<FramePair> pair;
  for (int i = 0; i < 10 && !pair; ++i) pair = camera.Step(0.25);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->left.grey.size(), cv::Size(8, 4));
  EXPECT_EQ(pair->right.grey.size(), cv::Size(8, 4));
  EXPECT_EQ(pair->SkewS(), 0);
}

TEST(StereoCameraOptions, BadValuesAreNamed) {
  StereoCameraOptions options = Options();
  EXPECT_NO_THROW(options.Check());
  options.max_skew_s = 0.026;  // over a quarter of the time between frames
  EXPECT_INVALID(options.Check(), "max_skew_s");
  options = Options();
  options.right_device = "left";
  EXPECT_INVALID(options.Check(), "must differ");
  options = Options();
  options.video.exposure_s = 0.2;
  EXPECT_INVALID(options.Check(), "exposure_s");
}

}  // namespace
}  // namespace arfm_vo
