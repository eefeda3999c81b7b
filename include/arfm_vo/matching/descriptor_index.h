#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace arfm_vo {

struct DescriptorIndexOptions {
  int tables = 6;  ///< each finds others
  int bits = 11;   ///< of a table's key; more: fewer candidates, fewer finds
  int seed = 1;

  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("tables", tables);
    visit("bits", bits);
    visit("seed", seed);
  }
};

/// Finds among very many descriptors those that may be near a given one, by hashing with random
/// hyperplanes through the middle of the first descriptors (Charikar, STOC 2002). Grows one by one;
/// the same calls give the same answers.
class DescriptorIndex {
 public:
  explicit DescriptorIndex(const DescriptorIndexOptions& options = {});

  /// `descriptors` holds [N x 64] numbers row by row: what the middle is taken from. Call once,
  /// before the first Add.
  void Train(const std::vector<float>& descriptors);
  bool is_trained() const { return is_trained_; }

  void Add(int64_t id, const float* descriptor);
  /// Ids that share a key with the descriptor, ascending, each once.
  std::vector<int64_t> FindCandidates(const float* descriptor) const;
  void Clear();

 private:
  uint32_t Key(int table, const float* descriptor) const;

  DescriptorIndexOptions options_;
  bool is_trained_ = false;
  Eigen::MatrixXf planes_;   ///< [tables * bits x 64]
  Eigen::VectorXf offsets_;  ///< of the planes
  std::vector<std::unordered_map<uint32_t, std::vector<int64_t>>> tables_;
};

}  // namespace arfm_vo
