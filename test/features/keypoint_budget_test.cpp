#include "arfm_vo/features/keypoint_budget.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

std::vector<float> ResponsesOf(const std::vector<ScaleSpaceMaximum>& maxima) {
  std::vector<float> responses;
  for (const ScaleSpaceMaximum& maximum : maxima) responses.push_back(maximum.response);
  return responses;
}

/// Three in the left cell of 10 px, one in the right one.
const std::vector<ScaleSpaceMaximum> kMaxima = {
    {1, 1, 0, 1, 5}, {2, 2, 0, 1, 7}, {3, 3, 0, 1, 6}, {15, 5, 0, 1, 1}};

TEST(KeypointBudgetTest, TakesTheStrongestOfEachCellFirst) {
  EXPECT_EQ(ResponsesOf(RankSpread(kMaxima, 10, 20, 10)), (std::vector<float>{7, 1, 6, 5}));
}

TEST(KeypointBudgetTest, TakesTheStrongestFirstWithoutCells) {
  EXPECT_EQ(ResponsesOf(RankSpread(kMaxima, 10, 20, 0)), (std::vector<float>{7, 6, 5, 1}));
}

}  // namespace
}  // namespace arfm_vo
