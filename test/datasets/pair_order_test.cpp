#include "arfm_vo/datasets/pair_order.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace arfm_vo {
namespace {

TEST(PairNumbers, CountsTheGapsOfOneSender) {
  const std::vector<std::pair<uint32_t, unsigned>> rows[] = {
      {{17, 0}, {18, 0}, {19, 0}, {20, 0}},  // who comes late misses nothing
      {{5, 0}, {8, 2}, {9, 2}, {11, 3}},
      {{5, 0}, {9, 3}, {1, 0}, {3, 1}}};  // another sender begins anew
  for (const auto& row : rows) {
    PairNumbers numbers;
    for (const auto& [number, num_missing] : row)
      EXPECT_EQ(numbers.CountMissing(number), num_missing) << number;
  }
}

TEST(StampOrder, TellsWhatComesNextAgainOrAfterAJumpBack) {
  constexpr auto kNext = StampVerdict::kNext, kStray = StampVerdict::kStray,
                 kJump = StampVerdict::kJumpBack;
  const std::vector<std::pair<double, StampVerdict>> rows[] = {
      {{5, kNext}, {5.1, kNext}},
      {{5, kNext}, {5, kStray}, {5.1, kNext}},
      {{5, kNext}, {4.1, kStray}, {6, kNext}, {4.2, kStray}, {7, kNext}, {4.3, kStray}},
      {{5, kNext}, {4, kStray}, {4, kStray}, {3, kStray}, {5.1, kNext}},  // time runs forward
      {{100, kNext}, {5, kStray}, {5.1, kJump}, {5.2, kNext}}};           // two in a row
  for (const auto& row : rows) {
    StampOrder<double> order;
    for (const auto& [stamp_s, verdict] : row) EXPECT_EQ(order.Judge(stamp_s), verdict) << stamp_s;
  }
}

}  // namespace
}  // namespace arfm_vo
