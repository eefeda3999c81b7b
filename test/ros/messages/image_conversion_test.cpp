#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>
#include <opencv2/core.hpp>

#include "arfm_vo/ros/messages/stereo_messages.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

/// An 8x6 image whose bytes are all `value`.
sensor_msgs::ImagePtr MakeImage(const std::string& encoding, int bytes_a_pixel, uint8_t value) {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->encoding = encoding;
  image->width = 8;
  image->height = 6;
  image->step = 8 * bytes_a_pixel;
  image->data.assign(6 * image->step, value);
  return image;
}

class ImageConversion : public testing::Test {
 protected:
  GreyWindow window;
};

TEST_F(ImageConversion, Mono8IsSharedNotCopied) {
  const auto image = MakeImage("mono8", 1, 77);
  const cv::Mat grey = ToGrey(image, "left", window);
  EXPECT_EQ(grey.data, image->data.data());
  EXPECT_EQ(grey.size(), cv::Size(8, 6));
  EXPECT_EQ(grey.type(), CV_8UC1);
}

TEST_F(ImageConversion, ColourAndDeepImagesBecomeGrey) {
  for (const auto& [encoding, bytes] :
       {std::pair("bgr8", 3), {"rgb8", 3}, {"bgra8", 4}, {"mono16", 2}, {"bayer_rggb8", 1}}) {
    const cv::Mat grey = ToGrey(MakeImage(encoding, bytes, 77), "left", window);
    ASSERT_EQ(grey.type(), CV_8UC1) << encoding;
    EXPECT_NEAR(grey.at<uint8_t>(3, 4), 77, 1) << encoding;
  }
}

TEST_F(ImageConversion, TwelveBitsInSixteenAreNotDark) {
  const cv::Mat grey =
      ToGrey(MakeImage("mono16", 2, 8), "left", window);  // 0x0808, 128.5 / 256 of 12 bits
  EXPECT_EQ(grey.at<uint8_t>(3, 4), 128);
}

TEST_F(ImageConversion, BigEndianSamplesAreTheSamePicture) {
  const auto little = MakeImage("mono16", 2, 0), big = MakeImage("mono16", 2, 0);
  for (size_t i = 0; i < little->data.size(); i += 2) {
    little->data[i] = big->data[i + 1] = static_cast<uint8_t>(40 * i);
    little->data[i + 1] = big->data[i] = static_cast<uint8_t>(i);
  }
  big->is_bigendian = 1;
  const cv::Mat grey = ToGrey(big, "left", window);
  EXPECT_EQ(grey.type(), CV_8UC1);
  EXPECT_EQ(cv::norm(grey, ToGrey(little, "left", window), cv::NORM_INF), 0);
  big->step = 15;
  EXPECT_INVALID(ToGrey(big, "left", window), "left: the image is malformed");
}

TEST_F(ImageConversion, RefusesWhatIsNoPictureByTopic) {
  EXPECT_INVALID(ToGrey(MakeImage("32FC1", 4, 0), "/stereo/left/image_rect", window),
                 "/stereo/left/image_rect: cannot make a grey image from encoding \"32FC1\"");
}

TEST_F(ImageConversion, RefusesAnImageThatIsEmptyOrTooShort) {
  EXPECT_INVALID(ToGrey(boost::make_shared<sensor_msgs::Image>(), "left", window),
                 "left: the image is");
  const auto image = MakeImage("mono8", 1, 77);
  image->data.pop_back();
  EXPECT_INVALID(ToGrey(image, "left", window), "left: the image is malformed");
  const auto narrow = MakeImage("mono8", 1, 77);
  narrow->step = 2;
  EXPECT_INVALID(ToGrey(narrow, "left", window), "left: the image is malformed");
}

}  // namespace
}  // namespace arfm_vo
