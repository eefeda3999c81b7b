#pragma once

#include <functional>
#include <future>
#include <utility>

#include "arfm_vo/base/worker.h"

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

  /// Not before the task before has ended.
  Task Start(std::function<void()> work) { return Task(worker_.Start(std::move(work))); }

 private:
  Worker worker_{1, [](const std::exception&) {}};  // what a task throws is its Task's
};

}  // namespace arfm_vo
