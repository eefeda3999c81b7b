#include "arfm_vo/simulation/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "base/refusal.h"

namespace arfm_vo {
namespace {

SceneOptions TinyOptions(const std::string& path) {
  SceneOptions options;
  options.path = path;
  options.num_pairs = 10;
  options.width = 128;
  options.height = 96;
  options.noise_grey_levels = 0;
  options.margin_m = 5;
  return options;
}

TEST(Scene, EveryPathRendersPairsThatFitItsCamera) {
  for (const std::string& path : Scene::PathNames()) {
    const Scene scene(TinyOptions(path));
    const StereoImages images = scene.RenderPair(5);
    EXPECT_NO_THROW(images.Check()) << path;
    EXPECT_EQ(images.left.size(), cv::Size(128, 96)) << path;
    EXPECT_NEAR(scene.camera().cx, 63.5, 2) << path;
    EXPECT_NEAR(scene.FirstFromLeft(0).Angle(), 0, 1e-7) << path;
    const double moved = scene.FirstFromLeft(9).translation.norm();
    EXPECT_EQ(moved < 1e-9, path == "rest" || path == "shadow") << path;
  }
}

TEST(Scene, SomethingLargeMovesThroughTheViewOfTheRoverAtRest) {
  const Scene empty(TinyOptions("rest")), scene(TinyOptions("shadow"));
  double largest = 0;
  for (int pair = 0; pair < scene.num_pairs(); ++pair) {
    cv::Mat difference;
    cv::absdiff(empty.RenderPair(pair).left, scene.RenderPair(pair).left, difference);
    largest = std::max(largest, cv::countNonZero(difference > 10) / (128.0 * 96));
  }
  EXPECT_GT(largest, 0.25);
  EXPECT_LT(largest, 0.5);
}

TEST(Scene, FaultOfRectificationMovesTheRightRows) {
  SceneOptions faulty = TinyOptions("rest");
  const Scene right(faulty);
  // One pixel is 1 / fx = 9.52 mrad here; a turn about x moves the picture along its columns.
  faulty.right_x_mrad = 1e3 * std::atan(1 / right.camera().fy);
  const Scene scene(faulty);
  const StereoImages good = right.RenderPair(0), bad = scene.RenderPair(0);
  EXPECT_EQ(cv::norm(good.left, bad.left, cv::NORM_INF), 0);
  // What lies ahead turns from z towards -y, one row up.
  const cv::Rect inner(2, 20, 124, 60);
  const cv::Mat moved = bad.right(inner - cv::Point(0, 1));
  EXPECT_LT(cv::norm(moved, good.right(inner), cv::NORM_L1),
            0.3 * cv::norm(bad.right(inner), good.right(inner), cv::NORM_L1));
}

TEST(Scene, RefusesAnUnknownPathByName) {
  SceneOptions options;
  options.path = "spiral";
  EXPECT_INVALID(Scene{options}, "spiral");
}

}  // namespace
}  // namespace arfm_vo
