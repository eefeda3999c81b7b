#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <string>
#include <thread>

#include "arfm_vo/hardware/clock_offset.h"
#include "hardware/loopback_writer.h"

namespace arfm_vo {

/// The moments at which a camera showed its numbered pictures.
class ShownMoments {
 public:
  void Add(int number, double from_s, double to_s) {
    const std::lock_guard<std::mutex> lock(mutex_);
    moments_[number] = {from_s, to_s};
  }
  /// Whether picture `number` was being shown at `stamp_s`, which the device has in whole us.
  bool Covers(int number, double stamp_s) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto moment = moments_.find(number);
    return moment != moments_.end() && stamp_s > moment->second.first - 2e-6 &&
           stamp_s < moment->second.second + 2e-6;
  }

 private:
  mutable std::mutex mutex_;
  std::map<int, std::pair<double, double>> moments_;
};

/// Two v4l2loopback cameras that show numbered pictures at a rate, each picture at once on both;
/// what goes wrong is set from outside. However late the thread runs, pictures of other numbers are
/// shown half the time between frames apart: the stamps always tell which belong together.
class NumberedCameras {
 public:
  static constexpr int kWidth = 320, kHeight = 240;
  static constexpr double kRate_hz = 20;

  NumberedCameras(const std::string& left, const std::string& right)
      : writers_{{left, kWidth, kHeight}, {right, kWidth, kHeight}}, thread_([this] { Run(); }) {}
  ~NumberedCameras() {
    is_stopping_ = true;
    thread_.join();
  }

  const ShownMoments& shown(int side) const { return shown_[side]; }

  std::atomic<bool> is_right_silent{false};
  std::atomic<int> drop_right_every{0}, drop_left_every{0};
  std::atomic<double> right_late_s{0};

 private:
  void Run() {
    double next_s = MonotonicNow();
    for (int number = 1; !is_stopping_; ++number) {
      SleepUntil(next_s);
      if (!IsDropped(number, drop_left_every)) Show(0, number);
      SleepUntil(MonotonicNow() + right_late_s);
      if (!is_right_silent && !IsDropped(number, drop_right_every)) Show(1, number);
      next_s = std::max(next_s + 1 / kRate_hz, MonotonicNow() + 0.5 / kRate_hz);
    }
  }
  /// The number stands at both ends of the picture: one that is half another's is known by that.
  void Show(int side, int number) {
    cv::Mat picture(kHeight, kWidth, CV_8UC1, cv::Scalar(number % 200));
    const auto* bytes = reinterpret_cast<const uint8_t*>(&number);
    std::copy_n(bytes, sizeof(number), picture.data);
    std::copy_n(bytes, sizeof(number), picture.data + picture.total() - sizeof(number));
    const double from_s = MonotonicNow();
    shown_[side].Add(number, from_s, from_s + 3600);
    writers_[side].Write(picture);
    shown_[side].Add(number, from_s, MonotonicNow());
  }
  static bool IsDropped(int number, int every) { return every > 0 && number % every == 0; }
  static void SleepUntil(double time_s) {
    const double wait_s = time_s - MonotonicNow();
    if (wait_s > 0) std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
  }

  LoopbackWriter writers_[2];
  ShownMoments shown_[2];
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

}  // namespace arfm_vo
