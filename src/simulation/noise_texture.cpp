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

using Pixels = Eigen::ArrayXXf;  ///< (x, y)

/// Smooths with [1 2 1]/4 along x, wrapping around.
Pixels SmoothRows(const Pixels& in) {
  const Eigen::Index last = in.rows() - 1;
  Pixels before(in.rows(), in.cols()), after(in.rows(), in.cols());
  before << in.bottomRows(1), in.topRows(last);
  after << in.bottomRows(last), in.topRows(1);
  return 0.25f * (before + 2 * in + after);
}

Pixels Smooth(const Pixels& in) { return SmoothRows(SmoothRows(in).transpose()).transpose(); }

/// Octaves of smoothed white noise from wavelength 16 texels down to 2, each as high as the others.
Pixels MakeOctaves(int size_log2, uint32_t seed) {
  Pixels sum = Pixels::Zero(1 << (size_log2 - 4), 1 << (size_log2 - 4));
  for (int octave = 3; octave >= 0; --octave) {
    const int size = 1 << (size_log2 - octave);
    const auto white = [&](Eigen::Index x, Eigen::Index y) {
      return static_cast<float>(HashUnit(HashCell(y * size + x, octave, seed)) - 0.5);
    };
    const auto twice = [&](Eigen::Index x, Eigen::Index y) { return sum(x / 2, y / 2); };
    sum = Smooth(Pixels::NullaryExpr(size, size, twice)) +
          Smooth(Pixels::NullaryExpr(size, size, white));
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
      float& pixel = pixels(i & (size - 1), j & (size - 1));
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
  const Eigen::ArrayXXd centred = pixels.cast<double>() - pixels.cast<double>().mean();
  pixels = (centred / std::sqrt(centred.square().mean())).cast<float>();
}

Pixels Halve(const Pixels& in) {
  const auto mean = [&](Eigen::Index x, Eigen::Index y) {
    return 0.25f * (in(2 * x, 2 * y) + in(2 * x + 1, 2 * y) + in(2 * x, 2 * y + 1) +
                    in(2 * x + 1, 2 * y + 1));
  };
  return Pixels::NullaryExpr(in.rows() / 2, in.cols() / 2, mean);
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
  for (int i = 0; i < size_; ++i) place_.push_back(SpreadBits(i));
  for (int level = 0; level < kNumLevels; ++level) {
    if (level > 0) pixels = Halve(pixels);
    std::vector<float>& folded = levels_.emplace_back(pixels.size());
    for (Eigen::Index j = 0; j < pixels.cols(); ++j)
      for (Eigen::Index i = 0; i < pixels.rows(); ++i)
        folded[place_[i] + 2 * place_[j]] = pixels(i, j);
  }
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
