#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <system_error>

#include "arfm_vo/base/random.h"
#include "arfm_vo/hardware/stereo_camera_device.h"

namespace arfm_vo {

/// What one simulated camera does wrong.
struct CameraFaults {
  std::atomic<bool> is_unplugged = false;  ///< by a test, while a node reads
  bool is_silent = false, fails_to_read = false;
  double drop_share = 0, corrupt_share = 0, late_stamp_share = 0;
  double jitter_s = 0;  ///< of stamps, uniform
  double phase_s = 0;   ///< later than the left camera's clock
};

/// Two simulated cameras and their clock. Frame n is exposed at n / rate, shows n in its first four
/// bytes, and arrives 20 ms later.
struct SimulatedCameras {
  static constexpr double kArrival_s = 0.02;
  double now_s = 100;
  double rate_hz = 10;
  CameraFaults faults[2];
  int num_opened = 0, num_waits = 0;
  std::optional<Exposure> exposure[2];
  RandomEngine engine{1};

  VideoEnvironment Environment();
  double NextArrival() const {
    return (std::floor((now_s - kArrival_s) * rate_hz + 1e-9) + 1) / rate_hz + kArrival_s;
  }
};

inline int ReadNumber(const VideoFrame& frame) {
  int number = 0;
  std::copy_n(frame.grey.ptr<uint8_t>(), sizeof(number), reinterpret_cast<uint8_t*>(&number));
  return number;
}

class SimulatedSide : public VideoDevice {
 public:
  SimulatedSide(SimulatedCameras& world, int side, int width)
      : world_(world), side_(side), width_(width), next_(Newest() + 1) {
    Check();
    ++world.num_opened;
  }

  int FileDescriptor() const override { return side_; }

  std::optional<VideoFrame> Read() override {
    Check();
    if (Faults().fails_to_read) throw std::system_error(EIO, std::generic_category(), "read");
    while (next_ <= Newest()) {
      const int number = next_++;
      if (Faults().is_silent) continue;
      if (Chance(Faults().drop_share)) {
        ++counts_.num_dropped;
        continue;
      }
      if (Chance(Faults().corrupt_share)) {
        ++counts_.num_corrupted;
        continue;
      }
      ++counts_.num_frames;
      return MakeFrame(number);
    }
    return std::nullopt;
  }

  VideoCounts counts() const override { return counts_; }
  std::string warning() const override { return ""; }
  std::optional<Exposure> ReadExposure() const override { return world_.exposure[side_]; }
  void SetExposure(const Exposure& exposure) override { world_.exposure[side_] = exposure; }

 private:
  const CameraFaults& Faults() const { return world_.faults[side_]; }
  void Check() const {
    if (Faults().is_unplugged) throw std::system_error(ENODEV, std::generic_category(), "device");
  }
  bool Chance(double share) { return share > 0 && RandomUnit(world_.engine) < share; }
  int Newest() const {
    return static_cast<int>(
        std::floor((world_.now_s - SimulatedCameras::kArrival_s) * world_.rate_hz + 1e-9));
  }
  VideoFrame MakeFrame(int number) {
    VideoFrame frame{cv::Mat(4, width_, CV_8UC1, cv::Scalar(side_)),
                     number / world_.rate_hz + Faults().phase_s +
                         Faults().jitter_s * (RandomUnit(world_.engine) - 0.5),
                     Chance(Faults().late_stamp_share)};
    if (frame.is_stamped_late) frame.stamp_s = world_.now_s;
    std::copy_n(reinterpret_cast<const uint8_t*>(&number), sizeof(number),
                frame.grey.ptr<uint8_t>());
    return frame;
  }

  SimulatedCameras& world_;
  const int side_, width_;
  int next_;
  VideoCounts counts_;
};

inline VideoEnvironment SimulatedCameras::Environment() {
  return {[this](const std::string& path, const VideoOptions& options) {
            return std::make_unique<SimulatedSide>(*this, path == "right" ? 1 : 0, options.width);
          },
          [this] { return now_s; },
          [this](const std::vector<int>& descriptors, double timeout_s) {
            ++num_waits;
            const double end_s = now_s + std::max(timeout_s, 0.0);
            now_s = descriptors.empty() ? end_s : std::min(end_s, NextArrival());
          }};
}

}  // namespace arfm_vo
