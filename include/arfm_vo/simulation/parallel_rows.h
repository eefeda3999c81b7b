#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace arfm_vo {

/// Calls work(row) for every row in [0, num_rows) on `num_threads` threads. Rows must not depend on
/// each other; the result then does not depend on the number of threads.
template <class Work>
void ForEachRow(int num_rows, int num_threads, const Work& work) {
  std::atomic<int> next_row{0};
  const auto run = [&] {
    for (int row = next_row++; row < num_rows; row = next_row++) work(row);
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < num_threads; ++i) threads.emplace_back(run);
  run();
  for (std::thread& thread : threads) thread.join();
}

}  // namespace arfm_vo
