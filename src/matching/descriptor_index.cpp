#include "arfm_vo/matching/descriptor_index.h"

#include <algorithm>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/random.h"

namespace arfm_vo {
namespace {

constexpr int kTables = 8;      ///< each finds others
constexpr int kBits = 14;       ///< of a table's key; more: fewer candidates, fewer finds
constexpr int kMaxPerKey = 32;  ///< that a search takes from a table, spread over old and new

Eigen::VectorXf Descriptor(const Appearance& appearance) {
  using Steps = Eigen::Matrix<int8_t, Appearance::kLength, 1>;
  return Eigen::Map<const Steps>(appearance.descriptor.data()).cast<float>();
}

}  // namespace

DescriptorIndex::DescriptorIndex(const std::vector<Appearance>& training)
    : planes_(kTables * kBits, Appearance::kLength), tables_(kTables) {
  Require(!training.empty(), "descriptor index: nothing to be trained on");
  RandomEngine engine(1);
  for (Eigen::Index i = 0; i < planes_.size(); ++i) {
    double sum = -2;  // of four: as good as normal here
    for (int k = 0; k < 4; ++k) sum += RandomUnit(engine);
    planes_.data()[i] = static_cast<float>(sum);
  }
  Eigen::VectorXf middle = Eigen::VectorXf::Zero(Appearance::kLength);
  for (const Appearance& appearance : training) middle += Descriptor(appearance);
  offsets_ = planes_ * middle / static_cast<float>(training.size());
}

std::vector<uint32_t> DescriptorIndex::Keys(const Appearance& appearance) const {
  const Eigen::VectorXf sides = planes_ * Descriptor(appearance) - offsets_;
  std::vector<uint32_t> keys(kTables, appearance.laplacian_sign > 0);
  for (int i = 0; i < sides.size(); ++i) {
    uint32_t& key = keys[i / kBits];
    key = key << 1 | (sides[i] > 0);
  }
  return keys;
}

void DescriptorIndex::Add(int number, const Appearance& appearance) {
  const std::vector<uint32_t> keys = Keys(appearance);
  for (int table = 0; table < kTables; ++table) tables_[table][keys[table]].push_back(number);
}

std::vector<int> DescriptorIndex::FindCandidates(const Appearance& appearance) const {
  const std::vector<uint32_t> keys = Keys(appearance);
  std::vector<int> found;
  for (int table = 0; table < kTables; ++table) {
    const auto bucket = tables_[table].find(keys[table]);
    if (bucket == tables_[table].end()) continue;
    const std::vector<int>& numbers = bucket->second;
    const size_t step = (numbers.size() + kMaxPerKey - 1) / kMaxPerKey;
    for (size_t i = table % step; i < numbers.size(); i += step) found.push_back(numbers[i]);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace arfm_vo
