#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "arfm_vo/hardware/file_descriptor.h"

namespace arfm_vo {

/// A file in memory, for readers that take a path.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& content) : fd_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    const auto size = static_cast<ssize_t>(content.size());
    if (!fd_.IsOpen() || ::write(fd_.Get(), content.data(), content.size()) != size)
      throw std::system_error(errno, std::generic_category(), "memfd");
  }
  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_.Get()); }

 private:
  FileDescriptor fd_;
};

}  // namespace arfm_vo
