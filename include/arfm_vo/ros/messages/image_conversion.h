#pragma once

#include <sensor_msgs/Image.h>

#include <opencv2/core/mat.hpp>
#include <string>

#include "arfm_vo/image/grey_window.h"

namespace arfm_vo {

/// An image message as 8 bit grey: mono8 as it is, without a copy; colour and Bayer images
/// converted; those of 16 bits by `window`, which is the camera's. The result may point into the
/// message and holds only as long as that does. Throws std::invalid_argument naming `topic` for an
/// empty image, an encoding that is no picture (depth, optical flow), or data that does not fill
/// the size.
cv::Mat ToGrey(const sensor_msgs::ImageConstPtr& message, const std::string& topic,
               GreyWindow& window);

}  // namespace arfm_vo
