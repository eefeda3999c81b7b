#include "arfm_vo/image/png_image.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "arfm_vo/base/whole_file.h"
#include "base/folder_test.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

class PngImageTest : public FolderTest {
 protected:
  PngImageTest() {
    cv::Mat image(40, 50, CV_8UC1);
    for (int i = 0; i < 2000; ++i) image.data[i] = static_cast<uint8_t>(i * i);
    cv::imwrite(path_, image);
    bytes_ = ReadWholeFile(path_);
  }

  /// What reading a file of these bytes complains of, without the file's name.
  std::string ErrorOf(const std::string& bytes) {
    WriteWholeFile(path_, bytes);
    return RefusalBehind(path_, [&] { ReadGreyPng(path_, window_); });
  }

  const std::string path_ = folder_ / "test.png";
  std::string bytes_;
  GreyWindow window_;
};

TEST_F(PngImageTest, ReadsPixelsAndSize) {
  const cv::Mat image = ReadGreyPng(path_, window_);
  ASSERT_EQ(image.type(), CV_8UC1);
  EXPECT_EQ(image.size(), cv::Size(50, 40));
  EXPECT_EQ(image.at<uint8_t>(0, 15), 225);
}

TEST_F(PngImageTest, TruncationAnywhereIsAnError) {
  for (size_t size = 0; size<bytes_.size(); size += bytes_.size() - size> 30 ? 7 : 1) {
    const std::string error = ErrorOf(bytes_.substr(0, size));
    EXPECT_EQ(error, size == 0  ? ": is empty"
                     : size < 8 ? ": is not a PNG file"
                                : ": PNG file is truncated")
        << size;
  }
}

TEST_F(PngImageTest, AFlippedBitIsAnError) {
  for (size_t at = 0; at < bytes_.size(); at += 11) {
    std::string flipped = bytes_;
    flipped[at] = static_cast<char>(flipped[at] ^ 4);
    EXPECT_NE(ErrorOf(flipped), "") << at;
  }
}

TEST_F(PngImageTest, OtherFilesAreNoPng) {
  EXPECT_EQ(ErrorOf("P5 2 2 255 abcd and some more bytes than a header has"),
            ": is not a PNG file");
  std::filesystem::remove(path_);
  EXPECT_THROW(ReadGreyPng(path_, window_), std::invalid_argument);
}

TEST_F(PngImageTest, SixteenBitsASampleGoThroughTheWindow) {
  for (const int type : {CV_16UC1, CV_16UC3}) {
    cv::imwrite(path_, cv::Mat(4, 4, type, cv::Scalar::all(3200)));
    const cv::Mat image = ReadGreyPng(path_, window_);
    ASSERT_EQ(image.type(), CV_8UC1);
    EXPECT_EQ(image.at<uint8_t>(2, 2), 200);  // 3200 of 4096
  }
}

TEST_F(PngImageTest, EveryKindIsTheGreyThatOpenCvMakesOfIt) {
  cv::Mat colors(40, 50, CV_8UC3);
  cv::randu(colors, cv::Scalar::all(0), cv::Scalar::all(256));
  cv::Mat with_alpha, deep;
  cv::merge(std::vector<cv::Mat>{colors, colors.reshape(1).colRange(0, 50)}, with_alpha);
  colors.convertTo(deep, CV_16U, 16);
  const std::vector<int> black_and_white = {cv::IMWRITE_PNG_BILEVEL, 1};
  for (const auto& [image, options] : std::vector<std::pair<cv::Mat, std::vector<int>>>{
           {colors, {}}, {with_alpha, {}}, {deep, {}}, {colors.reshape(1), black_and_white}}) {
    cv::imwrite(path_, image, options);
    cv::Mat expected = cv::imread(path_, cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH);
    if (image.depth() == CV_16U) expected = GreyWindow().Apply(expected);
    EXPECT_LE(cv::norm(ReadGreyPng(path_, window_), expected, cv::NORM_INF), 1);
  }
}

TEST_F(PngImageTest, APaletteWithTransparencyIsGrey) {
  const cv::Mat image = ReadGreyPng(
      ARFM_VO_SOURCE_DIR "/test/fuzz/corpus/png/palette_with_transparency.png", window_);
  ASSERT_EQ(image.size(), cv::Size(8, 1));
  const int red = 76, green = 150, black = 10;
  const int expected[] = {red, green, black, red, green, black, red, green};
  for (int x = 0; x < 8; ++x) EXPECT_NEAR(image.at<uint8_t>(0, x), expected[x], 1) << x;
}

/// A header alone must not make anybody reserve what its sizes say.
TEST_F(PngImageTest, MorePixelsThanTheDataCanHoldAreAnError) {
  const uint8_t header[] = {0,  0, 0, 13, 'I', 'H', 'D', 'R', 0,    15,   0,    0,   0,
                            15, 0, 0, 16, 0,   0,   0,   0,   0xe5, 0xc4, 0x72, 0x50};
  std::string bytes = bytes_;
  bytes.replace(8, sizeof(header), reinterpret_cast<const char*>(header), sizeof(header));
  EXPECT_EQ(ErrorOf(bytes), ": PNG file is corrupted");
}

}  // namespace
}  // namespace arfm_vo
