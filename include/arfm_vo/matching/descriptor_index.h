#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "arfm_vo/base/random.h"

namespace arfm_vo {

struct DescriptorIndexOptions {
  int tables = 8;        ///< each finds others
  int bits = 14;         ///< of a table's key; more: fewer candidates, fewer finds
  int max_per_key = 32;  ///< descriptors that a table keeps of one key, drawn at random among all
  int seed = 1;          ///< of the tables' random directions

  void Check() const;
};

/// Finds among very many descriptors one near a given one, by hashing with random hyperplanes
/// through the middle of the first descriptors (Charikar, STOC 2002). A search compares at most
/// tables * max_per_key descriptors however many there are. Grows one by one; the same calls give
/// the same answers.
class DescriptorIndex {
 public:
  explicit DescriptorIndex(const DescriptorIndexOptions& options = {});

  /// `descriptors` holds [N x 64] numbers row by row: what the middle is taken from. Call once,
  /// before the first Add.
  void Train(const std::vector<float>& descriptors);
  bool is_trained() const { return is_trained_; }

  /// Adds a descriptor [64] of unit length.
  void Add(int64_t id, const float* descriptor);
  int size() const { return static_cast<int>(entries_.size()); }

  /// Ids that share a key with the descriptor, in the order they were added, each once.
  std::vector<int64_t> FindCandidates(const float* descriptor) const;
  /// The nearest of those, nearer than `max_distance` (to about 0.02), that `accept` takes.
  std::optional<int64_t> FindNearest(const float* descriptor, double max_distance,
                                     const std::function<bool(int64_t)>& accept) const;

 private:
  /// Numbers in steps of 1 / 127: a cache line, where floats take four.
  using Rounded = std::array<int8_t, 64>;
  struct Entry {
    int64_t id;
    Rounded descriptor;
  };
  /// What hashed to one key.
  struct Bucket {
    std::vector<int> entries;
    int num_seen = 0;  ///< kept or not
  };

  static Rounded Round(const float* descriptor);
  uint32_t Key(int table, const float* descriptor) const;
  std::vector<int> FindEntries(const float* descriptor) const;

  DescriptorIndexOptions options_;
  bool is_trained_ = false;
  Eigen::MatrixXf planes_;   ///< [tables * bits x 64]
  Eigen::VectorXf offsets_;  ///< of the planes
  RandomEngine engine_;
  std::vector<Entry> entries_;
  std::vector<std::unordered_map<uint32_t, Bucket>> tables_;
};

}  // namespace arfm_vo
