#include "arfm_vo/hardware/simulated_ptu_port.h"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <utility>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

[[noreturn]] void Fail(const std::string& what) { ThrowSystemError("pseudo terminal: " + what); }

/// A link to a pseudo terminal that is gone, or has become `own`: what an earlier simulation that
/// was killed has left behind. Another's that lives stays.
bool IsLeftBehind(const std::string& path, const std::string& own) {
  std::error_code ignored;
  const std::string target = std::filesystem::read_symlink(path, ignored);
  return target == own || (target.rfind("/dev/pts/", 0) == 0 && !std::filesystem::exists(target));
}

constexpr std::chrono::microseconds kPeriod(1000);  // about a byte at 9600 baud
constexpr double kArcsecond = M_PI / 180 / 3600;

}  // namespace

PseudoTerminal::PseudoTerminal(const std::string& link)
    : link_(link), master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  char name[128];
  if (!master_.IsOpen() || ::grantpt(master_.Get()) != 0 || ::unlockpt(master_.Get()) != 0 ||
      ::ptsname_r(master_.Get(), name, sizeof(name)) != 0)
    Fail("cannot be made");
  device_ = name;
  keeper_ = FileDescriptor(::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios settings{};
  if (!keeper_.IsOpen() || ::tcgetattr(keeper_.Get(), &settings) != 0) Fail(device_);
  ::cfmakeraw(&settings);
  if (::tcsetattr(keeper_.Get(), TCSANOW, &settings) != 0) Fail(device_);
  if (IsLeftBehind(link_, device_)) std::filesystem::remove(link_);
  std::filesystem::create_symlink(device_, link_);
}

PseudoTerminal::~PseudoTerminal() {
  std::error_code ignored;
  if (std::filesystem::read_symlink(link_, ignored) == device_)
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
  if (::write(master_.Get(), bytes.data(), bytes.size()) < 0 && errno != EAGAIN) Fail(link_);
}

SimulatedPtuPort::SimulatedPtuPort(const std::string& link, const SimulatedPtuOptions& options,
                                   Clock clock)
    : link_(link),
      pan_count_rad_(options.pan.resolution_arcsec * kArcsecond),
      tilt_count_rad_(options.tilt.resolution_arcsec * kArcsecond),
      clock_(std::move(clock)),
      ptu_(options),
      line_(std::make_unique<PseudoTerminal>(link)) {
  thread_ = std::thread([this] { Run(); });
}

SimulatedPtuPort::~SimulatedPtuPort() {
  is_stopping_ = true;
  thread_.join();
}

void SimulatedPtuPort::Run() {
  while (!is_stopping_) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (line_) {
        const std::string bytes = line_->Read(0);
        if (!bytes.empty()) ptu_.Receive(bytes, clock_());
      }
      const std::string reply = ptu_.Transmit(clock_());
      if (line_ && !reply.empty()) line_->Write(reply);
    }
    std::this_thread::sleep_for(kPeriod);
  }
}

void SimulatedPtuPort::Unplug() {
  const std::lock_guard<std::mutex> lock(mutex_);
  line_.reset();
}

void SimulatedPtuPort::Plug() {
  const std::lock_guard<std::mutex> lock(mutex_);
  line_.reset();
  line_ = std::make_unique<PseudoTerminal>(link_);
}

double SimulatedPtuPort::Position(PtuAxis axis) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ptu_.Position(axis, clock_());
}

double SimulatedPtuPort::Angle(PtuAxis axis) {
  return Position(axis) * (axis == PtuAxis::kPan ? pan_count_rad_ : tilt_count_rad_);
}

void SimulatedPtuPort::HitLimit(PtuAxis axis, double slip_counts) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ptu_.HitLimit(axis, slip_counts, clock_());
}

}  // namespace arfm_vo
