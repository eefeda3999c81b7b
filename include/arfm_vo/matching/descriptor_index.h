#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "arfm_vo/base/random.h"
#include "arfm_vo/matching/appearance.h"

namespace arfm_vo {

struct DescriptorIndexOptions {
  int tables = 8;        ///< each finds others
  int bits = 14;         ///< of a table's key; more: fewer candidates, fewer finds
  int max_per_key = 32;  ///< appearances that a table keeps of one key, drawn at random among all

  void Check() const;
};

/// Finds among very many appearances those like a given one, by hashing with random hyperplanes
/// through the middle of the first ones (Charikar, STOC 2002). A search finds at most
/// tables * max_per_key however many there are. Grows one by one; the same calls give the same
/// answers.
class DescriptorIndex {
 public:
  explicit DescriptorIndex(const DescriptorIndexOptions& options = {});

  /// Takes the middle from these. To be called once, before the first Add.
  void Train(const std::vector<Appearance>& appearances);
  /// The next one, which is known by its number from 0 on.
  void Add(const Appearance& appearance);
  int size() const { return size_; }

  /// Numbers of those that share a key with `appearance`, its sign in it; sorted, each once.
  std::vector<int> FindCandidates(const Appearance& appearance) const;

 private:
  /// What hashed to one key.
  struct Bucket {
    std::vector<int> numbers;
    int num_seen = 0;  ///< kept or not
  };
  std::vector<uint32_t> Keys(const Appearance& appearance) const;

  DescriptorIndexOptions options_;
  Eigen::MatrixXf planes_;   ///< [tables * bits x 64]
  Eigen::VectorXf offsets_;  ///< of the planes; empty: not trained
  RandomEngine engine_{1};
  int size_ = 0;
  std::vector<std::unordered_map<uint32_t, Bucket>> tables_;
};

}  // namespace arfm_vo
