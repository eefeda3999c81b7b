#include "arfm_vo/features/scale_space_maximum.h"

#include <cmath>
#include <opencv2/core.hpp>

#include "arfm_vo/features/box_hessian.h"

namespace arfm_vo {
namespace {

using Neighbours = float[3][3][3];  ///< determinants by layer, row, column

void ReadNeighbours(const ScaleSpace& space, const ScaleSpaceMaximum& maximum, Neighbours& values) {
  const int step = space.Step(maximum.octave);
  for (int layer = 0; layer < 3; ++layer) {
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 3; ++col) {
        values[layer][row][col] =
            space.At(maximum.octave, maximum.layer + layer - 1, maximum.x + (col - 1) * step,
                     maximum.y + (row - 1) * step);
      }
    }
  }
}

/// Offset (x, y, layer) of the top in samples, from central differences.
cv::Vec3d FindTop(const Neighbours& v) {
  const double centre = v[1][1][1];
  const cv::Vec3d gradient(0.5 * (v[1][1][2] - v[1][1][0]), 0.5 * (v[1][2][1] - v[1][0][1]),
                           0.5 * (v[2][1][1] - v[0][1][1]));
  const double xx = v[1][1][2] + v[1][1][0] - 2 * centre;
  const double yy = v[1][2][1] + v[1][0][1] - 2 * centre;
  const double ss = v[2][1][1] + v[0][1][1] - 2 * centre;
  const double xy = 0.25 * (v[1][2][2] + v[1][0][0] - v[1][2][0] - v[1][0][2]);
  const double xs = 0.25 * (v[2][1][2] + v[0][1][0] - v[2][1][0] - v[0][1][2]);
  const double ys = 0.25 * (v[2][2][1] + v[0][0][1] - v[2][0][1] - v[0][2][1]);
  const cv::Matx33d hessian(xx, xy, xs, xy, yy, ys, xs, ys, ss);
  return hessian.solve(-gradient, cv::DECOMP_LU);
}

}  // namespace

std::optional<Keypoint> InterpolateMaximum(const ScaleSpace& space,
                                           const ScaleSpaceMaximum& maximum) {
  Neighbours values;
  ReadNeighbours(space, maximum, values);
  const cv::Vec3d top = FindTop(values);
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(top[i]) <= 1)) return std::nullopt;
  }
  const int step = space.Step(maximum.octave);
  const int size = BoxFilterSize(maximum.octave, maximum.layer);
  const int size_step = BoxFilterSize(maximum.octave, 1) - BoxFilterSize(maximum.octave, 0);
  Keypoint keypoint;
  keypoint.x = static_cast<float>(maximum.x + top[0] * step);
  keypoint.y = static_cast<float>(maximum.y + top[1] * step);
  keypoint.scale = ScaleOfFilter(static_cast<float>(size + top[2] * size_step));
  keypoint.response = maximum.response;
  return keypoint;
}

bool RepeatsFinerOctave(const ScaleSpace& space, const ScaleSpaceMaximum& maximum) {
  constexpr int kRadius = 2;  // samples of the finer octave: the neighbours of this one's
  if (maximum.octave == 0) return false;
  const int layers = static_cast<int>(space.layers[maximum.octave].size());
  const int same = 2 * maximum.layer + 1;  // layer of the finer octave with the same filter
  if (same < layers - 1) return true;      // a maximum there as well
  const int octave = maximum.octave - 1, step = space.Step(octave);
  for (const int layer : {same - 1, same + 1}) {
    if (layer >= layers) continue;
    for (int dy = -kRadius; dy <= kRadius; ++dy) {
      for (int dx = -kRadius; dx <= kRadius; ++dx) {
        const int x = maximum.x + dx * step, y = maximum.y + dy * step;
        if (space.At(octave, layer, x, y) > maximum.response) return true;
      }
    }
  }
  return false;
}

}  // namespace arfm_vo
