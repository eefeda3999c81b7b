#include <gtest/gtest.h>

#include <filesystem>

#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/odometry/visual_odometry.h"

namespace arfm_vo {
namespace {

TEST(ShippedConfig, EveryFileOfTheOdometryIsReadStrictly) {
  int num_files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(ARFM_VO_SOURCE_DIR) + "/config")) {
    if (entry.path().extension() != ".yaml") continue;
    if (entry.path().filename().string().rfind("arfm", 0) != 0) continue;
    ++num_files;
    EXPECT_NO_THROW(ReadYamlFile<OdometryOptions>(entry.path().string()).Check()) << entry.path();
  }
  EXPECT_GE(num_files, 2);
}

TEST(ShippedConfig, ThePapersIsAsThePaperSays) {
  const auto options =
      ReadYamlFile<OdometryOptions>(std::string(ARFM_VO_SOURCE_DIR) + "/config/arfm_paper.yaml");
  EXPECT_FALSE(options.frontend.stereo.guided);
  EXPECT_EQ(options.frontend.stereo.matcher.strategy, MatchStrategy::kSurfFlannRansac);
  EXPECT_EQ(options.frontend.stereo.threshold.rule, ThresholdRule::kVariance);
  EXPECT_EQ(options.odometry.tracker.pose.refinement.step, StepKind::kGaussNewton);
  EXPECT_EQ(options.global.solver.solver, BundleSolver::kCeres);
  EXPECT_FALSE(options.global.learn_correction);
}

}  // namespace
}  // namespace arfm_vo
