#pragma once

#include <cstdint>

namespace arfm_vo {
/// Vectors of 32 bytes for kernels that are compiled once for each instruction set. Nameless, so
/// that no code for a better CPU can leak into the rest of the program; it includes no header with
/// inline functions for the same reason.
namespace {

constexpr int kLanes = 8;
typedef float Floats __attribute__((vector_size(32)));
typedef int32_t Ints __attribute__((vector_size(32)));
typedef uint32_t Words __attribute__((vector_size(32)));
typedef double Doubles __attribute__((vector_size(32)));  ///< four lanes

template <class V = Floats, class T>
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
/// Of values below 2^31.
inline Floats ToFloats(const Words& words) { return __builtin_convertvector((Ints)words, Floats); }

}  // namespace
}  // namespace arfm_vo
