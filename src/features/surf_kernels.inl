// The kernels of the fast path, compiled once for each instruction set (vectors.h).
#include "arfm_vo/base/vectors.h"
#include "surf_kernels.h"

namespace arfm_vo {
namespace {

typedef int64_t Longs __attribute__((vector_size(32)));

/// Differences of rows that the three second derivatives share along a row: what is left to do for
/// a pixel is a few sums along it. Where every second pixel is wanted, first the values of even
/// columns, then those of odd ones, so that neighbours in memory are wanted together.
struct RowDifferences {
  uint32_t* xx;
  uint32_t* yy;
  uint32_t* xy;
  int half;  ///< values from the even columns to the odd ones
};

template <int kStep>
inline void StoreColumns(const Words (&columns)[kStep], int half, int x, uint32_t* row) {
  if constexpr (kStep == 1) {
    Store(columns[0], row + x);
  } else {
#ifdef __clang__
    const Words even = __builtin_shufflevector(columns[0], columns[1], 0, 2, 4, 6, 8, 10, 12, 14);
    const Words odd = __builtin_shufflevector(columns[0], columns[1], 1, 3, 5, 7, 9, 11, 13, 15);
#else  // g++ before 12 has no __builtin_shufflevector
    const Words evens = {0, 2, 4, 6, 8, 10, 12, 14}, odds = {1, 3, 5, 7, 9, 11, 13, 15};
    const Words even = __builtin_shuffle(columns[0], columns[1], evens);
    const Words odd = __builtin_shuffle(columns[0], columns[1], odds);
#endif
    Store(even, row + x / 2);
    Store(odd, row + half + x / 2);
  }
}

template <int kStep>
inline void SubtractRows(const IntegralView& integral, int y, int size, const RowDifferences& out) {
  const int lobe = size / 3, half = size / 2, side = lobe - 1, middle = lobe / 2;
  const auto row = [&](int at) {
    return integral.sums + static_cast<int64_t>(at) * integral.stride;
  };
  const uint32_t *x_top = row(y - side), *x_bottom = row(y + side + 1);
  const uint32_t *y_0 = row(y - half), *y_1 = row(y - middle), *y_2 = row(y + middle + 1),
                 *y_3 = row(y + half + 1);
  const uint32_t *d_0 = row(y - lobe), *d_1 = row(y), *d_2 = row(y + 1), *d_3 = row(y + lobe + 1);
  for (int x = 0; x <= integral.cols; x += kStep * kLanes) {
    Words xx[kStep], yy[kStep], xy[kStep];
    for (int i = 0; i < kStep; ++i) {
      const auto at = [&](const uint32_t* from) { return Load<Words>(from + x + i * kLanes); };
      xx[i] = at(x_bottom) - at(x_top);
      const Words inner = at(y_2) - at(y_1);
      yy[i] = at(y_3) - at(y_0) - (inner + inner + inner);
      xy[i] = at(d_1) - at(d_0) - (at(d_3) - at(d_2));
    }
    StoreColumns<kStep>(xx, out.half, x, out.xx);
    StoreColumns<kStep>(yy, out.half, x, out.yy);
    StoreColumns<kStep>(xy, out.half, x, out.xy);
  }
}

template <int kStep>
void ComputeDeterminantsEvery(const IntegralView& integral, int y, int size, uint32_t* scratch,
                              float* out) {
  const int lobe = size / 3, half = size / 2, side = lobe - 1, middle = lobe / 2;
  const int num = (integral.cols + kStep - 1) / kStep;
  const int begin = (half + kStep - 1) / kStep, end = (integral.cols - half + kStep - 1) / kStep;
  if (y < half || y + half >= integral.rows || begin >= end) {
    for (int i = 0; i < num; ++i) out[i] = 0;
    return;
  }
  const int scratch_stride = integral.cols + 1 + 2 * kKernelReadAhead;
  const RowDifferences rows = {scratch, scratch + scratch_stride, scratch + 2 * scratch_stride,
                               scratch_stride / 2};
  SubtractRows<kStep>(integral, y, size, rows);
  const auto column = [&](const uint32_t* row, int offset) {
    return kStep == 1 ? row + offset : row + (offset & 1) * rows.half + (offset >> 1);
  };
  const uint32_t *xx_0 = column(rows.xx, -half), *xx_1 = column(rows.xx, -middle),
                 *xx_2 = column(rows.xx, middle + 1), *xx_3 = column(rows.xx, half + 1);
  const uint32_t *yy_0 = column(rows.yy, -side), *yy_1 = column(rows.yy, side + 1);
  const uint32_t *xy_0 = column(rows.xy, -lobe), *xy_1 = column(rows.xy, 0),
                 *xy_2 = column(rows.xy, 1), *xy_3 = column(rows.xy, lobe + 1);
  const Floats inverse_area = Broadcast(1.0f / static_cast<float>(size * size));
  const Floats share = Broadcast(0.81f);
  for (int i = begin; i < end; i += kLanes) {
    const auto at = [i](const uint32_t* from) { return Load<Words>(from + i); };
    const Words inner = at(xx_2) - at(xx_1);
    const Words sum_xx = at(xx_3) - at(xx_0) - (inner + inner + inner);
    const Words sum_yy = at(yy_1) - at(yy_0);
    const Words sum_xy = at(xy_1) - at(xy_0) - (at(xy_3) - at(xy_2));
    const Floats xx = ToFloats(sum_xx) * inverse_area;
    const Floats yy = ToFloats(sum_yy) * inverse_area;
    const Floats xy = ToFloats(sum_xy) * inverse_area;
    Store(xx * yy - (share * xy) * xy, out + i);
  }
  for (int i = 0; i < begin; ++i) out[i] = 0;
  for (int i = end; i < num + kKernelReadAhead - kLanes; ++i) out[i] = 0;
}

void ComputeDeterminants(const IntegralView& integral, int y, int size, int step, uint32_t* scratch,
                         float* out) {
  if (step == 1) {
    ComputeDeterminantsEvery<1>(integral, y, size, scratch, out);
  } else {
    ComputeDeterminantsEvery<2>(integral, y, size, scratch, out);
  }
}

inline bool IsAny(const Ints& mask) {
  const Longs pairs = (Longs)mask;
  return (pairs[0] | pairs[1] | pairs[2] | pairs[3]) != 0;
}

inline Ints IsNotBelow(const Floats& centre, const float* const rows[3], int x) {
  Ints result = ~Ints{};
  for (int row = 0; row < 3; ++row) {
    for (int dx = -1; dx <= 1; ++dx) result &= centre >= Load(rows[row] + x + dx);
  }
  return result;
}

int FindPeaks(const float* const rows[9], int begin, int end, float threshold, int32_t* columns) {
  int num = 0;
  const Floats least = Broadcast(threshold);
  for (int x = begin; x < end; x += kLanes) {
    const auto at = [x](const float* row) { return Load(row + x); };
    const Floats centre = at(rows[4]);
    // Few get past the next neighbours, so that the branch is foreseen.
    Ints is_peak = (centre > least) & (centre >= at(rows[4] - 1)) & (centre >= at(rows[4] + 1)) &
                   (centre >= at(rows[3])) & (centre >= at(rows[5])) & (centre >= at(rows[1])) &
                   (centre >= at(rows[7]));
    if (!IsAny(is_peak)) continue;
    is_peak &= IsNotBelow(centre, rows, x) & IsNotBelow(centre, rows + 3, x) &
               IsNotBelow(centre, rows + 6, x);
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
    const Floats along = Load(u + i), across = Load(v + i);
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
