#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace arfm_vo {

/// The part of a textured plane that one pixel sees: a parallelogram around `center` spanned by the
/// steps `along_u`, `along_v` that one pixel to the right and one down make on the plane.
struct TextureFootprint {
  Eigen::Vector2d center, along_u, along_v;
};

/// How to take the mean over a footprint: along its long side, at the width of its short one.
struct TextureProbes {
  explicit TextureProbes(const TextureFootprint& footprint);

  Eigen::Vector2d center, longest;  ///< the footprint's middle and its longer side
  double major, minor;              ///< lengths; the short side is widened where it is far shorter
};

/// A square, seamlessly repeating pattern of mean 0 and standard deviation 1 whose detail lies
/// within wavelengths of about 2 to 16 texels, with its mip pyramid. Layers of it, each 8 times
/// coarser, give detail at every scale.
class NoiseTexture {
 public:
  /// [2^size_log2 x 2^size_log2] texels; `pebbles_per_texel` small lit discs are strewn on the
  /// noise.
  NoiseTexture(int size_log2, double pebbles_per_texel, uint32_t seed);

  int size() const { return size_; }
  /// The pattern at (x, y) texels of the finest level (texel (i, j) covers [i, i+1) x [j, j+1)), at
  /// mip level `lod` >= 0, trilinear.
  double Sample(double x, double y, double lod) const;
  /// The mean over a footprint given in units in which one texel is `texel` wide. Nearly 0 where
  /// the footprint is far wider than the coarsest detail.
  double SampleMean(const TextureProbes& probes, double texel) const;

 private:
  double SampleLevel(double x, double y, int level) const;

  int size_;
  /// Level k: [size/2^k x size/2^k], in Morton's order: the probes of a pixel lie close together in
  /// memory whichever way they go.
  std::vector<std::vector<float>> levels_;
  std::vector<uint32_t> place_;  ///< texel (i, j) is at place_[i] + 2 place_[j]
};

}  // namespace arfm_vo
