#include "arfm_vo/hardware/v4l2_buffers.h"

#include <sys/mman.h>
#include <sys/time.h>

#include <cerrno>

#include "arfm_vo/base/check.h"
#include "arfm_vo/hardware/v4l2_call.h"

namespace arfm_vo {
namespace {

v4l2_buffer MakeBuffer(unsigned index = 0) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

}  // namespace

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
