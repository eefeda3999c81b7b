#pragma once

#include <sensor_msgs/Image.h>

#include <opencv2/core/mat.hpp>
#include <string>

namespace arfm_vo {

/// An image message as 8 bit grey: mono8 as it is, without a copy; mono16, colour and Bayer images
/// converted. The result may point into the message and holds only as long as that does. Throws
/// std::invalid_argument naming `topic` for an empty image, an encoding that is no picture (depth,
/// optical flow), or data that does not fill the size.
cv::Mat ToGrey(const sensor_msgs::ImageConstPtr& message, const std::string& topic);

}  // namespace arfm_vo
