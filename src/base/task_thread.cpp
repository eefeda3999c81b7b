#include "arfm_vo/base/task_thread.h"

#include <utility>

namespace arfm_vo {

TaskThread::~TaskThread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

TaskThread::Task TaskThread::Start(std::function<void()> work) {
  std::packaged_task<void()> task(std::move(work));
  Task started(task.get_future());
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    task_ = std::move(task);
  }
  changed_.notify_one();
  return started;
}

void TaskThread::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_stopping_ || task_.valid(); });
    if (!task_.valid()) return;
    std::packaged_task<void()> task = std::move(task_);
    lock.unlock();
    task();
    lock.lock();
  }
}

}  // namespace arfm_vo
