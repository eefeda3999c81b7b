#include "arfm_vo/hardware/image_conversion.h"

#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

/// How one plane of a picture becomes grey.
struct PlaneFormat {
  int bytes;             ///< a pixel
  int channel = 0;       ///< of these bytes the one that is grey..
  int colour_code = -1;  ///< ..unless OpenCV converts it by this code..
  int bits = 8;          ///< ..or, where more than 8, the top ones of two bytes, little endian, are
};

// OpenCV names a Bayer pattern by its second row's second and third pixel, V4L2 by its first ones.
const std::map<std::string, PlaneFormat>& PlaneFormats() {
  static const std::map<std::string, PlaneFormat> formats = {
      {"GREY", {1}},
      {"NV12", {1}},  // luminance comes first, whole
      {"NV21", {1}},
      {"YU12", {1}},
      {"YV12", {1}},
      {"YUYV", {2, 0}},
      {"YVYU", {2, 0}},
      {"UYVY", {2, 1}},
      {"VYUY", {2, 1}},
      {"Y10 ", {2, 0, -1, 10}},
      {"Y12 ", {2, 0, -1, 12}},
      {"Y16 ", {2, 0, -1, 16}},
      {"RGGB", {1, 0, cv::COLOR_BayerBG2GRAY}},
      {"BA81", {1, 0, cv::COLOR_BayerRG2GRAY}},  // BGGR
      {"GRBG", {1, 0, cv::COLOR_BayerGB2GRAY}},
      {"GBRG", {1, 0, cv::COLOR_BayerGR2GRAY}},
      {"BGR3", {3, 0, cv::COLOR_BGR2GRAY}},
      {"RGB3", {3, 0, cv::COLOR_RGB2GRAY}},
  };
  return formats;
}

bool IsJpeg(const std::string& name) { return name == "MJPG" || name == "JPEG"; }

/// Whether the picture has its end (bytes FF D9, which stand nowhere else; devices pad what
/// follows). A decoder fills up one that was cut off, and says nothing.
bool IsWholeJpeg(const uint8_t* data, size_t size) {
  for (size_t i = size; i >= 4; --i)
    if (data[i - 2] == 0xff && data[i - 1] == 0xd9) return true;
  return false;
}

std::optional<cv::Mat> DecodeJpeg(const void* data, size_t size, const VideoFormat& format) {
  if (!IsWholeJpeg(static_cast<const uint8_t*>(data), size)) return std::nullopt;
  const cv::Mat bytes(1, static_cast<int>(size), CV_8UC1, const_cast<void*>(data));
  cv::Mat grey;
  try {
    grey = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  if (grey.cols != format.width || grey.rows != format.height) return std::nullopt;
  return grey;
}

}  // namespace

uint32_t ParseFourcc(const std::string& name) {
  Require(!name.empty() && name.size() <= 4,
          "pixel format: needs one to four characters, is '" + name + "'");
  const std::string padded = (name + "    ").substr(0, 4);
  uint32_t fourcc = 0;
  for (int i = 3; i >= 0; --i) fourcc = fourcc << 8 | static_cast<unsigned char>(padded[i]);
  return fourcc;
}

std::string FormatFourcc(uint32_t fourcc) {
  std::string name;
  for (int i = 0; i < 4; ++i) name += static_cast<char>(fourcc >> (8 * i) & 0x7f);
  return name;
}

bool IsKnownPixelFormat(uint32_t fourcc) {
  const std::string name = FormatFourcc(fourcc);
  return IsJpeg(name) || PlaneFormats().count(name) > 0;
}

std::optional<cv::Mat> ToGrey(const void* data, size_t size, const VideoFormat& format) {
  const std::string name = FormatFourcc(format.fourcc);
  if (IsJpeg(name)) return DecodeJpeg(data, size, format);
  const auto found = PlaneFormats().find(name);
  Require(found != PlaneFormats().end(), "pixel format '" + name + "' is not known");
  const PlaneFormat& plane = found->second;
  const bool is_deep = plane.bits > 8;
  const size_t line = static_cast<size_t>(format.width) * plane.bytes;
  const size_t step = std::max<size_t>(format.bytes_per_line, line);
  if (format.width <= 0 || format.height <= 0 || format.bytes_per_line < 0 ||
      (is_deep && step % 2 != 0) || size < step * (format.height - 1) + line)
    return std::nullopt;
  const cv::Mat raw(format.height, format.width, is_deep ? CV_16UC1 : CV_8UC(plane.bytes),
                    const_cast<void*>(data), step);
  cv::Mat grey;
  if (is_deep) {
    const double levels = 1 << (plane.bits - 8);  // of the picture in one of grey
    raw.convertTo(grey, CV_8U, 1 / levels, 0.5 / levels - 0.5);
  } else if (plane.colour_code >= 0) {
    cv::cvtColor(raw, grey, plane.colour_code);
  } else {
    cv::extractChannel(raw, grey, plane.channel);
  }
  return grey;
}

}  // namespace arfm_vo
