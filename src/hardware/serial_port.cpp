#include "arfm_vo/hardware/serial_port.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/hardware/clock_offset.h"

namespace arfm_vo {
namespace {

[[noreturn]] void FailToOpen(int error, const std::string& path) {
  const std::string advice = error == EACCES   ? "is this user in the group dialout?"
                             : error == ENOTTY ? "give port:= the name of a serial line"
                                               : "is it plugged in? port:= names it";
  ThrowSystemError("serial port '" + path + "' (" + advice + ")", error);
}

speed_t ToSpeed(int baud) {
  static constexpr std::pair<int, speed_t> kSpeeds[] = {
      {1200, B1200},   {2400, B2400},   {4800, B4800},   {9600, B9600},
      {19200, B19200}, {38400, B38400}, {57600, B57600}, {115200, B115200}};
  for (const auto& [rate, speed] : kSpeeds)
    if (rate == baud) return speed;
  throw std::invalid_argument("serial port: no rate of " + std::to_string(baud) + " baud");
}

}  // namespace

SerialPort::SerialPort(const std::string& path, int baud) : path_(path) {
  const speed_t speed = ToSpeed(baud);
  fd_ = FileDescriptor(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!fd_.IsOpen()) FailToOpen(errno, path);
  termios settings{};
  if (::tcgetattr(fd_.Get(), &settings) != 0) FailToOpen(errno, path);
  ::cfmakeraw(&settings);
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | PARENB | CRTSCTS);
  settings.c_cflag |= CS8 | CLOCAL | CREAD;
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  ::cfsetspeed(&settings, speed);
  if (::tcsetattr(fd_.Get(), TCSANOW, &settings) != 0)
    ThrowSystemError("serial port '" + path + "'");
  ::ioctl(fd_.Get(), TIOCEXCL);  // no second driver on the same line
  ::tcflush(fd_.Get(), TCIOFLUSH);
}

bool SerialPort::Wait(short events, double timeout_s) const {
  pollfd wait{fd_.Get(), events, 0};
  const int timeout_ms = static_cast<int>(std::ceil(std::max(timeout_s, 0.0) * 1000));
  const int ready = ::poll(&wait, 1, timeout_ms);
  if (ready < 0 && errno != EINTR) ThrowSystemError("serial port '" + path_ + "'");
  if (ready > 0 && (wait.revents & (POLLERR | POLLHUP | POLLNVAL)) && !(wait.revents & events))
    ThrowSystemError("serial port '" + path_ + "' is gone", EIO);
  return ready > 0;
}

void SerialPort::Write(const std::string& bytes, double timeout_s) {
  const double deadline = Now() + timeout_s;
  size_t sent = 0;
  while (sent < bytes.size()) {
    if (!Wait(POLLOUT, deadline - Now()) && Now() >= deadline)
      ThrowSystemError("serial port '" + path_ + "' takes no bytes", ETIMEDOUT);
    const ssize_t count = ::write(fd_.Get(), bytes.data() + sent, bytes.size() - sent);
    if (count >= 0) {
      sent += static_cast<size_t>(count);
    } else if (errno != EAGAIN && errno != EINTR) {
      ThrowSystemError("serial port '" + path_ + "'");
    }
  }
}

std::string SerialPort::Read(double timeout_s) {
  if (!Wait(POLLIN, timeout_s)) return {};
  char buffer[256];
  const ssize_t count = ::read(fd_.Get(), buffer, sizeof(buffer));
  if (count > 0) return {buffer, static_cast<size_t>(count)};
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return {};
  ThrowSystemError("serial port '" + path_ + "' is gone", count == 0 ? EIO : errno);
}

double SerialPort::Now() const { return MonotonicNow(); }

}  // namespace arfm_vo
