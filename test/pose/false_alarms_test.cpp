#include "arfm_vo/pose/false_alarms.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arfm_vo {
namespace {

TEST(FalseAlarms, CountTheSetsThatAgreeByChance) {
  // Of 6 matches 5 can be chosen in 6 ways, and of these a sample of three in 10; two more agree.
  EXPECT_NEAR(LogFalseAlarms(6, 5, std::log(0.1)), std::log(6 * 10 * 0.1 * 0.1), 1e-12);
  EXPECT_NEAR(LogFalseAlarms(4, 4, std::log(0.01)), std::log(4 * 0.01), 1e-12);
}

TEST(FalseAlarms, FewMatchesThatAllAgreeAreEnoughAndTheSameNumberOfManyIsNot) {
  EXPECT_GT(LeastAgreeing(0), 0);
  EXPECT_GT(LeastAgreeing(5), 5) << "even all of them agree by chance";
  EXPECT_EQ(LeastAgreeing(6), 6);
  int last = 0;
  for (const int num_matches : {6, 15, 30, 100, 300, 1000}) {
    const int least = LeastAgreeing(num_matches);
    EXPECT_GT(least, last);
    EXPECT_LE(LogFalseAlarms(num_matches, least, std::log(0.003)), std::log(1e-4));
    EXPECT_GT(LogFalseAlarms(num_matches, least - 1, std::log(0.003)), std::log(1e-4));
    last = least;
  }
}

}  // namespace
}  // namespace arfm_vo
