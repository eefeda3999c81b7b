#pragma once

#include <fcntl.h>
#include <linux/videodev2.h>
#include <unistd.h>

#include <cerrno>
#include <opencv2/core/mat.hpp>
#include <string>
#include <system_error>

#include "arfm_vo/hardware/file_descriptor.h"
#include "arfm_vo/hardware/v4l2_buffers.h"

namespace arfm_vo {

/// Feeds a v4l2loopback device with grey pictures: what a camera there shows.
class LoopbackWriter {
 public:
  LoopbackWriter(const std::string& path, int width, int height)
      : path_(path), fd_(::open(path.c_str(), O_RDWR | O_CLOEXEC)) {
    if (!fd_.IsOpen()) throw std::system_error(errno, std::generic_category(), path);
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    format.fmt.pix.width = static_cast<uint32_t>(width);
    format.fmt.pix.height = static_cast<uint32_t>(height);
    format.fmt.pix.pixelformat = V4L2_PIX_FMT_GREY;
    format.fmt.pix.bytesperline = format.fmt.pix.width;
    format.fmt.pix.sizeimage = format.fmt.pix.width * format.fmt.pix.height;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    CallV4l2(fd_.Get(), VIDIOC_S_FMT, &format, path, "takes no GREY");
  }

  void Write(const cv::Mat& grey) {
    const size_t size = grey.total();
    if (!grey.isContinuous() || ::write(fd_.Get(), grey.data, size) != static_cast<ssize_t>(size))
      throw std::system_error(errno, std::generic_category(), path_ + ": does not take a picture");
  }

 private:
  std::string path_;
  FileDescriptor fd_;
};

}  // namespace arfm_vo
