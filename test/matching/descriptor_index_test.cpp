#include "arfm_vo/matching/descriptor_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arfm_vo/base/random.h"

namespace arfm_vo {
namespace {

using Descriptor = std::vector<float>;  // [64]

/// A unit vector about `middle`, moved by `spread` at random.
Descriptor DrawAbout(const Descriptor& middle, double spread, RandomEngine& engine) {
  Descriptor descriptor(64);
  double squares = 0;
  for (int i = 0; i < 64; ++i) {
    const double moved = middle[i] + spread * (2 * RandomUnit(engine) - 1);
    descriptor[i] = static_cast<float>(moved);
    squares += moved * moved;
  }
  for (float& x : descriptor) x = static_cast<float>(x / std::sqrt(squares));
  return descriptor;
}

class DescriptorIndexTest : public ::testing::Test {
 protected:
  DescriptorIndexTest() {
    // As SURF's are: all in one corner of the sphere.
    const Descriptor corner(64, 0.125f);
    Descriptor training;
    for (int i = 0; i < 2000; ++i) {
      known_.push_back(DrawAbout(corner, 0.25, engine_));
      training.insert(training.end(), known_.back().begin(), known_.back().end());
    }
    index_.Train(training);
    for (int i = 0; i < 2000; ++i) index_.Add(10 * i, known_[i].data());
  }

  RandomEngine engine_{5};
  std::vector<Descriptor> known_;
  DescriptorIndex index_;
};

TEST_F(DescriptorIndexTest, FindsWhatItHolds) {
  for (int i = 0; i < 2000; i += 100) {
    const auto ids = index_.FindCandidates(known_[i].data());
    EXPECT_TRUE(std::binary_search(ids.begin(), ids.end(), 10 * i)) << i;
  }
}

TEST_F(DescriptorIndexTest, FindsMostOfWhatIsNearAndLittleElse) {
  int num_found = 0;
  size_t num_candidates = 0;
  for (int i = 0; i < 2000; i += 10) {
    const auto ids = index_.FindCandidates(DrawAbout(known_[i], 0.05, engine_).data());
    num_found += std::binary_search(ids.begin(), ids.end(), 10 * i);
    num_candidates += ids.size();
  }
  EXPECT_GT(num_found, 140);               // of 200
  EXPECT_LT(num_candidates, 200u * 200u);  // a tenth of all
}

TEST_F(DescriptorIndexTest, FindsTheNearestThatIsAccepted) {
  const auto any = [](int64_t) { return true; };
  EXPECT_EQ(index_.FindNearest(known_[7].data(), 0.5, any), 70);
  const auto other = [](int64_t id) { return id != 70; };
  EXPECT_NE(index_.FindNearest(known_[7].data(), 2, other), 70);
  EXPECT_EQ(index_.FindNearest(known_[7].data(), 0.1, other), std::nullopt);
}

TEST_F(DescriptorIndexTest, FindsNothingAcrossTheSphere) {
  Descriptor opposite = known_[7];
  for (float& x : opposite) x = -x;
  EXPECT_EQ(index_.FindNearest(opposite.data(), 0.6, [](int64_t) { return true; }), std::nullopt);
}

/// Were all landmarks alike, a search would still look at tables * max_per_key of them at most,
/// from early and late alike.
TEST(CrowdedDescriptorIndex, BoundsASearchAndKeepsOldAndNew) {
  DescriptorIndexOptions options;
  options.max_per_key = 50;
  DescriptorIndex index(options);
  const Descriptor one(64, 0.125f);
  index.Train(one);
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) index.Add(i, one.data());
  EXPECT_EQ(index.size(), kCount);
  const auto ids = index.FindCandidates(one.data());
  EXPECT_LE(ids.size(), 400u);
  EXPECT_GT(ids.size(), 300u);  // the tables draw apart from each other
  const auto middle = std::lower_bound(ids.begin(), ids.end(), kCount / 2);
  EXPECT_GT(middle - ids.begin(), 100);
  EXPECT_GT(ids.end() - middle, 100);
}

TEST_F(DescriptorIndexTest, RefusesToBeTrainedTwiceOrOnNothing) {
  EXPECT_THROW(index_.Train(known_[0]), std::invalid_argument);
  DescriptorIndex fresh;
  EXPECT_THROW(fresh.Train({}), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
