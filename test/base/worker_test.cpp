#include "arfm_vo/base/worker.h"

#include <gmock/gmock.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace arfm_vo {
namespace {

using testing::ElementsAre;

void FailOnError(const std::exception& error) { ADD_FAILURE() << error.what(); }

/// A job that goes on until it may end.
class LongJob {
 public:
  void Run() {
    has_begun_.set_value();
    may_end_.get_future().wait();
  }
  void AwaitBegin() { has_begun_.get_future().wait(); }
  void End() { may_end_.set_value(); }

 private:
  std::promise<void> has_begun_, may_end_;
};

TEST(Worker, RunsJobsInTheirOrder) {
  std::vector<int> ran;
  Worker worker(1, FailOnError);
  for (int i = 0; i < 3; ++i) worker.Post([&ran, i] { ran.push_back(i); });
  worker.RunAndWait([&ran] { ran.push_back(3); });
  EXPECT_THAT(ran, ElementsAre(0, 1, 2, 3));
}

TEST(Worker, DropsTheOldestLossyJobsWhileBusyAndNoOthers) {
  std::vector<int> ran;
  LongJob long_job;
  Worker worker(2, FailOnError);
  worker.Post([&] { long_job.Run(); });
  long_job.AwaitBegin();
  for (int i = 0; i < 5; ++i) {
    worker.PostLossy([&ran, i] { ran.push_back(i); });
    if (i == 0) worker.Post([&ran] { ran.push_back(100); });
  }
  long_job.End();
  worker.RunAndWait([] {});
  EXPECT_THAT(ran, ElementsAre(100, 3, 4));
  EXPECT_EQ(worker.num_dropped(), 3u);
}

TEST(Worker, AFloodOfJobsIsBounded) {
  std::atomic<size_t> num_ran{0};
  std::string told;
  LongJob long_job;
  Worker worker(1, [&told](const std::exception& error) { told = error.what(); });
  worker.Post([&] { long_job.Run(); });
  long_job.AwaitBegin();
  for (size_t i = 0; i < Worker::kMaxJobs + 50; ++i) worker.Post([&num_ran] { ++num_ran; });
  EXPECT_THROW(worker.RunAndWait([] {}), std::future_error);
  long_job.End();
  while (num_ran < Worker::kMaxJobs) std::this_thread::yield();
  worker.RunAndWait([] {});
  EXPECT_EQ(num_ran, Worker::kMaxJobs);
  EXPECT_EQ(told, "1000 messages wait to be worked on: the newest are dropped");
}

TEST(Worker, HeldJobsAreRunAfterTheReleaseAndTheLimitFallsBack) {
  std::vector<int> ran;
  LongJob long_job;
  Worker worker(2, FailOnError);
  worker.Hold(4);
  worker.PostLossy([&] {
    long_job.Run();
    worker.Release();
  });
  long_job.AwaitBegin();
  for (int i = 0; i < 5; ++i) worker.PostLossy([&ran, i] { ran.push_back(i); });
  long_job.End();
  worker.RunAndWait([&] {
    for (int i = 5; i < 9; ++i) worker.PostLossy([&ran, i] { ran.push_back(i); });
  });
  worker.RunAndWait([] {});
  EXPECT_THAT(ran, ElementsAre(1, 2, 3, 4, 7, 8));
  EXPECT_EQ(worker.num_dropped(), 3u);
}

TEST(Worker, WhileHeldJobsAreCaughtUpWithAsManyNewOnesWaitAsEver) {
  std::vector<int> ran;
  LongJob long_job;
  Worker worker(2, FailOnError);
  worker.Hold(10);
  worker.PostLossy([&] {
    long_job.Run();
    worker.Release();
  });
  long_job.AwaitBegin();
  worker.PostLossy([&] {
    for (int i = 3; i < 6; ++i) worker.PostLossy([&ran, i] { ran.push_back(i); });
  });
  for (int i = 0; i < 3; ++i) worker.PostLossy([&ran, i] { ran.push_back(i); });
  long_job.End();
  worker.RunAndWait([] {});
  worker.RunAndWait([] {});
  EXPECT_THAT(ran, ElementsAre(1, 2, 3, 4, 5));
}

TEST(Worker, AnErrorOfAJobIsReportedAndTheNextJobRuns) {
  std::vector<std::string> errors;
  Worker worker(1, [&](const std::exception& error) { errors.push_back(error.what()); });
  worker.Post([] { throw std::invalid_argument("bad pair"); });
  bool ran = false;
  worker.RunAndWait([&] { ran = true; });
  EXPECT_TRUE(ran);
  EXPECT_THAT(errors, ElementsAre("bad pair"));
}

TEST(Worker, RunAndWaitRethrows) {
  Worker worker(1, FailOnError);
  EXPECT_THROW(worker.RunAndWait([] { throw std::runtime_error("disk full"); }),
               std::runtime_error);
}

TEST(Worker, ForgetsWhatWaitsWhenItStopsAndTellsTheRunningJob) {
  bool ran = false, was_told = false;
  {
    std::promise<void> is_busy;
    Worker worker(1, FailOnError);
    worker.Post([&] {
      is_busy.set_value();
      while (!worker.is_stopping()) std::this_thread::yield();
      was_told = true;
    });
    worker.Post([&] { ran = true; });
    is_busy.get_future().wait();
  }
  EXPECT_TRUE(was_told);
  EXPECT_FALSE(ran);
}

}  // namespace
}  // namespace arfm_vo
