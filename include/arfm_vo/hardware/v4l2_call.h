#pragma once

#include <string>

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

}  // namespace arfm_vo
