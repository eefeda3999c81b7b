#include "arfm_vo/hardware/simulated_ptu_port.h"

#include <chrono>
#include <cmath>
#include <utility>

namespace arfm_vo {
namespace {

constexpr std::chrono::microseconds kPeriod(1000);  // about a byte at 9600 baud
constexpr double kArcsecond = M_PI / 180 / 3600;

}  // namespace

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
