// The search kernel, compiled once for each instruction set. It includes no header with inline
// functions, so that no code for a better CPU can leak into the rest of the program.
#include "exact_kernel.h"

namespace arfm_vo {
namespace {

#if defined(__AVX2__)
constexpr int kLanes = 8;
constexpr int kTileRows = 6;
#elif defined(__aarch64__)
constexpr int kLanes = 4;
constexpr int kTileRows = 6;
#else
constexpr int kLanes = 4;
constexpr int kTileRows = 2;
#endif
constexpr int kVectors = kPanelColumns / kLanes;

typedef float Vector __attribute__((vector_size(kLanes * sizeof(float))));
typedef int32_t IndexVector __attribute__((vector_size(kLanes * sizeof(int32_t))));

inline Vector Load(const float* from) {
  Vector vector;
  __builtin_memcpy(&vector, from, sizeof(vector));
  return vector;
}
inline IndexVector Load(const int32_t* from) {
  IndexVector vector;
  __builtin_memcpy(&vector, from, sizeof(vector));
  return vector;
}
/// `value` in all lanes; subtracting zero folds away, adding it does not (-0).
inline Vector Broadcast(float value) { return value - Vector{}; }
inline IndexVector Broadcast(int32_t value) { return value - IndexVector{}; }
template <class V, class T>
inline void Store(const V& vector, T* to) {
  __builtin_memcpy(to, &vector, sizeof(vector));
}

/// Best and second-best scores of several searches, one a lane.
struct LaneBest {
  Vector best, second;
  IndexVector index;

  void Clear() {
    best = second = Broadcast(kNoScore);
    index = Broadcast(-1);
  }
  inline void Add(const Vector& score, const IndexVector& score_index) {
    const Vector lesser = score < best ? score : best;
    second = second < lesser ? lesser : second;
    index = score > best ? score_index : index;
    best = best < score ? score : best;
  }
};

using TileScores = Vector[kTileRows][kVectors];

inline void ScoreTile(const float* const* rows, const float* panel, TileScores& scores) {
  for (int r = 0; r < kTileRows; ++r) {
    for (int v = 0; v < kVectors; ++v) scores[r][v] = Vector{};
  }
  for (int k = 0; k < kDescriptorSize; ++k) {
    Vector columns[kVectors];
    for (int v = 0; v < kVectors; ++v) columns[v] = Load(panel + k * kPanelColumns + v * kLanes);
    for (int r = 0; r < kTileRows; ++r) {
      const Vector row = Broadcast(rows[r][k]);
      for (int v = 0; v < kVectors; ++v) scores[r][v] += row * columns[v];
    }
  }
}

/// Of equal scores the lowest column wins, whichever lane it was in.
inline void ReduceLanes(const LaneBest (&lanes)[kVectors], float& best, float& second,
                        int32_t& index) {
  best = second = kNoScore;
  index = -1;
  for (int lane = 0; lane < kPanelColumns; ++lane) {
    const LaneBest& from = lanes[lane / kLanes];
    const int i = lane % kLanes;
    const bool wins = from.best[i] > best ||
                      (from.best[i] == best && from.index[i] >= 0 && from.index[i] < index);
    const float loser = wins ? best : from.best[i];
    if (wins) {
      best = from.best[i];
      index = from.index[i];
    }
    if (loser > second) second = loser;
    if (from.second[i] > second) second = from.second[i];
  }
}

/// Searches rows first_row .. first_row + kTileRows - 1; those from num_rows on are padding.
void SearchTileRows(const ExactSearch& search, int first_row) {
  const float* rows[kTileRows];
  Vector row_floor[kTileRows];
  for (int r = 0; r < kTileRows; ++r) {
    const bool is_padding = first_row + r >= search.num_rows;
    rows[r] = search.rows[is_padding ? search.num_rows - 1 : first_row + r];
    row_floor[r] = Broadcast(is_padding ? kNoScore : 0.0f);
  }
  LaneBest of_rows[kTileRows][kVectors];
  for (auto& row : of_rows) {
    for (auto& lanes : row) lanes.Clear();
  }
  IndexVector column[kVectors];
  for (int i = 0; i < kPanelColumns; ++i) column[i / kLanes][i % kLanes] = i;
  for (int begin = 0; begin < search.num_columns; begin += kPanelColumns) {
    TileScores scores;
    ScoreTile(rows, search.panels + static_cast<int64_t>(begin) * kDescriptorSize, scores);
    for (int v = 0; v < kVectors; ++v) {
      const int offset = begin + v * kLanes;
      LaneBest of_columns{Load(search.of_columns.best + offset),
                          Load(search.of_columns.second + offset),
                          Load(search.of_columns.index + offset)};
      const Vector column_floor = column[v] < search.num_columns ? Vector{} : Broadcast(kNoScore);
      for (int r = 0; r < kTileRows; ++r) {
        of_rows[r][v].Add(scores[r][v] + column_floor, column[v]);
        of_columns.Add(scores[r][v] + row_floor[r], Broadcast(first_row + r));
      }
      Store(of_columns.best, search.of_columns.best + offset);
      Store(of_columns.second, search.of_columns.second + offset);
      Store(of_columns.index, search.of_columns.index + offset);
      column[v] += kPanelColumns;
    }
  }
  for (int r = 0; r < kTileRows && first_row + r < search.num_rows; ++r) {
    ReduceLanes(of_rows[r], search.of_rows.best[first_row + r],
                search.of_rows.second[first_row + r], search.of_rows.index[first_row + r]);
  }
}

void SearchExactly(const ExactSearch& search) {
  for (int begin = 0; begin < search.num_columns; begin += kPanelColumns) {
    for (int i = begin; i < begin + kPanelColumns; ++i) {
      search.of_columns.best[i] = search.of_columns.second[i] = kNoScore;
      search.of_columns.index[i] = -1;
    }
  }
  for (int row = 0; row < search.num_rows; row += kTileRows) SearchTileRows(search, row);
}

}  // namespace
}  // namespace arfm_vo
