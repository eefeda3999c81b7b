#pragma once

#include <linux/videodev2.h>

#include <optional>
#include <string>
#include <vector>

namespace arfm_vo {

/// ioctl() that goes on after interruptions; returns whether it succeeded, else errno says why.
bool TryV4l2(int fd, unsigned long request, void* argument);

/// As TryV4l2; throws std::system_error "PATH: WHAT" where it does not succeed.
void CallV4l2(int fd, unsigned long request, void* argument, const std::string& path,
              const std::string& what);

/// The formats, sizes and rates of the capture device at `path`, a line each, and its name.
/// Throws std::system_error where it does not open.
std::string ListV4l2Formats(const std::string& path);

/// ListV4l2Formats of every /dev/video*; says so where there is none.
std::string ListV4l2Devices();

/// The memory-mapped buffers of a streaming V4L2 device, queued and streaming while it lives. The
/// descriptor stays the caller's. Methods throw std::system_error naming `path` and the call.
class V4l2Buffers {
 public:
  V4l2Buffers() = default;
  V4l2Buffers(const V4l2Buffers&) = delete;
  ~V4l2Buffers();

  void Start(int fd, const std::string& path, int count);

  /// A filled buffer, which must be given back; nothing where none is ready.
  std::optional<v4l2_buffer> Take();
  /// Whether all other buffers were filled since `taken` was. A device that does not wait for its
  /// buffers (v4l2loopback) may then be writing a later picture into `taken`, under the old stamp.
  bool MayBeRewritten(const v4l2_buffer& taken) const;
  void GiveBack(v4l2_buffer& buffer);
  const void* Memory(const v4l2_buffer& buffer) const { return mapped_[buffer.index].start; }

 private:
  struct Mapping {
    void* start;
    size_t length;
  };

  void Map(unsigned index);

  int fd_ = -1;
  std::string path_;
  std::vector<Mapping> mapped_;
};

}  // namespace arfm_vo
