#include "arfm_vo/matching/descriptor_index.h"

#include <algorithm>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/random.h"

namespace arfm_vo {
namespace {

constexpr int kLength = 64;
using Descriptor = Eigen::Map<const Eigen::Matrix<float, kLength, 1>>;

}  // namespace

void DescriptorIndexOptions::Check() const {
  Require(tables >= 1 && tables <= 64, "index.tables must be in 1..64");
  Require(bits >= 1 && bits <= 30, "index.bits must be in 1..30");
}

DescriptorIndex::DescriptorIndex(const DescriptorIndexOptions& options)
    : options_(options), tables_(options.tables) {
  options.Check();
  RandomEngine engine(static_cast<uint32_t>(options.seed));
  planes_.resize(options.tables * options.bits, kLength);
  for (Eigen::Index row = 0; row < planes_.rows(); ++row) {
    for (int k = 0; k < kLength; ++k) {  // the sum of four is as good as normal here
      double sum = -2;
      for (int i = 0; i < 4; ++i) sum += RandomUnit(engine);
      planes_(row, k) = static_cast<float>(sum);
    }
  }
  offsets_ = Eigen::VectorXf::Zero(planes_.rows());
}

void DescriptorIndex::Train(const std::vector<float>& descriptors) {
  Require(!is_trained_, "descriptor index: trained twice");
  Require(!descriptors.empty() && descriptors.size() % kLength == 0,
          "descriptor index: descriptors must be [N x 64]");
  Eigen::VectorXf middle = Eigen::VectorXf::Zero(kLength);
  for (size_t i = 0; i < descriptors.size(); i += kLength) middle += Descriptor(&descriptors[i]);
  offsets_ = planes_ * middle * (static_cast<float>(kLength) / descriptors.size());
  is_trained_ = true;
}

uint32_t DescriptorIndex::Key(int table, const float* descriptor) const {
  const Eigen::VectorXf sides =
      planes_.middleRows(table * options_.bits, options_.bits) * Descriptor(descriptor) -
      offsets_.segment(table * options_.bits, options_.bits);
  uint32_t key = 0;
  for (int bit = 0; bit < options_.bits; ++bit) key = key << 1 | (sides[bit] > 0);
  return key;
}

void DescriptorIndex::Add(int64_t id, const float* descriptor) {
  for (int table = 0; table < options_.tables; ++table) {
    tables_[table][Key(table, descriptor)].push_back(id);
  }
}

std::vector<int64_t> DescriptorIndex::FindCandidates(const float* descriptor) const {
  std::vector<int64_t> ids;
  for (int table = 0; table < options_.tables; ++table) {
    const auto bucket = tables_[table].find(Key(table, descriptor));
    if (bucket == tables_[table].end()) continue;
    ids.insert(ids.end(), bucket->second.begin(), bucket->second.end());
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

void DescriptorIndex::Clear() {
  for (auto& table : tables_) table.clear();
}

}  // namespace arfm_vo
