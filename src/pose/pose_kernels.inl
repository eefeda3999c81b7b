// The kernels of pose refinement, compiled once for each instruction set (vectors.h).
#include "arfm_vo/base/vectors.h"
#include "pose_kernels.h"

namespace arfm_vo {
namespace {

/// Four points in the camera frame and the derivative of their projection
///   [p 0 c0; 0 q c1; p 0 c2].
struct CameraPoints {
  Doubles x[3];
  Doubles inverse_z;
  Doubles p, q, c[3];
  Doubles is_visible;  ///< 1 or 0

  CameraPoints(const PoseNumbers& pose, const PoseColumns& columns, int i) {
    const Doubles world[3] = {Load<Doubles>(columns.x_in_world[0] + i),
                              Load<Doubles>(columns.x_in_world[1] + i),
                              Load<Doubles>(columns.x_in_world[2] + i)};
    for (int k = 0; k < 3; ++k) {
      const double* row = pose.rotation + 3 * k;
      x[k] = (row[0] * world[0] + row[1] * world[1]) + (row[2] * world[2] + pose.translation[k]);
    }
    const Doubles one = Doubles{} + 1;
    is_visible = x[2] > pose.min_depth ? one : Doubles{};
    x[2] = x[2] > pose.min_depth ? x[2] : one;
    inverse_z = 1 / x[2];
    p = pose.fx * inverse_z;
    q = pose.fy * inverse_z;
    c[0] = -p * x[0] * inverse_z;
    c[1] = -q * x[1] * inverse_z;
    c[2] = -p * (x[0] - pose.baseline_m) * inverse_z;
  }

