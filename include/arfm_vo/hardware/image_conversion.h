#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

namespace arfm_vo {

/// How a video device lays out a frame. `fourcc` is V4L2's code of the pixel format.
struct VideoFormat {
  uint32_t fourcc = 0;
  int width = 0, height = 0;  ///< px
  int bytes_per_line = 0;     ///< of the first plane; 0 where lines have none (MJPG)
};

/// "YUYV" and back; std::invalid_argument unless the name has one to four characters.
uint32_t ParseFourcc(const std::string& name);
std::string FormatFourcc(uint32_t fourcc);

/// True where ToGrey takes it.
bool IsKnownPixelFormat(uint32_t fourcc);

/// The frame as grey levels (CV_8UC1), its own copy: taken as it is from GREY and from the
/// luminance of YUYV, UYVY, NV12 ..., decoded from MJPG, interpolated from Bayer. Nothing where the
/// buffer holds less than the frame or does not decode; std::invalid_argument for an unknown
/// format.
std::optional<cv::Mat> ToGrey(const void* data, size_t size, const VideoFormat& format);

}  // namespace arfm_vo
