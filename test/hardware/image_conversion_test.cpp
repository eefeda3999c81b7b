#include "arfm_vo/hardware/image_conversion.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "base/refusal.h"

namespace arfm_vo {
namespace {

std::optional<cv::Mat> Convert(const std::string& name, const std::vector<uint8_t>& bytes,
                               int width, int height, int bytes_per_line = 0) {
  return ToGrey(bytes.data(), bytes.size(), {ParseFourcc(name), width, height, bytes_per_line});
}

std::vector<int> Levels(const cv::Mat& grey) {
  return {grey.begin<uint8_t>(), grey.end<uint8_t>()};
}

TEST(ToGrey, GreyIsTakenAsItIsWithoutLinePadding) {
  const auto grey = Convert("GREY", {1, 2, 99, 3, 4, 99}, 2, 2, 3);
  ASSERT_TRUE(grey);
  EXPECT_EQ(Levels(*grey), (std::vector{1, 2, 3, 4}));
}

TEST(ToGrey, LuminanceOutOfPackedColour) {
  EXPECT_EQ(Levels(*Convert("YUYV", {1, 128, 2, 128}, 2, 1)), (std::vector{1, 2}));
  EXPECT_EQ(Levels(*Convert("YVYU", {1, 128, 2, 128}, 2, 1)), (std::vector{1, 2}));
  EXPECT_EQ(Levels(*Convert("UYVY", {128, 1, 128, 2}, 2, 1)), (std::vector{1, 2}));
  EXPECT_EQ(Levels(*Convert("NV12", {1, 2, 3, 4, 128, 128}, 2, 2)), (std::vector{1, 2, 3, 4}));
}

TEST(ToGrey, TopBitsOfDeepGrey) {
  EXPECT_EQ(Levels(*Convert("Y16", {0xff, 0x12, 0x00, 0xff}, 2, 1)), (std::vector{0x12, 0xff}));
  EXPECT_EQ(Levels(*Convert("Y10", {0xff, 0x03, 0x07, 0x00}, 2, 1)), (std::vector{255, 1}));
}

/// A flat colour in a Bayer pattern comes out as its grey level everywhere.
TEST(ToGrey, BayerPatternsStartWithTheColourOfTheirName) {
  constexpr int kRed = 200, kGreen = 100, kBlue = 40;
  constexpr double kLevel = 0.299 * kRed + 0.587 * kGreen + 0.114 * kBlue;
  const std::pair<const char*, const char*> patterns[] = {
      {"RGGB", "RGGB"}, {"BA81", "BGGR"}, {"GRBG", "GRBG"}, {"GBRG", "GBRG"}};
  for (const auto& [name, colours] : patterns) {
    std::vector<uint8_t> bytes(8 * 8);
    for (int i = 0; i < 64; ++i) {
      const char colour = colours[2 * (i / 8 % 2) + i % 2];
      bytes[i] = colour == 'R' ? kRed : colour == 'G' ? kGreen : kBlue;
    }
    const auto grey = Convert(name, bytes, 8, 8);
    ASSERT_TRUE(grey);
    for (const int level : Levels(*grey)) EXPECT_NEAR(level, kLevel, 2) << name;
  }
}

TEST(ToGrey, MotionJpegIsDecodedAndRubbishIsNot) {
  const cv::Mat picture(16, 24, CV_8UC1, cv::Scalar(77));
  std::vector<uint8_t> bytes;
  cv::imencode(".jpg", picture, bytes);
  const auto grey = Convert("MJPG", bytes, 24, 16);
  ASSERT_TRUE(grey);
  EXPECT_NEAR(grey->at<uint8_t>(8, 12), 77, 2);
  EXPECT_FALSE(Convert("MJPG", bytes, 16, 16));  // another size
  bytes.insert(bytes.end(), 100, 0);             // as devices pad it
  EXPECT_TRUE(Convert("MJPG", bytes, 24, 16));
  EXPECT_FALSE(Convert("MJPG", {1, 2, 3}, 24, 16));
  EXPECT_FALSE(Convert("MJPG", {}, 24, 16));
}

/// A picture of noise as JPEG.
std::vector<uint8_t> NoiseJpeg(int width, int height) {
  cv::Mat noise(height, width, CV_8UC1);
  cv::randu(noise, 0, 256);
  std::vector<uint8_t> bytes;
  cv::imencode(".jpg", noise, bytes);
  return bytes;
}

TEST(ToGrey, MotionJpegThatIsCutOffIsNoFrame) {
  const std::vector<uint8_t> whole = NoiseJpeg(64, 48);
  ASSERT_TRUE(Convert("MJPG", whole, 64, 48));
  for (size_t size = 0; size < whole.size(); size += 7)
    EXPECT_FALSE(Convert("MJPG", {whole.begin(), whole.begin() + size}, 64, 48)) << size;
}

// Many cameras leave out the Huffman tables (segment DHT): those of the standard are meant.
TEST(ToGrey, MotionJpegWithoutHuffmanTablesIsDecodedByTheStandardOnes) {
  const std::vector<uint8_t> whole = NoiseJpeg(64, 48);
  std::vector<uint8_t> bare(whole.begin(), whole.begin() + 2);
  size_t i = 2;
  while (whole[i + 1] != 0xda) {  // up to the start of the scan
    const size_t size = 2 + (whole[i + 2] << 8 | whole[i + 3]);
    if (whole[i + 1] != 0xc4) bare.insert(bare.end(), &whole[i], &whole[i] + size);
    i += size;
  }
  bare.insert(bare.end(), whole.begin() + i, whole.end());
  ASSERT_LT(bare.size(), whole.size());
  const auto expected = Convert("MJPG", whole, 64, 48), grey = Convert("MJPG", bare, 64, 48);
  ASSERT_TRUE(expected && grey);
  EXPECT_EQ(cv::norm(*expected, *grey, cv::NORM_INF), 0);
}

TEST(ToGrey, AShortBufferOrLinesThatCannotBeAreNoFrame) {
  EXPECT_FALSE(Convert("GREY", {1, 2, 3}, 2, 2));
  EXPECT_FALSE(Convert("YUYV", {1, 2, 3, 4}, 2, 2));
  EXPECT_FALSE(Convert("GREY", {1, 2, 3, 4}, 1, 2, -1)) << "longer than an integer";
  EXPECT_FALSE(Convert("Y10 ", std::vector<uint8_t>(10), 2, 2, 5)) << "end within a sample";
}

TEST(ToGrey, AnUnknownFormatIsNamed) {
  EXPECT_INVALID(Convert("H264", {1}, 1, 1), "H264");
  EXPECT_FALSE(IsKnownPixelFormat(ParseFourcc("H264")));
  EXPECT_TRUE(IsKnownPixelFormat(ParseFourcc("MJPG")));
}

}  // namespace
}  // namespace arfm_vo
