#pragma once

#include <cstdint>
#include <random>

namespace arfm_vo {

/// The one source of randomness: always seeded, so that the same input gives the same bytes.
using RandomEngine = std::mt19937;

/// An integer in [0, bound), the same on every platform (std::uniform_int_distribution is not).
inline uint32_t RandomBelow(uint32_t bound, RandomEngine& engine) {
  return static_cast<uint32_t>((static_cast<uint64_t>(engine()) * bound) >> 32);
}

/// A number in [0, 1), the same on every platform.
inline double RandomUnit(RandomEngine& engine) {
  return static_cast<double>(engine()) / 4294967296.0;
}

/// A number of mean 0 and variance 1, about normal.
inline double RandomDeviate(RandomEngine& engine) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += RandomUnit(engine);
  return sum;
}

}  // namespace arfm_vo
