#include "arfm_vo/matching/descriptor_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "matching/random_features.h"

namespace arfm_vo {
namespace {

using Descriptor = std::vector<float>;  // [64]

/// A unit vector about `middle`, moved by `spread` at random.
Descriptor DrawAbout(const Descriptor& middle, double spread, RandomEngine& engine) {
  Descriptor descriptor = middle;
  for (float& x : descriptor) x += static_cast<float>(spread * (2 * RandomUnit(engine) - 1));
  Normalise(descriptor.data());
  return descriptor;
}

class DescriptorIndexTest : public ::testing::Test {
 protected:
  DescriptorIndexTest() {
    // As SURF's are: all in one corner of the sphere.
    const Descriptor corner(64, 0.125f);
    std::vector<Appearance> training;
    for (int i = 0; i < 2000; ++i) {
      known_.push_back(DrawAbout(corner, 0.25, engine_));
      training.emplace_back(known_.back().data(), 1);
    }
    index_.emplace(training);
    for (int i = 0; i < 2000; ++i) index_->Add(i, training[i]);
  }

  std::vector<int> Find(const Descriptor& descriptor, int8_t sign = 1) const {
    return index_->FindCandidates({descriptor.data(), sign});
  }

  RandomEngine engine_{5};
  std::vector<Descriptor> known_;
  std::optional<DescriptorIndex> index_;
};

TEST_F(DescriptorIndexTest, FindsWhatItHolds) {
  for (int i = 0; i < 2000; i += 100) {
    const auto found = Find(known_[i]);
    EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i)) << i;
  }
}

TEST_F(DescriptorIndexTest, FindsMostOfWhatIsNearAndLittleElse) {
  int num_found = 0;
  size_t num_candidates = 0;
  for (int i = 0; i < 2000; i += 10) {
    const auto found = Find(DrawAbout(known_[i], 0.05, engine_));
    num_found += std::binary_search(found.begin(), found.end(), i);
    num_candidates += found.size();
  }
  EXPECT_GT(num_found, 140);               // of 200
  EXPECT_LT(num_candidates, 200u * 200u);  // a tenth of all
}

TEST_F(DescriptorIndexTest, FindsNothingOfTheOtherSignNorAcrossTheSphere) {
  Descriptor opposite = known_[7];
  for (float& x : opposite) x = -x;
  const auto across = Find(opposite);
  EXPECT_FALSE(std::binary_search(across.begin(), across.end(), 7));
  EXPECT_TRUE(Find(known_[7], -1).empty());
}

/// Were all landmarks alike, a search would still look at 8 tables * 32 of them at most,
/// from early and late alike.
TEST(CrowdedDescriptorIndex, BoundsASearchAndKeepsOldAndNew) {
  const Appearance one(Descriptor(64, 0.125f).data(), 1);
  DescriptorIndex index({one});
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) index.Add(i, one);
  const auto ids = index.FindCandidates(one);
  EXPECT_LE(ids.size(), 256u);
  EXPECT_GT(ids.size(), 200u);  // the tables draw apart from each other
  const auto middle = std::lower_bound(ids.begin(), ids.end(), kCount / 2);
  EXPECT_GT(middle - ids.begin(), 100);
  EXPECT_GT(ids.end() - middle, 100);
}

TEST_F(DescriptorIndexTest, RefusesToBeTrainedOnNothing) {
  EXPECT_THROW(DescriptorIndex({}), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