  /// Observed minus projected (u_left, v, u_right).
  void FindErrors(const PoseNumbers& pose, const PoseColumns& columns, int i,
                  Doubles errors[3]) const {
    const Doubles u = p * x[0] + pose.cx, v = q * x[1] + pose.cy;
    errors[0] = Load<Doubles>(columns.pixels[0] + i) - u;
    errors[1] = Load<Doubles>(columns.pixels[1] + i) - v;
    errors[2] = Load<Doubles>(columns.has_right + i) *
                (Load<Doubles>(columns.pixels[2] + i) - (u - p * pose.baseline_m));
  }
};

inline void LoadSymmetric(const double* const columns[6], int i, Doubles m[6]) {
  for (int k = 0; k < 6; ++k) m[k] = Load<Doubles>(columns[k] + i);
}

/// m v for a symmetric m.
inline void Multiply(const Doubles m[6], const Doubles v[3], Doubles product[3]) {
  product[0] = m[0] * v[0] + m[1] * v[1] + m[2] * v[2];
  product[1] = m[1] * v[0] + m[3] * v[1] + m[4] * v[2];
  product[2] = m[2] * v[0] + m[4] * v[1] + m[5] * v[2];
}

inline Doubles DotProduct(const Doubles a[3], const Doubles b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The inverse of a symmetric matrix, by its cofactors.
inline void Invert(const Doubles m[6], Doubles inverse[6]) {
  const Doubles cofactors[6] = {m[3] * m[5] - m[4] * m[4], m[2] * m[4] - m[1] * m[5],
                                m[1] * m[4] - m[2] * m[3], m[0] * m[5] - m[2] * m[2],
                                m[1] * m[2] - m[0] * m[4], m[0] * m[3] - m[1] * m[1]};
  const Doubles scale = 1 / (m[0] * cofactors[0] + m[1] * cofactors[1] + m[2] * cofactors[2]);
  for (int k = 0; k < 6; ++k) inverse[k] = scale * cofactors[k];
}

void Inform(const PoseNumbers& pose, const PoseColumns& columns) {
  for (int i = 0; i < columns.count; i += kPoseLanes) {
    const CameraPoints points(pose, columns, i);
    Doubles covariance[6];
    LoadSymmetric(columns.x_covariance, i, covariance);
    Doubles j[3][3], spread[3][3];  // derivative of the projection by the point in the world
    for (int k = 0; k < 3; ++k) {
      const double r0 = pose.rotation[k], r1 = pose.rotation[3 + k], r2 = pose.rotation[6 + k];
      j[0][k] = points.p * r0 + points.c[0] * r2;
      j[1][k] = points.q * r1 + points.c[1] * r2;
      j[2][k] = points.p * r0 + points.c[2] * r2;
    }
    for (int k = 0; k < 3; ++k) Multiply(covariance, j[k], spread[k]);
    const Doubles variance = Load<Doubles>(columns.variance + i);
    const Doubles has_right = Load<Doubles>(columns.has_right + i);
    const Doubles s[6] = {
        DotProduct(j[0], spread[0]) + variance,  DotProduct(j[0], spread[1]),
        DotProduct(j[0], spread[2]) * has_right, DotProduct(j[1], spread[1]) + variance,
        DotProduct(j[1], spread[2]) * has_right, DotProduct(j[2], spread[2]) + variance};
    Doubles information[6];
    Invert(s, information);
    information[5] *= has_right;
    for (int k = 0; k < 6; ++k) {
      Store(points.is_visible * information[k], columns.information[k] + i);
    }
  }
}

void SquareErrors(const PoseNumbers& pose, const PoseColumns& columns) {
  for (int i = 0; i < columns.count; i += kPoseLanes) {
    const CameraPoints points(pose, columns, i);
    Doubles errors[3], information[6], whitened[3];
    points.FindErrors(pose, columns, i, errors);
    LoadSymmetric(columns.information, i, information);
    Multiply(information, errors, whitened);
    const Doubles squared = DotProduct(errors, whitened);
    Store(points.is_visible > 0 ? squared : Doubles{} + kBehindCamera, columns.squared + i);
  }
}

inline double Sum(const Doubles& v) { return (v[0] + v[2]) + (v[1] + v[3]); }

template <int kSize>
void SumLanes(const Doubles (&vectors)[kSize], double (&sums)[kSize]) {
  for (int k = 0; k < kSize; ++k) sums[k] = Sum(vectors[k]);
}

PoseSums Accumulate(const PoseNumbers& pose, const PoseColumns& columns, const double* weights) {
  Doubles rotation[6] = {}, mixed[9] = {}, translation[6] = {}, torque[3] = {}, force[3] = {};
  for (int i = 0; i < columns.count; i += kPoseLanes) {
    const CameraPoints points(pose, columns, i);
    const Doubles *x = points.x, *c = points.c;
    const Doubles weight = points.is_visible * Load<Doubles>(weights + i);
    Doubles errors[3], w[6], whitened[3];
    points.FindErrors(pose, columns, i, errors);
    LoadSymmetric(columns.information, i, w);
    for (int k = 0; k < 6; ++k) w[k] *= weight;
    Multiply(w, errors, whitened);
    const Doubles pull[3] = {points.p * (whitened[0] + whitened[2]), points.q * whitened[1],
                             DotProduct(c, whitened)};
    // m = A^T W A with A the derivative of the projection, by way of the third column of W A.
    Doubles third[3];
    Multiply(w, c, third);
    const Doubles m[6] = {points.p * points.p * (w[0] + 2 * w[2] + w[5]),
                          points.p * points.q * (w[1] + w[4]),
                          points.p * (third[0] + third[2]),
                          points.q * points.q * w[3],
                          points.q * third[1],
                          DotProduct(c, third)};
    const Doubles full[3][3] = {{m[0], m[1], m[2]}, {m[1], m[3], m[4]}, {m[2], m[4], m[5]}};
    // The derivative by the step is A [-x]x for the rotation and A for the translation.
    Doubles turned[3][3];
    for (int k = 0; k < 3; ++k) {
      turned[0][k] = x[1] * full[2][k] - x[2] * full[1][k];
      turned[1][k] = x[2] * full[0][k] - x[0] * full[2][k];
      turned[2][k] = x[0] * full[1][k] - x[1] * full[0][k];
    }
    for (int k = 0; k < 6; ++k) translation[k] += m[k];
    for (int k = 0; k < 9; ++k) mixed[k] += turned[k / 3][k % 3];
    rotation[0] += x[1] * turned[0][2] - x[2] * turned[0][1];
    rotation[1] += x[2] * turned[0][0] - x[0] * turned[0][2];
    rotation[2] += x[0] * turned[0][1] - x[1] * turned[0][0];
    rotation[3] += x[2] * turned[1][0] - x[0] * turned[1][2];
    rotation[4] += x[0] * turned[1][1] - x[1] * turned[1][0];
    rotation[5] += x[0] * turned[2][1] - x[1] * turned[2][0];
    for (int k = 0; k < 3; ++k) force[k] += pull[k];
    torque[0] += x[1] * pull[2] - x[2] * pull[1];
    torque[1] += x[2] * pull[0] - x[0] * pull[2];
    torque[2] += x[0] * pull[1] - x[1] * pull[0];
  }
  PoseSums sums;
  SumLanes(rotation, sums.rotation);
  SumLanes(mixed, sums.mixed);
  SumLanes(translation, sums.translation);
  SumLanes(torque, sums.torque);
  SumLanes(force, sums.force);
  return sums;
}

constexpr PoseKernels kKernels = {&Inform, &SquareErrors, &Accumulate};

}  // namespace
}  // namespace arfm_vo
