// Part of the build for the thread sanitizer alone (scripts/test_sanitized.sh thread): OpenCV's
// loops run on threads of the standard library. The sanitizer does not see how TBB, which is not
// built with it, makes one thread wait for another, and takes all that these share for races.
#include <algorithm>
#include <memory>
#include <opencv2/core/parallel/parallel_backend.hpp>
#include <thread>
#include <utility>
#include <vector>

namespace arfm_vo {
namespace {

thread_local int thread_number = 0;

class StandardThreads : public cv::parallel::ParallelForAPI {
 public:
  void parallel_for(int tasks, FN_parallel_for_body_cb_t body, void* data) override {
    const int num = std::min(tasks, num_threads_);
    std::vector<std::thread> threads;
    for (int i = 0; i < num; ++i) {
      const int first = i * tasks / num, end = (i + 1) * tasks / num;
      threads.emplace_back([=] {
        thread_number = i;
        body(first, end, data);
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
  int getThreadNum() const override { return thread_number; }
  int getNumThreads() const override { return num_threads_; }
  int setNumThreads(int num) override { return std::exchange(num_threads_, num > 0 ? num : 2); }
  const char* getName() const override { return "std::thread"; }

 private:
  int num_threads_ = 2;
};

[[maybe_unused]] const bool is_set = [] {
  cv::parallel::setParallelForBackend(std::make_shared<StandardThreads>(), false);
  return true;
}();

}  // namespace
}  // namespace arfm_vo
