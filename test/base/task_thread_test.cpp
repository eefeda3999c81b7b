#include "arfm_vo/base/task_thread.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace arfm_vo {
namespace {

TEST(TaskThread, RunsAllTasksOnOneOtherThread) {
  TaskThread thread;
  std::thread::id first, id;
  for (int i = 0; i < 100; ++i) {
    thread.Start([&id] { id = std::this_thread::get_id(); }).Get();
    if (i == 0) first = id;
    ASSERT_EQ(id, first);
  }
  EXPECT_NE(first, std::this_thread::get_id());
}

TEST(TaskThread, ATaskThatIsLetGoHasEnded) {
  TaskThread thread;
  bool has_run = false;
  {
    const auto task = thread.Start([&has_run] { has_run = true; });
  }
  EXPECT_TRUE(has_run);
}

TEST(TaskThread, RethrowsAndGoesOn) {
  TaskThread thread;
  EXPECT_THROW(thread.Start([] { throw std::runtime_error("no"); }).Get(), std::runtime_error);
  bool has_run = false;
  thread.Start([&has_run] { has_run = true; }).Get();
  EXPECT_TRUE(has_run);
}

}  // namespace
}  // namespace arfm_vo
