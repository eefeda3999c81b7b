#include "arfm_vo/image/grey_statistics.h"

#include <algorithm>
#include <cstdint>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

/// Sums of one row in chunks short enough for 32 bits, which the compiler vectorises.
void AddRow(const uint8_t* row, int cols, uint64_t* sum, uint64_t* sum_of_squares) {
  constexpr int kChunk = 1 << 15;
  for (int begin = 0; begin < cols; begin += kChunk) {
    const int end = std::min(cols, begin + kChunk);
    uint32_t chunk_sum = 0, chunk_squares = 0;
    for (int x = begin; x < end; ++x) {
      const uint32_t grey = row[x];
      chunk_sum += grey;
      chunk_squares += grey * grey;
    }
    *sum += chunk_sum;
    *sum_of_squares += chunk_squares;
  }
}

}  // namespace

GreyStatistics ComputeGreyStatistics(const cv::Mat& grey) {
  Require(!grey.empty(), "grey statistics: the image is empty");
  Require(grey.type() == CV_8UC1, "grey statistics: the image must be 8 bit grey");
  uint64_t sum = 0, sum_of_squares = 0;
  for (int y = 0; y < grey.rows; ++y) AddRow(grey.ptr(y), grey.cols, &sum, &sum_of_squares);
  const double count = static_cast<double>(grey.total());
  GreyStatistics statistics;
  statistics.mean = static_cast<double>(sum) / count;
  // Mean of the squared deviations = (n sum g^2 - (sum g)^2) / n^2; the numerator is exact in
  // 128 bits, so that nothing cancels.
  const auto numerator = static_cast<unsigned __int128>(grey.total()) * sum_of_squares -
                         static_cast<unsigned __int128>(sum) * sum;
  statistics.variance = static_cast<double>(numerator) / (count * count);
  return statistics;
}

}  // namespace arfm_vo
