#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace arfm_vo {

/// A well mixed 32 bit word of any word (the finaliser of MurmurHash3, Appleby 2011).
inline uint32_t HashWord(uint32_t word) {
  word ^= word >> 16;
  word *= 0x85ebca6bu;
  word ^= word >> 13;
  word *= 0xc2b2ae35u;
  return word ^ (word >> 16);
}

/// A well mixed word of a lattice point and a seed: randomness that needs no order of drawing, so
/// that every pixel, cell or rock can be made by itself, on any thread.
inline uint32_t HashCell(int i, int j, uint32_t seed) {
  return HashWord(static_cast<uint32_t>(i) +
                  0x9e3779b9u * HashWord(static_cast<uint32_t>(j) ^ HashWord(seed)));
}

/// A number in [0, 1) of a word.
inline double HashUnit(uint32_t word) { return HashWord(word) * (1.0 / 4294967296.0); }

/// A standard normal number of a word (Box and Muller 1958).
inline double HashGaussian(uint32_t word) {
  const double radius = std::sqrt(-2 * std::log(1 - HashUnit(word)));
  return radius * std::cos(2 * M_PI * HashUnit(word ^ 0x68bc21ebu));
}

/// The largest integer not above x; a few times faster than std::floor without SSE 4.1.
inline int FloorToInt(double x) {
  const int truncated = static_cast<int>(x);
  return truncated - (x < truncated);
}

/// Gradient noise (Perlin 1985) with one lattice point a unit: smooth, mean 0, standard
/// deviation about 0.2, within [-1, 1].
inline double GradientNoise(double x, double y, uint32_t seed) {
  const int i = FloorToInt(x), j = FloorToInt(y);
  const auto corner = [&](int di, int dj) {
    // The gradient's components, each uniform in [-1, 1], from the halves of the word.
    const uint32_t word = HashCell(i + di, j + dj, seed);
    const double gradient_x = (word & 0xffffu) * (2 / 65535.0) - 1;
    const double gradient_y = (word >> 16) * (2 / 65535.0) - 1;
    return gradient_x * (x - i - di) + gradient_y * (y - j - dj);
  };
  const auto fade = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
  const double u = fade(x - i), v = fade(y - j);
  const double low = corner(0, 0) + u * (corner(1, 0) - corner(0, 0));
  const double high = corner(0, 1) + u * (corner(1, 1) - corner(0, 1));
  return low + v * (high - low);
}

/// `num_octaves` octaves of gradient noise, the first with one lattice point a unit, each next one
/// twice as fine and `persistence` times as high.
inline double FractalNoise(double x, double y, int num_octaves, double persistence, uint32_t seed) {
  double sum = 0, height = 1;
  for (int octave = 0; octave < num_octaves; ++octave) {
    sum += height * GradientNoise(x, y, seed + octave);
    x = 2 * x + 0.37;  // shifted, so that the lattices' zeros do not fall on each other
    y = 2 * y + 0.61;
    height *= persistence;
  }
  return sum;
}

/// 0 below `low`, 1 above `high`, smooth in between.
inline double SmoothStep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace arfm_vo
