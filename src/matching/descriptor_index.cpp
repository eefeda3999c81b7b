#include "arfm_vo/matching/descriptor_index.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

constexpr int kLength = 64;
constexpr double kSteps = 127;  ///< of a rounded number in 1
using Descriptor = Eigen::Map<const Eigen::Matrix<float, kLength, 1>>;

/// In squared steps.
int SquaredDistance(const std::array<int8_t, kLength>& a, const std::array<int8_t, kLength>& b) {
  int sum = 0;
  for (int i = 0; i < kLength; ++i) {
    const int difference = a[i] - b[i];
    sum += difference * difference;
  }
  return sum;
}

}  // namespace

void DescriptorIndexOptions::Check() const {
  Require(tables >= 1 && tables <= 64, "index.tables must be in 1..64");
  Require(bits >= 1 && bits <= 30, "index.bits must be in 1..30");
  Require(max_per_key >= 1, "index.max_per_key must be at least 1");
}

DescriptorIndex::DescriptorIndex(const DescriptorIndexOptions& options)
    : options_(options), engine_(static_cast<uint32_t>(options.seed)), tables_(options.tables) {
  options.Check();
  planes_.resize(options.tables * options.bits, kLength);
  for (Eigen::Index row = 0; row < planes_.rows(); ++row) {
    for (int k = 0; k < kLength; ++k) {  // the sum of four is as good as normal here
      double sum = -2;
      for (int i = 0; i < 4; ++i) sum += RandomUnit(engine_);
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
  offsets_ =
      planes_ * middle * (static_cast<float>(kLength) / static_cast<float>(descriptors.size()));
  is_trained_ = true;
}

DescriptorIndex::Rounded DescriptorIndex::Round(const float* descriptor) {
  Rounded rounded;
  for (int i = 0; i < kLength; ++i) {
    const double steps = std::clamp(kSteps * descriptor[i], -kSteps, kSteps);
    rounded[i] = static_cast<int8_t>(std::lround(steps));
  }
  return rounded;
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
  const int entry = size();
  entries_.push_back({id, Round(descriptor)});
  for (int table = 0; table < options_.tables; ++table) {
    Bucket& bucket = tables_[table][Key(table, descriptor)];
    ++bucket.num_seen;
    if (static_cast<int>(bucket.entries.size()) < options_.max_per_key) {
      bucket.entries.push_back(entry);
      continue;
    }
    // Each of num_seen is kept with the same probability (reservoir sampling, Vitter 1985).
    const uint32_t place = RandomBelow(static_cast<uint32_t>(bucket.num_seen), engine_);
    if (place < bucket.entries.size()) bucket.entries[place] = entry;
  }
}

std::vector<int> DescriptorIndex::FindEntries(const float* descriptor) const {
  std::vector<int> found;
  for (int table = 0; table < options_.tables; ++table) {
    const auto bucket = tables_[table].find(Key(table, descriptor));
    if (bucket == tables_[table].end()) continue;
    found.insert(found.end(), bucket->second.entries.begin(), bucket->second.entries.end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<int64_t> DescriptorIndex::FindCandidates(const float* descriptor) const {
  std::vector<int64_t> ids;
  for (const int entry : FindEntries(descriptor)) ids.push_back(entries_[entry].id);
  return ids;
}

std::optional<int64_t> DescriptorIndex::FindNearest(
    const float* descriptor, double max_distance,
    const std::function<bool(int64_t)>& accept) const {
  const Rounded wanted = Round(descriptor);
  const double max_steps = kSteps * max_distance;
  int least = static_cast<int>(std::ceil(max_steps * max_steps));
  std::optional<int64_t> nearest;
  for (const int entry : FindEntries(descriptor)) {
    const int squared = SquaredDistance(wanted, entries_[entry].descriptor);
    if (squared >= least || !accept(entries_[entry].id)) continue;
    least = squared;
    nearest = entries_[entry].id;
  }
  return nearest;
}

}  // namespace arfm_vo
