#include "arfm_vo/odometry/reason.h"

#include <gtest/gtest.h>

#include <set>

namespace arfm_vo {
namespace {

TEST(Reasons, EachHasItsTextAndItsEffectInItsPlace) {
  std::set<std::string> texts;
  for (size_t i = 0; i < ListReasons().size(); ++i) {
    const ReasonRow& row = ListReasons()[i];
    EXPECT_EQ(static_cast<size_t>(row.reason), i);
    EXPECT_TRUE(texts.insert(row.text).second) << row.text;
    EXPECT_NE(std::string(row.effect), "");
  }
  EXPECT_EQ(static_cast<size_t>(Reason::kNoConsensus) + 1, ListReasons().size());
}

}  // namespace
}  // namespace arfm_vo
