#include "arfm_vo/hardware/clock_offset.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

TEST(ClockOffset, IsMeasuredAgainEachPeriod) {
  double monotonic = 10, offset = 1000;
  ClockOffset clock([&] { return monotonic; }, [&] { return monotonic + offset; }, 1);
  EXPECT_EQ(clock.ToWall(9.5), 1009.5);
  offset = 1000.001;  // steered
  EXPECT_EQ(clock.ToWall(9.5), 1009.5);
  monotonic = 11;
  EXPECT_NEAR(clock.ToWall(10.5), 1010.501, 1e-9);
  EXPECT_EQ(clock.num_jumps(), 0);
  offset = 5000;  // set
  monotonic = 12;
  EXPECT_NEAR(clock.ToWall(11.5), 5011.5, 1e-9);
  EXPECT_EQ(clock.num_jumps(), 1);
}

TEST(ClockOffset, TakesTheMeasurementThatWasLeastHeldUp) {
  double monotonic = 10;
  int calls = 0;
  ClockOffset clock(
      [&] {
        // Asked for the time once, then before and after each try: late except after the third.
        const bool is_held_up = calls > 0 && calls % 2 == 0 && calls != 6;
        ++calls;
        return is_held_up ? monotonic + 0.4 : monotonic;
      },
      [&] { return monotonic + 1000; }, 1);
  EXPECT_NEAR(clock.ToWall(10), 1010, 0.01);
}

}  // namespace
}  // namespace arfm_vo
