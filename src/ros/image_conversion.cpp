#include "arfm_vo/ros/image_conversion.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

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
      return window.Apply(cv_bridge::toCvShare(message, encodings::MONO16)->image);
    return cv_bridge::toCvShare(message, encodings::MONO8)->image;
  } catch (const std::exception& error) {  // cv_bridge::Exception or cv::Exception
    throw std::invalid_argument(topic + ": the image is malformed: " + error.what());
  }
}

}  // namespace arfm_vo
