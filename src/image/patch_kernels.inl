// The kernels of patches, compiled once for each instruction set (vectors.h).
#include "arfm_vo/base/vectors.h"
#include "patch_kernels.h"

namespace arfm_vo {
namespace {

typedef uint8_t Bytes __attribute__((vector_size(8)));

inline Floats LoadPixels(const uint8_t* from) {
  Bytes bytes;
  __builtin_memcpy(&bytes, from, sizeof(bytes));
  return __builtin_convertvector(__builtin_convertvector(bytes, Ints), Floats);
}
inline float Sum(const Floats& v) {
  return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
}

/// Weights of four neighbouring pixels for a place `t` in [0, 1) past the second: the cubic through
/// the four (Lagrange). Its phase error, which is what shifts an alignment, is a third to a fifth
/// of that of cubic convolution (Keys 1981), and that one's is no better than linear
/// interpolation's.
inline void Weigh(const Floats& t, Floats weights[4]) {
  const Floats a = t + 1, b = t - 1, c = t - 2;
  const Floats bc = b * c, at = a * t;
  weights[0] = t * bc * (-1.0f / 6);
  weights[1] = a * bc * 0.5f;
  weights[2] = at * c * -0.5f;
  weights[3] = at * b * (1.0f / 6);
}

/// The whole part of a positive number.
inline int Floor(float value) { return static_cast<int>(value); }

/// Square of kSize x kSize samples 1 px apart. Rows that are no multiple of a vector end with a
/// vector that overlaps the one before.
template <int kSize>
bool Interpolate(const GreyView& grey, float left, float top, float* samples) {
  static_assert(kSize > kLanes && kSize <= 2 * kLanes - 2, "two vectors a row");
  constexpr int kInput = kSize + 3, kStride = 2 * kLanes + 4;
  if (!(left >= 1 && top >= 1 && left < static_cast<float>(grey.cols - kSize - 1) &&
        top < static_cast<float>(grey.rows - kSize - 1))) {
    return false;
  }
  const int x = Floor(left), y = Floor(top);
  Floats wx[4], wy[4];
  Weigh(Broadcast(left - static_cast<float>(x)), wx);
  Weigh(Broadcast(top - static_cast<float>(y)), wy);
  const uint8_t* const corner = grey.pixels + (y - 1) * grey.step + x - 1;
  float column_sums[kSize * kStride];
  constexpr int kBlocks = (kInput + kLanes - 1) / kLanes;
  for (int block = 0; block < kBlocks; ++block) {
    const int c = block + 1 < kBlocks ? block * kLanes : kInput - kLanes;
    const uint8_t* from = corner + c;
    Floats pixels[4];
    for (int k = 1; k < 4; ++k, from += grey.step) pixels[k] = LoadPixels(from);
    for (int r = 0; r < kSize; ++r, from += grey.step) {
      for (int k = 0; k < 3; ++k) pixels[k] = pixels[k + 1];
      pixels[3] = LoadPixels(from);
      Store((wy[0] * pixels[0] + wy[1] * pixels[1]) + (wy[2] * pixels[2] + wy[3] * pixels[3]),
            column_sums + r * kStride + c);
    }
  }
  for (int r = 0; r < kSize; ++r) {
    for (int c = 0; c <= kSize - kLanes; c += kSize - kLanes) {
      const float* from = column_sums + r * kStride + c;
      Store((wx[0] * Load(from) + wx[1] * Load(from + 1)) +
                (wx[2] * Load(from + 2) + wx[3] * Load(from + 3)),
            samples + r * kSize + c);
    }
  }
  return true;
}

/// Samples at eight places, whose surroundings lie in the image.
inline Floats InterpolateEach(const GreyView& grey, const Floats& x, const Floats& y) {
  const Ints whole_x = __builtin_convertvector(x, Ints), whole_y = __builtin_convertvector(y, Ints);
  Floats wx[4], wy[4];
  Weigh(x - __builtin_convertvector(whole_x, Floats), wx);
  Weigh(y - __builtin_convertvector(whole_y, Floats), wy);
  const Ints offsets = (whole_y - 1) * static_cast<int32_t>(grey.step) + whole_x - 1;
  Floats sum = {};
  const uint8_t* row = grey.pixels;
  for (int k = 0; k < 4; ++k, row += grey.step) {
    uint32_t fours[kLanes];  // pixels side by side
    for (int i = 0; i < kLanes; ++i) __builtin_memcpy(&fours[i], row + offsets[i], 4);
    Words words;
    __builtin_memcpy(&words, fours, sizeof(words));
    const Floats along = (wx[0] * ToFloats(words & 255) + wx[1] * ToFloats(words >> 8 & 255)) +
                         (wx[2] * ToFloats(words >> 16 & 255) + wx[3] * ToFloats(words >> 24));
    sum += wy[k] * along;
  }
  return sum;
}

bool InterpolateWarped(const GreyView& grey, float x, float y, const float abcd[4],
                       float* samples) {
  constexpr float kHalf = 0.5f * (kBorderedSize - 1);
  constexpr float kRounding = 1e-3f;
  for (float column = -kHalf; column <= kHalf; column += 2 * kHalf) {
    for (float row = -kHalf; row <= kHalf; row += 2 * kHalf) {
      const float at_x = x + abcd[0] * column + abcd[1] * row;
      const float at_y = y + abcd[2] * column + abcd[3] * row;
      if (!(at_x >= 1 + kRounding && at_y >= 1 + kRounding &&
            at_x < static_cast<float>(grey.cols - 2) - kRounding &&
            at_y < static_cast<float>(grey.rows - 2) - kRounding)) {
        return false;
      }
    }
  }
  const Floats lanes = {0, 1, 2, 3, 4, 5, 6, 7};
  for (int r = 0; r < kBorderedSize; ++r) {
    const float row = static_cast<float>(r) - kHalf;
    for (int c = 0; c <= kBorderedSize - kLanes; c += kBorderedSize - kLanes) {
      const Floats columns = lanes + (static_cast<float>(c) - kHalf);
      Store(InterpolateEach(grey, (x + abcd[1] * row) + abcd[0] * columns,
                            (y + abcd[3] * row) + abcd[2] * columns),
            samples + r * kBorderedSize + c);
    }
  }
  return true;
}

float Dot(const float* a, const float* b) {
  Floats sums[2] = {};  // two sums hide the latency of the additions
  for (int i = 0; i < kPatchSamples; i += 2 * kLanes) {
    sums[0] += Load(a + i) * Load(b + i);
    sums[1] += Load(a + i + kLanes) * Load(b + i + kLanes);
  }
  return Sum(sums[0] + sums[1]);
}

void DotThree(const float* a, const float* b, const float* c, const float* samples, float sums[3]) {
  Floats all[3] = {};
  for (int i = 0; i < kPatchSamples; i += kLanes) {
    const Floats sample = Load(samples + i);
    all[0] += Load(a + i) * sample;
    all[1] += Load(b + i) * sample;
    all[2] += Load(c + i) * sample;
  }
  for (int k = 0; k < 3; ++k) sums[k] = Sum(all[k]);
}

float WeightedVariance(const float* weights, const float* samples) {
  const Floats mean = Broadcast(Dot(weights, samples));
  Floats sum = {};
  for (int i = 0; i < kPatchSamples; i += kLanes) {
    const Floats deviation = Load(samples + i) - mean;
    sum += Load(weights + i) * deviation * deviation;
  }
  return Sum(sum);
}

/// Central differences inside the border.
void Differentiate(const float* bordered, const PatchParts& parts) {
  for (int r = 0; r < kPatchSize; ++r) {
    for (int c = 0; c <= kPatchSize - kLanes; c += kPatchSize - kLanes) {
      const float* at = bordered + (r + 1) * kBorderedSize + c + 1;
      const int to = r * kPatchSize + c;
      Store(Load(at), parts.values + to);
      Store(0.5f * (Load(at + 1) - Load(at - 1)), parts.gradient_x + to);
      Store(0.5f * (Load(at + kBorderedSize) - Load(at - kBorderedSize)), parts.gradient_y + to);
    }
  }
}

/// Sums of w a^2, w a b, w b^2 (w is in `weighted`) and of the same with w^2.
void SumGradients(const PatchParts& weighted, const float* a, const float* b, PatchSums& sums) {
  const float *wa = weighted.gradient_x, *wb = weighted.gradient_y;
  sums.hessian[0] = Dot(wa, a);
  sums.hessian[1] = Dot(wa, b);
  sums.hessian[2] = Dot(wb, b);
  sums.squared_gradients[0] = Dot(wa, wa);
  sums.squared_gradients[1] = Dot(wa, wb);
  sums.squared_gradients[2] = Dot(wb, wb);
}

PatchSums Prepare(const float* bordered, const float* weights, const PatchParts& parts) {
  PatchSums sums;
  Differentiate(bordered, parts);
  const Floats mean = Broadcast(Dot(weights, parts.values));
  float centred[kPatchSamples];
  for (int i = 0; i < kPatchSamples; i += kLanes) {
    const Floats value = Load(parts.values + i) - mean;
    Store(value, centred + i);
    Store(Load(weights + i) * value, parts.values + i);
    Store(Load(parts.gradient_x + i), parts.raw_gradient_x + i);
  }
  sums.squared_values = Dot(parts.values, centred);
  float orthogonal[2][kPatchSamples];
  float* const gradients[2] = {parts.gradient_x, parts.gradient_y};
  for (int k = 0; k < 2; ++k) {
    const bool has_contrast = sums.squared_values > 0;
    const Floats constant = Broadcast(has_contrast ? Dot(weights, gradients[k]) : 0);
    const Floats share =
        Broadcast(has_contrast ? Dot(parts.values, gradients[k]) / sums.squared_values : 0);
    for (int i = 0; i < kPatchSamples; i += kLanes) {
      const Floats gradient = Load(gradients[k] + i) - constant - share * Load(centred + i);
      Store(gradient, orthogonal[k] + i);
      Store(Load(weights + i) * gradient, gradients[k] + i);
    }
  }
  SumGradients(parts, orthogonal[0], orthogonal[1], sums);
  return sums;
}

constexpr PatchKernels kKernels = {&Interpolate<kPatchSize>,
                                   &Interpolate<kBorderedSize>,
                                   &InterpolateWarped,
                                   &Prepare,
                                   &Dot,
                                   &DotThree,
                                   &WeightedVariance};

}  // namespace
}  // namespace arfm_vo
