#pragma once

#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <thread>

namespace arfm_vo {

/// A thread for one task after the other. OpenCV keeps some memory for every thread that has ever
/// called it, also for those that have ended: with a new thread for each pair it adds up.
class TaskThread {
 public:
  /// A task under way; waits for its end before it goes.
  class Task {
   public:
    explicit Task(std::future<void> end) : end_(std::move(end)) {}
    Task(Task&&) = default;
    ~Task() {
      if (end_.valid()) end_.wait();
    }
    /// Waits for the end and rethrows what the task threw.
    void Get() { end_.get(); }

   private:
    std::future<void> end_;
  };

  TaskThread() : thread_([this] { Run(); }) {}
  TaskThread(const TaskThread&) = delete;
  ~TaskThread();

  /// Not before the task before has ended.
  Task Start(std::function<void()> work);

 private:
  void Run();

  std::mutex mutex_;  // guards the two that follow
  std::packaged_task<void()> task_;
  bool is_stopping_ = false;
  std::condition_variable changed_;
  std::thread thread_;
};

}  // namespace arfm_vo
