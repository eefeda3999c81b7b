#include "arfm_vo/hardware/image_conversion.h"

#include <functional>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

/// Turns one plane of `bytes` bytes a pixel into grey; a sample has `sample_bytes`.
struct Conversion {
  int bytes = 1;
  int sample_bytes = 1;
  std::function<void(const cv::Mat& raw, cv::Mat& grey)> apply;
};

Conversion TakeChannel(int channels, int channel) {
  return {channels, 1,
          [channel](const cv::Mat& raw, cv::Mat& grey) { cv::extractChannel(raw, grey, channel); }};
}

Conversion ConvertColour(int channels, int code) {
  return {channels, 1,
          [code](const cv::Mat& raw, cv::Mat& grey) { cv::cvtColor(raw, grey, code); }};
}

/// The top eight of `bits` bits, little endian in two bytes.
Conversion ScaleDown(int bits) {
  return {2, 2, [bits](const cv::Mat& raw, cv::Mat& grey) {
            const cv::Mat wide(raw.size(), CV_16UC1, raw.data, raw.step);
            wide.convertTo(grey, CV_8U, 1.0 / (1 << (bits - 8)), -0.5 + 0.5 / (1 << (bits - 8)));
          }};
}

// OpenCV names a Bayer pattern by its second row's second and third pixel, V4L2 by its first ones.
const std::map<std::string, Conversion>& Conversions() {
  static const std::map<std::string, Conversion> conversions = {
      {"GREY", TakeChannel(1, 0)},
      {"NV12", TakeChannel(1, 0)},  // luminance comes first, whole
      {"NV21", TakeChannel(1, 0)},
      {"YU12", TakeChannel(1, 0)},
      {"YV12", TakeChannel(1, 0)},
      {"YUYV", TakeChannel(2, 0)},
      {"YVYU", TakeChannel(2, 0)},
      {"UYVY", TakeChannel(2, 1)},
      {"VYUY", TakeChannel(2, 1)},
      {"Y10 ", ScaleDown(10)},
      {"Y12 ", ScaleDown(12)},
      {"Y16 ", ScaleDown(16)},
      {"RGGB", ConvertColour(1, cv::COLOR_BayerBG2GRAY)},
      {"BA81", ConvertColour(1, cv::COLOR_BayerRG2GRAY)},  // BGGR
      {"GRBG", ConvertColour(1, cv::COLOR_BayerGB2GRAY)},
      {"GBRG", ConvertColour(1, cv::COLOR_BayerGR2GRAY)},
      {"BGR3", ConvertColour(3, cv::COLOR_BGR2GRAY)},
      {"RGB3", ConvertColour(3, cv::COLOR_RGB2GRAY)},
  };
  return conversions;
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
  return IsJpeg(name) || Conversions().count(name) > 0;
}

std::optional<cv::Mat> ToGrey(const void* data, size_t size, const VideoFormat& format) {
  const std::string name = FormatFourcc(format.fourcc);
  if (IsJpeg(name)) return DecodeJpeg(data, size, format);
  const auto found = Conversions().find(name);
  Require(found != Conversions().end(), "pixel format '" + name + "' is not known");
  const Conversion& conversion = found->second;
  const size_t line = static_cast<size_t>(format.width) * conversion.bytes;
  const size_t step = std::max<size_t>(format.bytes_per_line, line);
  if (format.width <= 0 || format.height <= 0 || format.bytes_per_line < 0 ||
      step % conversion.sample_bytes != 0 || size < step * (format.height - 1) + line)
    return std::nullopt;
  const cv::Mat raw(format.height, format.width, CV_8UC(conversion.bytes), const_cast<void*>(data),
                    step);
  cv::Mat grey;
  conversion.apply(raw, grey);
  return grey;
}

}  // namespace arfm_vo
