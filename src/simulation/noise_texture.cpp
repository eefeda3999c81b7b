#include "arfm_vo/simulation/noise_texture.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/simulation/hash_noise.h"

namespace arfm_vo {
namespace {

constexpr int kNumLevels = 7;
constexpr double kMaxLod = 5.5;  ///< beyond it the pattern has averaged out
constexpr int kMaxProbes = 12;
constexpr double kScales[kNumLevels] = {1, 1. / 2, 1. / 4, 1. / 8, 1. / 16, 1. / 32, 1. / 64};

using Pixels = std::vector<float>;

/// Smooths with [1 2 1]/4 along both axes, wrapping around.
Pixels Smooth(const Pixels& in, int size) {
  const int mask = size - 1;
  Pixels rows(in.size()), out(in.size());
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float* row = &in[y * size];
      rows[y * size + x] = 0.25f * (row[(x - 1) & mask] + 2 * row[x] + row[(x + 1) & mask]);
    }
  }
  for (int y = 0; y < size; ++y) {
    const float *above = &rows[((y - 1) & mask) * size], *here = &rows[y * size],
                *below = &rows[((y + 1) & mask) * size];
    for (int x = 0; x < size; ++x) out[y * size + x] = 0.25f * (above[x] + 2 * here[x] + below[x]);
  }
  return out;
}

/// Doubles the size by repeating, then smoothing.
Pixels Upsample(const Pixels& in, int size) {
  Pixels out(in.size() * 4);
  for (int y = 0; y < 2 * size; ++y) {
    for (int x = 0; x < 2 * size; ++x) out[y * 2 * size + x] = in[(y / 2) * size + x / 2];
  }
  return Smooth(out, 2 * size);
}

/// Octaves of smoothed white noise from wavelength 16 texels down to 2, each as high as the others.
Pixels MakeOctaves(int size_log2, uint32_t seed) {
  Pixels sum;
  for (int octave = 3; octave >= 0; --octave) {
    const int size = 1 << (size_log2 - octave);
    if (!sum.empty()) sum = Upsample(sum, size / 2);
    Pixels white(size * size);
    for (int i = 0; i < size * size; ++i) {
      white[i] = HashUnit(HashCell(i, octave, seed)) - 0.5;
    }
    if (sum.empty()) sum.assign(white.size(), 0);
    white = Smooth(white, size);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += white[i];
  }
  return sum;
}

/// One pebble: a disc, brighter on the side of the sun, with a thin dark rim away from it.
void StampPebble(double x, double y, double radius, double tone, int size, Pixels& pixels) {
  const int reach = static_cast<int>(std::ceil(radius * 1.4)) + 1;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const int i = static_cast<int>(x) + dx, j = static_cast<int>(y) + dy;
      const double px = (i + 0.5 - x) / radius, py = (j + 0.5 - y) / radius;
      const double inside = 1 - SmoothStep(1 - 0.5 / radius, 1 + 0.5 / radius, std::hypot(px, py));
      const double shade = 1 - SmoothStep(0.8, 1.25, std::hypot(px - 0.3, py - 0.2));
      float& pixel = pixels[(j & (size - 1)) * size + (i & (size - 1))];
      pixel -= 0.5 * shade * (1 - inside);
      pixel += inside * (tone - 0.6 * (px + 0.6 * py) - pixel);
    }
  }
}

void StampPebbles(double per_texel, int size, uint32_t seed, Pixels& pixels) {
  const int num_pebbles = static_cast<int>(per_texel * size * size);
  for (int i = 0; i < num_pebbles; ++i) {
    const auto unit = [&](int what) { return HashUnit(HashCell(i, what, seed)); };
    const double radius = 1.0 / std::sqrt(1 - 0.96 * unit(0));  // 1..5 texels, many small ones
    StampPebble(unit(1) * size, unit(2) * size, radius, 0.9 * unit(3) - 0.5, size, pixels);
  }
}

void Normalize(Pixels& pixels) {
  double sum = 0, squares = 0;
  for (const float pixel : pixels) sum += pixel;
  const double mean = sum / pixels.size();
  for (const float pixel : pixels) squares += (pixel - mean) * (pixel - mean);
  const double scale = 1 / std::sqrt(squares / pixels.size());
  for (float& pixel : pixels) pixel = scale * (pixel - mean);
}

