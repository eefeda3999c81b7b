#include "arfm_vo/hardware/v4l2_buffers.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/time.h>

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

v4l2_buffer MakeBuffer(unsigned index = 0) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
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

V4l2Buffers::~V4l2Buffers() {
  if (fd_ < 0) return;
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  TryV4l2(fd_, VIDIOC_STREAMOFF, &type);
  for (const Mapping& mapping : mapped_) ::munmap(mapping.start, mapping.length);
}

void V4l2Buffers::Start(int fd, const std::string& path, int count) {
  fd_ = fd;
  path_ = path;
  v4l2_requestbuffers request{};
  request.count = static_cast<unsigned>(count);
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  CallV4l2(fd_, VIDIOC_REQBUFS, &request, path_, "gives no buffers");
  if (request.count < 2) ThrowSystemError(path_ + ": gives too few buffers", ENOMEM);
  for (unsigned i = 0; i < request.count; ++i) Map(i);
  for (unsigned i = 0; i < request.count; ++i) {
    v4l2_buffer buffer = MakeBuffer(i);
    GiveBack(buffer);
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  CallV4l2(fd_, VIDIOC_STREAMON, &type, path_, "does not stream");
}

void V4l2Buffers::Map(unsigned index) {
  v4l2_buffer buffer = MakeBuffer(index);
  CallV4l2(fd_, VIDIOC_QUERYBUF, &buffer, path_, "does not show its buffers");
  void* start =
      ::mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, buffer.m.offset);
  if (start == MAP_FAILED) ThrowSystemError(path_ + ": does not map its buffers");
  mapped_.push_back({start, buffer.length});
}

std::optional<v4l2_buffer> V4l2Buffers::Take() {
  v4l2_buffer buffer = MakeBuffer();
  if (!TryV4l2(fd_, VIDIOC_DQBUF, &buffer)) {
    if (errno == EAGAIN) return std::nullopt;
    ThrowSystemError(path_ + ": gives no frame");
  }
  if (buffer.index >= mapped_.size()) ThrowSystemError(path_ + ": gives an unknown buffer", EPROTO);
  if (buffer.bytesused > mapped_[buffer.index].length) buffer.flags |= V4L2_BUF_FLAG_ERROR;
  return buffer;
}

bool V4l2Buffers::MayBeRewritten(const v4l2_buffer& taken) const {
  size_t num_newer = 0;
  for (unsigned i = 0; i < mapped_.size(); ++i) {
    v4l2_buffer buffer = MakeBuffer(i);
    if (!TryV4l2(fd_, VIDIOC_QUERYBUF, &buffer)) return false;  // GiveBack will tell
    if (!timercmp(&buffer.timestamp, &taken.timestamp, >)) continue;
    if (i == taken.index) return true;
    ++num_newer;
  }
  return num_newer + 1 == mapped_.size();
}

void V4l2Buffers::GiveBack(v4l2_buffer& buffer) {
  CallV4l2(fd_, VIDIOC_QBUF, &buffer, path_, "takes no buffer");
}

}  // namespace arfm_vo
