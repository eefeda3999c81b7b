#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "arfm_vo/matching/appearance.h"

namespace arfm_vo {

/// Finds among very many appearances those like a given one, by hashing with random hyperplanes
/// through the middle of some (Charikar, STOC 2002). A search finds at most 256 however many there
/// are. Grows one by one; the same calls give the same answers.
class DescriptorIndex {
 public:
  /// `training`: where the middle is taken from; not empty.
  explicit DescriptorIndex(const std::vector<Appearance>& training);

  /// `number`: what it is known by, larger than all before.
  void Add(int number, const Appearance& appearance);
  /// Numbers of those that share a key with `appearance`, its sign in it; sorted, each once.
  std::vector<int> FindCandidates(const Appearance& appearance) const;

 private:
  std::vector<uint32_t> Keys(const Appearance& appearance) const;

  Eigen::MatrixXf planes_;   ///< [tables * bits x 64]
  Eigen::VectorXf offsets_;  ///< of the planes
  std::vector<std::unordered_map<uint32_t, std::vector<int>>> tables_;
};

}  // namespace arfm_vo
