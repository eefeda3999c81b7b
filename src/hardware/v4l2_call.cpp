#include "arfm_vo/hardware/v4l2_call.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <sstream>
#include <vector>

#include "arfm_vo/base/check.h"
#include "arfm_vo/hardware/file_descriptor.h"
#include "arfm_vo/hardware/image_conversion.h"

namespace arfm_vo {
namespace {

void PrintRates(std::ostream& out, int fd, uint32_t fourcc, uint32_t width, uint32_t height) {
  v4l2_frmivalenum rate{};
  rate.pixel_format = fourcc;
  rate.width = width;
  rate.height = height;
  for (; TryV4l2(fd, VIDIOC_ENUM_FRAMEINTERVALS, &rate); ++rate.index) {
    if (rate.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      out << ' ' << static_cast<double>(rate.discrete.denominator) / rate.discrete.numerator;
    } else {
      const auto &longest = rate.stepwise.max, &shortest = rate.stepwise.min;
      out << ' ' << static_cast<double>(longest.denominator) / longest.numerator << ".."
          << static_cast<double>(shortest.denominator) / shortest.numerator;
      break;
    }
  }
}

void PrintSizes(std::ostream& out, int fd, uint32_t fourcc) {
  v4l2_frmsizeenum size{};
  size.pixel_format = fourcc;
  for (; TryV4l2(fd, VIDIOC_ENUM_FRAMESIZES, &size); ++size.index) {
    if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      out << "    " << size.discrete.width << 'x' << size.discrete.height << " at";
      PrintRates(out, fd, fourcc, size.discrete.width, size.discrete.height);
      out << " Hz\n";
    } else {
      const auto& range = size.stepwise;
      out << "    " << range.min_width << 'x' << range.min_height << " to " << range.max_width
          << 'x' << range.max_height << '\n';
      break;
    }
  }
}

}  // namespace

bool TryV4l2(int fd, unsigned long request, void* argument) {
  while (::ioctl(fd, request, argument) < 0)
    if (errno != EINTR) return false;
  return true;
}

void CallV4l2(int fd, unsigned long request, void* argument, const std::string& path,
              const std::string& what) {
  if (!TryV4l2(fd, request, argument)) ThrowSystemError(path + ": " + what);
}

std::string ListV4l2Formats(const std::string& path) {
  const FileDescriptor fd(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  if (!fd.IsOpen()) ThrowSystemError(path);
  std::ostringstream out;
  v4l2_capability capability{};
  CallV4l2(fd.Get(), VIDIOC_QUERYCAP, &capability, path, "is no video device");
  out << path << ": " << reinterpret_cast<const char*>(capability.card) << " ("
      << reinterpret_cast<const char*>(capability.driver) << ")\n";
  v4l2_fmtdesc format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  for (; TryV4l2(fd.Get(), VIDIOC_ENUM_FMT, &format); ++format.index) {
    out << "  " << FormatFourcc(format.pixelformat) << ' '
        << reinterpret_cast<const char*>(format.description)
        << (IsKnownPixelFormat(format.pixelformat) ? "\n" : " (not known here)\n");
    PrintSizes(out, fd.Get(), format.pixelformat);
  }
  if (format.index == 0) out << "  no capture formats\n";
  return out.str();
}

std::string ListV4l2Devices() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator("/dev"))
    if (entry.path().filename().string().rfind("video", 0) == 0) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  if (paths.empty()) return "no video devices (/dev/video*)\n";
  std::string list;
  for (const std::string& path : paths) {
    try {
      list += ListV4l2Formats(path);
    } catch (const std::system_error& error) {
      list += std::string(error.what()) + "\n";
    }
  }
  return list;
}

}  // namespace arfm_vo
