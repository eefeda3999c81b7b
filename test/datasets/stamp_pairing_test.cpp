#include "arfm_vo/datasets/stamp_pairing.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

TEST(StampPairing, PairsWhatIsNearInTime) {
  StampPairing<char> pairing(0.01);
  pairing.AddLeft(1.0, 'a');
  EXPECT_FALSE(pairing.Take());
  pairing.AddRight(1.009, 'A');
  pairing.AddRight(1.1, 'B');
  EXPECT_EQ(pairing.Take(), std::pair('a', 'A'));
  EXPECT_FALSE(pairing.Take());
  pairing.AddLeft(1.1, 'b');
  EXPECT_EQ(pairing.Take(), std::pair('b', 'B'));
  EXPECT_EQ(pairing.CountUnpaired(), 0);
}

TEST(StampPairing, DropsAndCountsWhatHasNoPartner) {
  StampPairing<int> pairing(0.01);
  for (const int i : {0, 1, 2, 5}) pairing.AddLeft(i, i);
  for (const int i : {1, 3, 4, 5}) pairing.AddRight(i, 10 + i);
  EXPECT_EQ(pairing.Take(), std::pair(1, 11));
  EXPECT_EQ(pairing.Take(), std::pair(5, 15));
  EXPECT_FALSE(pairing.Take());
  EXPECT_EQ(pairing.CountUnpaired(), 4);  // left 0 and 2, right 3 and 4
  pairing.AddRight(7, 17);
  EXPECT_EQ(pairing.CountUnpaired(), 5);
}

TEST(StampPairing, DropsAndCountsWhatIsNotLater) {
  StampPairing<int> pairing(0.01);
  pairing.AddLeft(1, 1);
  pairing.AddLeft(1, 2);
  pairing.AddLeft(0.5, 3);
  pairing.AddRight(1, 4);
  EXPECT_EQ(pairing.Take(), std::pair(1, 4));
  EXPECT_EQ(pairing.num_late(), 2);
}

TEST(StampPairing, HoldsOnlySoManyOfAStreamWithoutPartners) {
  StampPairing<int> pairing(0.01);
  for (int i = 0; i < 1000; ++i) pairing.AddLeft(i, i);
  EXPECT_EQ(pairing.CountUnpaired(), 1000);
  pairing.AddRight(900, 0);
  EXPECT_EQ(pairing.Take(), std::pair(900, 0));
  pairing.AddRight(10000, 0);
  EXPECT_FALSE(pairing.Take());
  EXPECT_EQ(pairing.CountUnpaired(), 1000);  // 999 of the left, 1 of the right
}

}  // namespace
}  // namespace arfm_vo
