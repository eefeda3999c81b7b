// The kernels of the fast path, compiled once for each instruction set. It includes no header with
// inline functions, so that no code for a better CPU can leak into the rest of the program.
#include "surf_kernels.h"

namespace arfm_vo {
namespace {

constexpr int kLanes = 8;
typedef float Floats __attribute__((vector_size(32)));
typedef int32_t Ints __attribute__((vector_size(32)));
typedef uint32_t Words __attribute__((vector_size(32)));
typedef int64_t Longs __attribute__((vector_size(32)));

template <class V, class T>
inline V Load(const T* from) {
  V vector;
  __builtin_memcpy(&vector, from, sizeof(vector));
  return vector;
}
template <class V, class T>
inline void Store(const V& vector, T* to) {
  __builtin_memcpy(to, &vector, sizeof(vector));
}
inline Floats Broadcast(float value) { return value - Floats{}; }
inline Floats ToFloats(const Words& words) { return __builtin_convertvector((Ints)words, Floats); }

/// Differences of rows that the three second derivatives share along a row: what is left to do for
/// a pixel is a few sums along it.
struct RowDifferences {
  uint32_t* xx;
  uint32_t* yy;
  uint32_t* xy;
};

inline void SubtractRows(const IntegralView& integral, int y, int size, const RowDifferences& out) {
  const int lobe = size / 3, half = size / 2, side = lobe - 1, middle = lobe / 2;
  const auto row = [&](int at) {
    return integral.sums + static_cast<int64_t>(at) * integral.stride;
  };
  const uint32_t *x_top = row(y - side), *x_bottom = row(y + side + 1);
  const uint32_t *y_0 = row(y - half), *y_1 = row(y - middle), *y_2 = row(y + middle + 1),
                 *y_3 = row(y + half + 1);
  const uint32_t *d_0 = row(y - lobe), *d_1 = row(y), *d_2 = row(y + 1), *d_3 = row(y + lobe + 1);
  for (int x = 0; x <= integral.cols; x += kLanes) {
    const auto at = [x](const uint32_t* from) { return Load<Words>(from + x); };
    Store(at(x_bottom) - at(x_top), out.xx + x);
    const Words inner = at(y_2) - at(y_1);
    Store(at(y_3) - at(y_0) - (inner + inner + inner), out.yy + x);
    Store(at(d_1) - at(d_0) - (at(d_3) - at(d_2)), out.xy + x);
  }
}

void ComputeDeterminants(const IntegralView& integral, int y, int size, uint32_t* scratch,
                         float* out) {
  const int lobe = size / 3, half = size / 2, side = lobe - 1, middle = lobe / 2;
  const int begin = half, end = integral.cols - half;
  const int width = integral.cols + kKernelReadAhead;
  if (y < half || y + half >= integral.rows || begin >= end) {
    for (int x = 0; x < integral.cols; ++x) out[x] = 0;
    return;
  }
  const int scratch_stride = integral.cols + 1 + kKernelReadAhead;
  const RowDifferences rows = {scratch, scratch + scratch_stride, scratch + 2 * scratch_stride};
  SubtractRows(integral, y, size, rows);
  const Floats inverse_area = Broadcast(1.0f / static_cast<float>(size * size));
  const Floats share = Broadcast(0.81f);
  for (int x = begin; x < end; x += kLanes) {
    const auto xx_at = [&](int offset) { return Load<Words>(rows.xx + x + offset); };
    const auto yy_at = [&](int offset) { return Load<Words>(rows.yy + x + offset); };
    const auto xy_at = [&](int offset) { return Load<Words>(rows.xy + x + offset); };
    const Words inner = xx_at(middle + 1) - xx_at(-middle);
    const Words sum_xx = xx_at(half + 1) - xx_at(-half) - (inner + inner + inner);
    const Words sum_yy = yy_at(side + 1) - yy_at(-side);
    const Words sum_xy = xy_at(0) - xy_at(-lobe) - (xy_at(lobe + 1) - xy_at(1));
    const Floats xx = ToFloats(sum_xx) * inverse_area;
    const Floats yy = ToFloats(sum_yy) * inverse_area;
    const Floats xy = ToFloats(sum_xy) * inverse_area;
    Store(xx * yy - (share * xy) * xy, out + x);
  }
  for (int x = 0; x < begin; ++x) out[x] = 0;
  for (int x = end; x < width - kLanes; ++x) out[x] = 0;
}

inline bool IsAny(const Ints& mask) {
  const Longs pairs = (Longs)mask;
  return (pairs[0] | pairs[1] | pairs[2] | pairs[3]) != 0;
}

inline Ints IsNotBelow(const Floats& centre, const float* const rows[3], int x) {
  Ints result = ~Ints{};
  for (int row = 0; row < 3; ++row) {
    for (int dx = -1; dx <= 1; ++dx) result &= centre >= Load<Floats>(rows[row] + x + dx);
  }
  return result;
}

int FindPeaks(const float* const rows[9], int begin, int end, float threshold, int32_t* columns) {
  int num = 0;
  const Floats least = Broadcast(threshold);
  for (int x = begin; x < end; x += kLanes) {
    const Floats centre = Load<Floats>(rows[4] + x);
    Ints is_peak = centre > least;
    if (!IsAny(is_peak)) continue;
    is_peak &= IsNotBelow(centre, rows + 3, x);
    if (!IsAny(is_peak)) continue;
    is_peak &= IsNotBelow(centre, rows, x) & IsNotBelow(centre, rows + 6, x);
    if (!IsAny(is_peak)) continue;
    for (int lane = 0; lane < kLanes; ++lane) {
      if (is_peak[lane] && x + lane < end) columns[num++] = x + lane;
    }
  }
  return num;
}

/// The largest whole number that is not greater.
inline Ints Floor(const Floats& values) {
  const Ints truncated = __builtin_convertvector(values, Ints);
  return truncated + (__builtin_convertvector(truncated, Floats) > values);  // true is -1
}

inline Ints BroadcastInt(int32_t value) { return value - Ints{}; }
/// `mask` is all ones where to take `yes`.
inline Floats Choose(const Ints& mask, const Floats& yes, const Floats& no) {
  return (Floats)((mask & (Ints)yes) | (~mask & (Ints)no));
}
inline Ints Clamp(const Ints& values, int low, int high) {
  const Ints least = BroadcastInt(low), most = BroadcastInt(high);
  const Ints raised = values < least ? least : values;
  return raised > most ? most : raised;
}

void PlaceSamples(const IntegralView& integral, const SampleGrid& grid, const float* u,
                  const float* v, int num, int32_t* offsets) {
  const Floats x = Broadcast(grid.x), y = Broadcast(grid.y), step = Broadcast(grid.step);
  const Floats cosine = Broadcast(grid.cosine), sine = Broadcast(grid.sine), one = Broadcast(1);
  for (int i = 0; i < num; i += kLanes) {
    const Floats along = Load<Floats>(u + i), across = Load<Floats>(v + i);
    const Ints column = Clamp(Floor(x + step * (cosine * along - sine * across) + one), grid.half,
                              integral.cols - grid.half);
    const Ints row = Clamp(Floor(y + step * (sine * along + cosine * across) + one), grid.half,
                           integral.rows - grid.half);
    Store(row * integral.stride + column, offsets + i);
  }
}

void FindBins(const int32_t* dx, const int32_t* dy, int num, int32_t* bins) {
  const Ints sign = BroadcastInt(INT32_MIN);
  const Ints last = BroadcastInt(kOrientationBins - 1);
  const auto bin_at = [](float turns) { return Broadcast(turns * kOrientationBins); };
  for (int i = 0; i < num; i += kLanes) {
    const Ints whole_x = Load<Ints>(dx + i), whole_y = Load<Ints>(dy + i);
    const Floats x = (Floats)((Ints) __builtin_convertvector(whole_x, Floats) & ~sign);
    const Floats y = (Floats)((Ints) __builtin_convertvector(whole_y, Floats) & ~sign);
    const Ints is_steep = y > x;
    const Floats larger = Choose(is_steep, y, x), smaller = Choose(is_steep, x, y);
    const Floats t = smaller / larger, t2 = t * t;  // the direction of no response does not count
    const Floats arc =
        t * (0.9998660f +
             t2 * (-0.3302995f + t2 * (0.1801410f + t2 * (-0.0851330f + t2 * 0.0208351f))));
    Floats bin = arc * kBinsPerRadian;
    bin = Choose(is_steep, bin_at(0.25f) - bin, bin);
    bin = Choose(whole_x < 0, bin_at(0.5f) - bin, bin);
    bin = Choose(whole_y < 0, bin_at(1) - bin, bin);
    const Ints whole = __builtin_convertvector(Choose(larger > 0, bin, Floats{}), Ints);
    Store(whole > last ? last : whole, bins + i);
  }
}

/// Weighted sums of turned responses over the rows of a row of regions, [4 parts][stride].
inline void SumRows(const SampleGrid& grid, const int32_t* haar_dx, const int32_t* haar_dy,
                    const float* weights, int stride, float* columns) {
  const Floats cosine = Broadcast(grid.cosine), sine = Broadcast(grid.sine);
  for (int col = 0; col < stride; col += kLanes) {
    Floats sums[4] = {};
    for (int row = 0; row < kRegionWidth; ++row) {
      const int at = row * stride + col;
      const Floats x = __builtin_convertvector(Load<Ints>(haar_dx + at), Floats);
      const Floats y = __builtin_convertvector(Load<Ints>(haar_dy + at), Floats);
      const Floats weight = Broadcast(weights[row]);
      const Floats dx = cosine * x + sine * y;
      const Floats dy = cosine * y - sine * x;
      sums[0] += weight * dx;
      sums[1] += weight * dy;
      sums[2] += weight * (dx < 0 ? -dx : dx);
      sums[3] += weight * (dy < 0 ? -dy : dy);
    }
    for (int part = 0; part < 4; ++part) Store(sums[part], columns + part * stride + col);
  }
}

void SumRegions(const SampleGrid& grid, const int32_t* haar_dx, const int32_t* haar_dy,
                const RegionSamples& samples, float* descriptor) {
  float columns[4 * kMaxSampleStride];
  for (int i = 0; i < 4; ++i) {
    const int first = samples.spacing * i * samples.stride;
    SumRows(grid, haar_dx + first, haar_dy + first, samples.weights[i], samples.stride, columns);
    for (int j = 0; j < 4; ++j) {
      for (int part = 0; part < 4; ++part) {
        const float* column = columns + part * samples.stride + samples.spacing * j;
        float sum = 0;
        for (int k = 0; k < kRegionWidth; ++k) sum += samples.weights[j][k] * column[k];
        *descriptor++ = sum;
      }
    }
  }
}

constexpr SurfKernels kKernels = {&ComputeDeterminants, &FindPeaks, &PlaceSamples, &FindBins,
                                  &SumRegions};

}  // namespace
}  // namespace arfm_vo