Pixels Halve(const Pixels& in, int size) {
  const int half = size / 2;
  Pixels out(half * half);
  for (int y = 0; y < half; ++y) {
    for (int x = 0; x < half; ++x) {
      const float *above = &in[2 * y * size + 2 * x], *below = above + size;
      out[y * half + x] = 0.25f * (above[0] + above[1] + below[0] + below[1]);
    }
  }
  return out;
}

/// The bits of x apart, with zeros between them.
uint32_t SpreadBits(uint32_t x) {
  uint32_t spread = 0;
  for (int bit = 0; bit < 16; ++bit) spread |= (x & (1u << bit)) << bit;
  return spread;
}

}  // namespace

NoiseTexture::NoiseTexture(int size_log2, double pebbles_per_texel, uint32_t seed)
    : size_(1 << size_log2) {
  Pixels pixels = MakeOctaves(size_log2, seed);
  StampPebbles(pebbles_per_texel, size_, HashWord(seed), pixels);
  Normalize(pixels);
  levels_.push_back(std::move(pixels));
  for (int level = 1; level < kNumLevels; ++level) {
    levels_.push_back(Halve(levels_.back(), size_ >> (level - 1)));
  }
  for (int i = 0; i < size_; ++i) place_.push_back(SpreadBits(i));
  for (int level = 0; level < kNumLevels; ++level)
    levels_[level] = Fold(levels_[level], size_ >> level);
}

std::vector<float> NoiseTexture::Fold(const std::vector<float>& rows, int size) const {
  std::vector<float> folded(rows.size());
  for (int j = 0; j < size; ++j) {
    for (int i = 0; i < size; ++i) folded[place_[i] + 2 * place_[j]] = rows[j * size + i];
  }
  return folded;
}

inline double NoiseTexture::SampleLevel(double x, double y, int level) const {
  const int mask = (size_ >> level) - 1;
  const double lx = x * kScales[level] - 0.5, ly = y * kScales[level] - 0.5;
  const int i = FloorToInt(lx), j = FloorToInt(ly);
  const float u = static_cast<float>(lx - i), v = static_cast<float>(ly - j);
  const uint32_t i0 = place_[i & mask], i1 = place_[(i + 1) & mask];
  const float* above = &levels_[level][2 * place_[j & mask]];
  const float* below = &levels_[level][2 * place_[(j + 1) & mask]];
  const float top = above[i0] + u * (above[i1] - above[i0]);
  const float bottom = below[i0] + u * (below[i1] - below[i0]);
  return top + v * (bottom - top);
}

double NoiseTexture::Sample(double x, double y, double lod) const {
  const int level = std::min(static_cast<int>(lod), kNumLevels - 2);
  const double fine = SampleLevel(x, y, level);
  if (lod <= 0) return fine;
  return fine + (lod - level) * (SampleLevel(x, y, level + 1) - fine);
}

TextureProbes::TextureProbes(const TextureFootprint& footprint) : center(footprint.center) {
  const Eigen::Vector2d &a = footprint.along_u, &b = footprint.along_v;
  longest = a.squaredNorm() > b.squaredNorm() ? a : b;
  major = std::max(longest.norm(), 1e-9);
  const double area = std::abs(a.x() * b.y() - a.y() * b.x());
  minor = std::max(area / major, major / kMaxProbes);
}

double NoiseTexture::SampleMean(const TextureProbes& probes, double texel) const {
  const double lod = std::log2(std::max(probes.minor / texel, 1.0));
  if (lod >= kMaxLod) return 0;
  const double spacing = std::max(probes.minor, texel);
  const int num_probes = std::max(1, static_cast<int>(std::ceil(probes.major / spacing - 0.25)));
  const Eigen::Vector2d step = probes.longest / (num_probes * texel);
  Eigen::Vector2d probe = probes.center / texel - 0.5 * (num_probes - 1) * step;
  double sum = 0;
  for (int i = 0; i < num_probes; ++i, probe += step) sum += Sample(probe.x(), probe.y(), lod);
  return std::min(1.0, 2 * (kMaxLod - lod)) * sum / num_probes;  // fades out, no seam
}

}  // namespace arfm_vo
