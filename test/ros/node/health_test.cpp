#include "arfm_vo/ros/node/health.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

TEST(PairTimes, TellTheMedianAndTheLast) {
  PairTimes times;
  for (const double ms : {1.0, 9.0, 1.0, 5.0}) times.Add(ms);
  EXPECT_EQ(times.Total(), "; median 1.0 ms a pair");
  Diagnostics status;
  times.Report(status);
  ASSERT_EQ(status.values.size(), 2u);
  EXPECT_EQ(status.values[0].key, "pairs a second");
  EXPECT_EQ(status.values[1].value, "5.0");
}

TEST(Refusals, AreAnErrorUntilTheNextItemIsWorkedOn) {
  Refusals refusals{"pair"};
  Diagnostics status;
  EXPECT_FALSE(refusals.IsTold(status));
  refusals.Add("an image is empty");
  refusals.Add("an image is dark");
  EXPECT_TRUE(refusals.IsTold(status));
  EXPECT_EQ(status.level, Diagnostics::ERROR);
  EXPECT_EQ(status.message, "pair refused: an image is dark");
  refusals.Clear();
  EXPECT_FALSE(refusals.IsTold(status));
  EXPECT_EQ(refusals.num(), 2u);
}

TEST(ConsoleWatch, TellsWhatLastsAndRepeatsItSeldom) {
  ConsoleWatch watch;
  int num_told = 0;
  for (int s = 0; s <= 25; ++s) num_told += watch.IsDue("problem", s);
  EXPECT_EQ(num_told, 3);  // at 2, 12 and 22 s
}

TEST(ConsoleWatch, DoesNotTellWhatPasses) {
  ConsoleWatch watch;
  for (int s = 0; s <= 30; ++s) EXPECT_FALSE(watch.IsDue(s % 2 ? "problem" : "", s)) << s;
}

}  // namespace
}  // namespace arfm_vo
