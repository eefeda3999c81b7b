#include "arfm_vo/image/grey_statistics.h"

#include <cstdint>
#include <opencv2/core.hpp>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

GreyStatistics ComputeGreyStatistics(const cv::Mat& grey) {
  Require(!grey.empty(), "grey statistics: the image is empty");
  Require(grey.type() == CV_8UC1, "grey statistics: the image must be 8 bit grey");
  // Whole numbers below 2^53.
  const auto sum = static_cast<uint64_t>(cv::sum(grey)[0]);
  uint64_t sum_of_squares = 0;
  for (int r = 0; r < grey.rows; ++r) {  // (cv::norm does not use vectors for it)
    const auto* const row = grey.ptr<uint8_t>(r);
    uint32_t of_row = 0;  // of up to 66,051 pixels
    for (int c = 0; c < grey.cols; ++c) of_row += row[c] * row[c];
    sum_of_squares += of_row;
  }
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
