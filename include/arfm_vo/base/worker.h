#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

namespace arfm_vo {

/// A thread that runs jobs one after the other, in the order in which they came. State that only
/// jobs touch needs no lock.
class Worker {
 public:
  using Job = std::function<void()>;

  /// `max_waiting` (at least 1) lossy jobs may wait. `on_error` is called on the thread with what a
  /// job throws, and with std::length_error after jobs were dropped by Post.
  Worker(int max_waiting, std::function<void(const std::exception&)> on_error);
  /// Finishes the running job and forgets those that wait.
  ~Worker();

  /// Where kMaxJobs wait, the job is dropped: memory has its bound whatever comes.
  static constexpr size_t kMaxJobs = 1000;
  void Post(Job job) { Add(std::move(job), false); }
  /// Posts a job that may be dropped: where more than `max_waiting` such jobs wait, the oldest
  /// goes.
  void PostLossy(Job job) { Add(std::move(job), true); }
  /// Posts a job. Its end rethrows what the job throws, and std::future_error where it was dropped.
  std::future<void> Start(Job job);

  /// Starts a job and waits for its end. Not from a job.
  void RunAndWait(Job job) { Start(std::move(job)).get(); }

  /// Up to `max_held` lossy jobs may wait until Release; then those that wait are still run, with
  /// `max_waiting` more beside them, and the limit falls with their number to what it was.
  void Hold(int max_held);
  void Release();

  /// Lossy jobs dropped so far.
  uint32_t num_dropped() const { return num_dropped_; }
  /// True once the destructor waits: a long job should come to its end.
  bool is_stopping() const { return is_stopping_; }

 private:
  struct Entry {
    Job job;
    bool is_lossy;
  };

  void Add(Job job, bool is_lossy);
  void DropOldest();
  void RunJobs();

  const int max_waiting_;
  const std::function<void(const std::exception&)> on_error_;
  std::mutex mutex_;  // guards queue_ and the limit
  std::condition_variable changed_;
  std::deque<Entry> queue_;
  int num_lossy_waiting_ = 0;
  int limit_;  // of num_lossy_waiting_, at least max_waiting_
  bool is_held_ = false, is_overrun_ = false;
  std::atomic<uint32_t> num_dropped_{0};
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

/// A value that one thread sets and others read.
template <class Value>
class Shared {
 public:
  Value Get() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return value_;
  }
  void Set(Value value) {
    const std::lock_guard<std::mutex> lock(mutex_);
    value_ = std::move(value);
  }

 private:
  mutable std::mutex mutex_;
  Value value_{};
};

}  // namespace arfm_vo
