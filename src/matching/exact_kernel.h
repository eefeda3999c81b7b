#pragma once

#include <cstdint>

namespace arfm_vo {

/// Columns searched at once. Column arrays are padded to a multiple of it.
constexpr int kPanelColumns = 16;
constexpr int kDescriptorSize = 64;

/// Best and second-best score so far, and the index of the best, of consecutive descriptors.
struct ScoreSpans {
  float* best;
  float* second;
  int32_t* index;
};

/// The input of a search of each of `num_rows` descriptors against each of `num_columns`.
struct ExactSearch {
  const float* const* rows;  ///< [num_rows] descriptors of kDescriptorSize
  int num_rows;
  const float* panels;  ///< [ceil(num_columns / 16)][kDescriptorSize][16], zero where padded
  int num_columns;
  ScoreSpans of_rows;     ///< [num_rows]; written
  ScoreSpans of_columns;  ///< [num_columns padded to 16]; written
};

/// Scores below this are not descriptors' but padding's.
constexpr float kNoScore = -1e30f;

/// Runs the search; of equal scores the lowest index wins. The two differ in the instructions
/// they use only: the bits are the same.
void SearchExactlyBaseline(const ExactSearch& search);
void SearchExactlyAvx2(const ExactSearch& search);
/// True where this program has SearchExactlyAvx2 and this CPU can run it.
bool CanSearchExactlyAvx2();

}  // namespace arfm_vo
