#include "arfm_vo/base/worker.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace arfm_vo {

Worker::Worker(int max_waiting, std::function<void(const std::exception&)> on_error)
    : max_waiting_(max_waiting),
      on_error_(std::move(on_error)),
      limit_(max_waiting),
      thread_([this] { RunJobs(); }) {}

Worker::~Worker() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_stopping_ = true;
    queue_.clear();
  }
  changed_.notify_all();
  thread_.join();
}

void Worker::Add(Job job, bool is_lossy) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_stopping_) return;
    if (!is_lossy && queue_.size() >= kMaxJobs) {
      is_overrun_ = true;
      return;
    }
    if (is_lossy && num_lossy_waiting_ == limit_) DropOldest();
    if (is_lossy) ++num_lossy_waiting_;
    queue_.push_back({std::move(job), is_lossy});
  }
  changed_.notify_one();
}

void Worker::DropOldest() {
  queue_.erase(std::find_if(queue_.begin(), queue_.end(),
                            [](const Entry& entry) { return entry.is_lossy; }));
  --num_lossy_waiting_;
  ++num_dropped_;
}

void Worker::Hold(int max_held) {
  const std::lock_guard<std::mutex> lock(mutex_);
  limit_ = std::max(limit_, max_held);
  is_held_ = true;
}

void Worker::Release() {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_held_ = false;
}

std::future<void> Worker::Start(Job job) {
  const auto task = std::make_shared<std::packaged_task<void()>>(std::move(job));
  std::future<void> end = task->get_future();
  Post([task] { (*task)(); });  // forgotten, it breaks its promise
  return end;
}

void Worker::RunJobs() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_stopping_ || !queue_.empty(); });
    if (is_stopping_) return;
    const Entry entry = std::move(queue_.front());
    queue_.pop_front();
    if (entry.is_lossy) --num_lossy_waiting_;
    if (!is_held_) limit_ = std::min(num_lossy_waiting_ + max_waiting_, limit_);
    const bool is_overrun = std::exchange(is_overrun_, false);
    lock.unlock();
    try {
      entry.job();
      if (is_overrun)
        throw std::length_error(std::to_string(kMaxJobs) +
                                " messages wait to be worked on: the newest are dropped");
    } catch (const std::exception& error) {
      on_error_(error);
    }
    lock.lock();
  }
}

}  // namespace arfm_vo
