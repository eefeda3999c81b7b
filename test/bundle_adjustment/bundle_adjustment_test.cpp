#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"

#include <gtest/gtest.h>

#include "bundle_adjustment/bundle_scene.h"

namespace arfm_vo {
namespace {

double WorstPoseError(const CorridorScene& scene, const BundleResult& result) {
  double worst = 0;
  for (size_t i = 0; i < scene.camera_from_world.size(); ++i) {
    const Rigid3 error = result.camera_from_world[i] * scene.camera_from_world[i].Inverse();
    worst = std::max({worst, error.Angle(), error.translation.norm()});
  }
  return worst;
}

TEST(BundleAdjustment, ReturnsToTheTruthWithoutNoise) {
  CorridorOptions corridor;
  corridor.noise_px = 0;
  const CorridorScene scene = MakeCorridor(corridor);
  for (const StepStrategy strategy : {StepStrategy::kLevenbergMarquardt, StepStrategy::kDogleg}) {
    BundleOptions options;
    options.strategy = strategy;
    options.max_iterations = 50;
    options.function_tolerance = 1e-12;
    const BundleResult result = AdjustBundle(scene.problem, options);
    EXPECT_LT(WorstPoseError(scene, result), 1e-6);
    for (size_t i = 0; i < scene.points.size(); ++i) {
      EXPECT_LT((result.points[i] - scene.points[i]).norm(), 1e-4) << i;
    }
  }
}

}  // namespace
}  // namespace arfm_vo
