#include "arfm_vo/pose/false_alarms.h"

#include <math.h>  // lgamma_r is POSIX

#include <algorithm>
#include <cmath>

#include "arfm_vo/pose/pose_estimator.h"

namespace arfm_vo {
namespace {

constexpr double kMaxFalseAlarms = 1e-4;  ///< of an image

double LogFactorial(int n) {
  int sign = 0;  // std::lgamma keeps it where other threads write as well
  return lgamma_r(n + 1, &sign);
}

double LogChoose(int n, int k) { return LogFactorial(n) - LogFactorial(k) - LogFactorial(n - k); }

}  // namespace

double LogFalseAlarms(int num_matches, int num_agreeing, double log_chance) {
  return LogChoose(num_matches, num_agreeing) + LogChoose(num_agreeing, kSamplePoints) +
         (num_agreeing - kSamplePoints) * log_chance;
}

int LeastAgreeing(int num_matches, int at_least) {
  int least = std::max(kSamplePoints + 1, at_least);
  while (least <= num_matches && LogFalseAlarms(num_matches, least) > std::log(kMaxFalseAlarms)) {
    ++least;
  }
  return least;
}

}  // namespace arfm_vo
