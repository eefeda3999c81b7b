#include <algorithm>
#include <cstdio>
#include <opencv2/core.hpp>

#include "arfm_vo/configuration/program.h"
#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/simulation/hash_noise.h"
#include "arfm_vo/simulation/scene.h"
#include "image/image_noise.h"

namespace {

using namespace arfm_vo;

struct Arguments {
  std::string config;
  int num_pairs = 1000, seed = 1;
  double noise_grey_levels = 2;
  double intruder_share = 0;  ///< of the picture's width
};

/// A textured rectangle, or a shadow, that takes a third of the picture, passes
/// through it from outside, and comes back.
class Intruder {
 public:
  Intruder(cv::Size size, double share, int seed)
      : size_(size), width_(static_cast<int>(share * size.width)), seed_(seed) {}

  /// `disparity_px` nearer than infinity; `pair` says where it is.
  void Paint(cv::Mat& image, int pair, int disparity_px, bool is_shadow) const {
    if (width_ == 0) return;
    const int way = size_.width + width_;  // from outside to outside
    const int step = (7 * pair) % (2 * way);
    const int left = (step < way ? step : 2 * way - step) - width_ - disparity_px;
    for (int y = size_.height / 6; y < size_.height; ++y) {
      for (int x = std::max(0, left); x < std::min(size_.width, left + width_); ++x) {
        uint8_t& grey = image.at<uint8_t>(y, x);
        grey = is_shadow ? static_cast<uint8_t>(0.35 * grey) : Texture(x - left, y);
      }
    }
  }

 private:
  uint8_t Texture(int x, int y) const {
    return static_cast<uint8_t>(40 + 170 * HashUnit(HashWord(seed_ + 8191 * (x / 6) + (y / 6))));
  }

  cv::Size size_;
  int width_, seed_;
};

struct Drift {
  double metres = 0, degrees = 0;
  int num_degraded = 0;
};

/// The farthest that the pose went from where it was, over noisy pictures of one place.
Drift Rest(const Arguments& arguments, bool is_shadow) {
  SceneOptions options;
  options.path = "rest";
  options.num_pairs = 1;
  options.noise_grey_levels = 0;
  options.seed = arguments.seed;
  const Scene scene(options);
  const StereoImages still = scene.RenderPair(0);
  const Intruder intruder(still.left.size(), arguments.intruder_share, arguments.seed);
  VisualOdometry odometry(scene.camera(),
                          ReadYamlFileOrDefaults<OdometryOptions>(arguments.config));
  cv::RNG random(static_cast<uint64_t>(arguments.seed));
  Drift drift;
  for (int pair = 0; pair < arguments.num_pairs; ++pair) {
    StereoImages images{0.1 * pair, still.left.clone(), still.right.clone()};
    intruder.Paint(images.left, pair, 0, is_shadow);
    intruder.Paint(images.right, pair, is_shadow ? 20 : 40, is_shadow);
    for (cv::Mat* image : {&images.left, &images.right})
      AddNoise(*image, arguments.noise_grey_levels, random);
    const SessionUpdate update = odometry.Process(images);
    const PoseEstimate& pose = update.update.pose;
    if (!pose.HasPose())
      throw std::runtime_error("pair " + std::to_string(pair) + ": " + update.text);
    drift.num_degraded += !pose.IsTracked();
    drift.metres = std::max(drift.metres, pose.camera_from_world.translation.norm());
    drift.degrees = std::max(drift.degrees, pose.camera_from_world.Angle() * 180 / M_PI);
  }
  return drift;
}

void Print(const char* what, const Drift& drift) {
  std::printf("%s,%.6f,%.6f,%d\n", what, drift.metres, drift.degrees, drift.num_degraded);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  Program program;
  program.name = "simulate_rest";
  program.description =
      "How far the pose of a parked rover walks over noisy pictures of one rendered place: alone,\n"
      "with a vehicle, and with a shadow that move through a third of the picture.";
  program.Add("pairs", arguments.num_pairs, "N", "of each kind");
  program.Add("config", arguments.config, "FILE", "options of the odometry, YAML");
  program.Add("noise", arguments.noise_grey_levels, "LEVELS",
              "standard deviation of the grey values");
  program.Add("seed", arguments.seed, "S", "of place and noise");
  program.run = [&] {
    std::printf("what,farthest_m,farthest_deg,degraded\n");
    Print("alone", Rest(arguments, false));
    arguments.intruder_share = 1.0 / 3;
    Print("vehicle", Rest(arguments, false));
    Print("shadow", Rest(arguments, true));
  };
  return RunProgram(argc, argv, program);
}
