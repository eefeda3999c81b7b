#include "arfm_vo/ros/messages/image_conversion.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>
#include <utility>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

/// The image with its samples of 16 bits little-endian: cv_bridge makes two channels of bytes of
/// those that are big-endian.
sensor_msgs::ImageConstPtr ToLittleEndian(const sensor_msgs::ImageConstPtr& message) {
  if (!message->is_bigendian) return message;
  const auto swapped = boost::make_shared<sensor_msgs::Image>(*message);
  swapped->is_bigendian = 0;
  Require(swapped->step % 2 == 0, "a line ends within a sample");
  for (size_t i = 0; i + 1 < swapped->data.size(); i += 2)
    std::swap(swapped->data[i], swapped->data[i + 1]);
  return swapped;
}

}  // namespace

cv::Mat ToGrey(const sensor_msgs::ImageConstPtr& message, const std::string& topic,
               GreyWindow& window) {
  namespace encodings = sensor_msgs::image_encodings;
  Require(message->width > 0 && message->height > 0, topic + ": the image is empty");
  Require(encodings::isMono(message->encoding) || encodings::isColor(message->encoding) ||
              encodings::isBayer(message->encoding),
          topic + ": cannot make a grey image from encoding \"" + message->encoding +
              "\", publish mono8");
  try {
    if (encodings::bitDepth(message->encoding) == 16)
      return window.Apply(cv_bridge::toCvShare(ToLittleEndian(message), encodings::MONO16)->image);
    return cv_bridge::toCvShare(message, encodings::MONO8)->image;
  } catch (const std::exception& error) {  // cv_bridge::Exception or cv::Exception
    throw std::invalid_argument(topic + ": the image is malformed: " + error.what());
  }
}

}  // namespace arfm_vo
