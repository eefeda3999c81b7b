#include <gmock/gmock.h>

#include <cstdio>

#include "arfm_vo/hardware/v4l2_device.h"
#include "hardware/v4l2_capture.h"

namespace arfm_vo {
namespace {

using V4l2CameraTest = V4l2Test;

TEST_F(V4l2CameraTest, AThousandPairsWithoutAWrongOne) {
  NumberedCameras cameras(kLeft, kRight);
  cameras.drop_left_every = 17;
  cameras.drop_right_every = 23;
  Capture capture(LoopbackOptions(), &cameras);
  EXPECT_TRUE(capture.Take(1000, 400)) << capture.camera.status().problem;
  const StereoCameraStatus& status = capture.camera.status();
  std::printf(
      "| pairs | wrong | not the picture of its stamp | stamps back | largest skew, ms | dropped | "
      "alone left | alone right |\n"
      "|---|---|---|---|---|---|---|---|\n");
  std::printf("| %d | %d | %d | %d | %.2f | %d | %d | %d |\n", capture.num_taken, capture.num_wrong,
              capture.num_foreign, capture.num_back, 1e3 * status.max_skew_s, status.num_dropped,
              status.num_unpaired_left, status.num_unpaired_right);
  EXPECT_EQ(capture.num_wrong, 0);
  EXPECT_EQ(capture.num_foreign, 0);
  EXPECT_EQ(capture.num_back, 0);
  EXPECT_LE(status.max_skew_s, 0.01);
  EXPECT_GT(status.num_unpaired_left, 10);
  EXPECT_GT(status.num_unpaired_right, 10);
}

/// Shows a plain picture on the left camera.
void ShowPlain(LoopbackWriter& writer, int grey) {
  writer.Write(
      cv::Mat(NumberedCameras::kHeight, NumberedCameras::kWidth, CV_8UC1, cv::Scalar(grey)));
}

// v4l2loopback has the picture of before ready, and stamps it when buffers are asked for.
TEST_F(V4l2CameraTest, APictureOfBeforeTheStreamIsNotHandedOut) {
  LoopbackWriter writer(kLeft, NumberedCameras::kWidth, NumberedCameras::kHeight);
  ShowPlain(writer, 1);
  V4l2Device device(kLeft, LoopbackOptions().video);
  EXPECT_FALSE(device.Read());
  ShowPlain(writer, 2);
  const auto frame = device.Read();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->grey.at<uint8_t>(0, 0), 2);
  EXPECT_EQ(device.counts().num_dropped, 0);
}

// v4l2loopback writes on into a buffer that was lent out: two of them are all it has here.
TEST_F(V4l2CameraTest, AFrameThatMayBeOverwrittenIsNotHandedOut) {
  LoopbackWriter writer(kLeft, NumberedCameras::kWidth, NumberedCameras::kHeight);
  ShowPlain(writer, 1);
  V4l2Device device(kLeft, LoopbackOptions().video);
  while (device.Read()) continue;
  ShowPlain(writer, 2);
  ShowPlain(writer, 3);
  const auto frame = device.Read();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->grey.at<uint8_t>(0, 0), 3);
  EXPECT_FALSE(device.Read());
  EXPECT_EQ(device.counts().num_dropped, 1);
}

TEST_F(V4l2CameraTest, AFormatThatIsNotThereIsAnsweredWithThoseThatAre) {
  StereoCameraOptions options = VividOptions();
  options.video.pixel_format = "MJPG";
  StereoCameraDevice camera(options, VideoEnvironment::Kernel());
  EXPECT_FALSE(camera.Step(0.1));
  EXPECT_THAT(camera.status().problem,
              testing::AllOf(testing::HasSubstr("MJPG"), testing::HasSubstr("YUYV"),
                             testing::HasSubstr("640x360")));
}

TEST_F(V4l2CameraTest, PairsComeInEveryFormat) {
  for (const char* format : {"GREY", "YUYV", "UYVY", "NV12", "RGGB"}) {
    StereoCameraOptions options = VividOptions();
    options.video.pixel_format = format;
    Capture capture(options);
    EXPECT_TRUE(capture.Take(2, 20)) << format << ": " << capture.camera.status().problem;
  }
}

}  // namespace
}  // namespace arfm_vo
