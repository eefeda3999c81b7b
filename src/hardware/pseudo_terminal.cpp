#include "arfm_vo/hardware/pseudo_terminal.h"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <system_error>

namespace arfm_vo {
namespace {

[[noreturn]] void Fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), "pseudo terminal: " + what);
}

/// A link to a pseudo terminal that is gone, or has become `own`: what an earlier simulation that
/// was killed has left behind. Another's that lives stays.
bool IsLeftBehind(const std::string& path, const std::string& own) {
  std::error_code ignored;
  const std::string target = std::filesystem::read_symlink(path, ignored);
  return target == own || (target.rfind("/dev/pts/", 0) == 0 && !std::filesystem::exists(target));
}

}  // namespace

PseudoTerminal::PseudoTerminal(const std::string& link)
    : link_(link), master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  char name[128];
  if (!master_.IsOpen() || ::grantpt(master_.Get()) != 0 || ::unlockpt(master_.Get()) != 0 ||
      ::ptsname_r(master_.Get(), name, sizeof(name)) != 0)
    Fail("cannot be made");
  path_ = slave_ = name;
  keeper_ = FileDescriptor(::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios settings{};
  if (!keeper_.IsOpen() || ::tcgetattr(keeper_.Get(), &settings) != 0) Fail(path_);
  ::cfmakeraw(&settings);
  if (::tcsetattr(keeper_.Get(), TCSANOW, &settings) != 0) Fail(path_);
  if (link_.empty()) return;
  if (IsLeftBehind(link_, slave_)) std::filesystem::remove(link_);
  std::filesystem::create_symlink(path_, link_);
  path_ = link_;
}

PseudoTerminal::~PseudoTerminal() {
  std::error_code ignored;
  if (!link_.empty() && std::filesystem::read_symlink(link_, ignored) == slave_)
    std::filesystem::remove(link_, ignored);
}

std::string PseudoTerminal::Read(double timeout_s) {
  pollfd wait{master_.Get(), POLLIN, 0};
  ::poll(&wait, 1, static_cast<int>(std::ceil(std::max(timeout_s, 0.0) * 1000)));
  char buffer[256];
  const ssize_t count = ::read(master_.Get(), buffer, sizeof(buffer));
  return count > 0 ? std::string(buffer, static_cast<size_t>(count)) : std::string();
}

void PseudoTerminal::Write(const std::string& bytes) {
  // A line drops what nobody reads.
  if (::write(master_.Get(), bytes.data(), bytes.size()) < 0 && errno != EAGAIN) Fail(path_);
}

}  // namespace arfm_vo
