#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <system_error>

#include "arfm_vo/hardware/byte_stream.h"
#include "arfm_vo/hardware/simulated_ptu.h"

namespace arfm_vo {

/// A unit, its clock and what goes wrong between it and the driver; outlives the driver's lines.
struct SimulatedBench {
  SimulatedPtu ptu;
  double now_s = 0;
  bool is_plugged = true;
  std::string sent;  ///< all that the driver wrote
  /// What becomes of bytes on their way to the driver.
  std::function<std::string(const std::string&)> disturb = [](const std::string& bytes) {
    return bytes;
  };

  explicit SimulatedBench(const SimulatedPtuOptions& options = {}) : ptu(options) {}
};

/// The driver's end of a line to a simulated unit, in simulated time: waiting costs nothing.
class SimulatedLine : public ByteStream {
 public:
  explicit SimulatedLine(SimulatedBench& bench) : bench_(bench) { CheckPlugged(); }

  void Write(const std::string& bytes, double) override {
    CheckPlugged();
    bench_.sent += bytes;
    bench_.ptu.Receive(bytes, bench_.now_s);
  }

  std::string Read(double timeout_s) override {
    CheckPlugged();
    const double deadline = bench_.now_s + std::max(timeout_s, 0.0);
    while (true) {
      const std::string bytes = bench_.disturb(bench_.ptu.Transmit(bench_.now_s));
      if (!bytes.empty() || bench_.now_s >= deadline) return bytes;
      bench_.now_s = std::min(bench_.now_s + 0.0005, deadline);
    }
  }

  double Now() const override { return bench_.now_s; }

 private:
  void CheckPlugged() const {
    if (!bench_.is_plugged) throw std::system_error(EIO, std::generic_category(), "line is gone");
  }

  SimulatedBench& bench_;
};

}  // namespace arfm_vo
