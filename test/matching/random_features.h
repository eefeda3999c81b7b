#pragma once

#include <cmath>

#include "arfm_vo/base/random.h"
#include "arfm_vo/features/features.h"

namespace arfm_vo {

/// Scales the 64 numbers to unit length.
inline void Normalise(float* descriptor) {
  double sum = 0;
  for (int k = 0; k < 64; ++k) sum += descriptor[k] * descriptor[k];
  const auto scale = static_cast<float>(1 / std::sqrt(sum));
  for (int k = 0; k < 64; ++k) descriptor[k] *= scale;
}

/// `count` features anywhere in an image of 1200 x 370, all different, of both signs.
inline Features RandomFeatures(int count, int seed) {
  RandomEngine engine(seed);
  const auto between = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * RandomUnit(engine));
  };
  Features features;
  features.descriptors.create(count, 64, CV_32FC1);
  for (int i = 0; i < count; ++i) {
    features.keypoints.push_back({between(20, 1180), between(20, 350), between(1.2, 4)});
    features.keypoints[i].response = between(1, 100);
    features.keypoints[i].laplacian_sign = RandomBelow(2, engine) ? 1 : -1;
    float* descriptor = features.descriptors.ptr<float>(i);
    for (int k = 0; k < 64; ++k) descriptor[k] = between(-1, 1);
    Normalise(descriptor);
  }
  return features;
}

/// The same features with noise on the descriptors, the last one first.
inline Features ReversedWithNoise(const Features& features, double noise, int seed) {
  RandomEngine engine(seed);
  Features copy;
  copy.descriptors.create(features.size(), 64, CV_32FC1);
  for (int i = 0; i < features.size(); ++i) {
    const int from = features.size() - 1 - i;
    copy.keypoints.push_back(features.keypoints[from]);
    float* descriptor = copy.descriptors.ptr<float>(i);
    for (int k = 0; k < 64; ++k) {
      descriptor[k] = features.descriptors.at<float>(from, k) +
                      static_cast<float>(noise * (2 * RandomUnit(engine) - 1));
    }
    Normalise(descriptor);
  }
  return copy;
}

}  // namespace arfm_vo
