#include "arfm_vo/base/pacer.h"

#include <gtest/gtest.h>

#include "arfm_vo/base/process_usage.h"
#include "arfm_vo/base/stopwatch.h"

namespace arfm_vo {
namespace {

/// Share of the wall time that a paced thread computes while it does so for 20 ms.
double MeasureShare(double max_share) {
  const double start_s = GetThreadCpuSeconds();
  Stopwatch wall;
  Pacer pacer(max_share);
  while (GetThreadCpuSeconds() - start_s < 0.02) pacer.Pause();
  return 1e3 * (GetThreadCpuSeconds() - start_s) / wall.LapMs();
}

TEST(Pacer, ASleepingThreadKeepsToItsShare) {
  EXPECT_LT(MeasureShare(0.25), 0.3);  // less on a busy machine
  EXPECT_LT(MeasureShare(0.5), 0.6);
}

TEST(Pacer, AllOfTheTimeIsNoSleep) {
  const double start_s = GetThreadCpuSeconds();
  Pacer pacer(1);
  for (int i = 0; i < 1000; ++i) pacer.Pause();
  EXPECT_LT(GetThreadCpuSeconds() - start_s, 0.01);
}

}  // namespace
}  // namespace arfm_vo
