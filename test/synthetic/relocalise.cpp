#include <cmath>
#include <cstdio>
#include <random>

#include "arfm_vo/configuration/program.h"
#include "arfm_vo/datasets/kitti_sequence.h"
#include "arfm_vo/odometry/visual_odometry.h"

namespace {

using namespace arfm_vo;

constexpr int kBlackPairs = 10, kLeastBefore = 5;
constexpr double kPeriod_s = 0.1, kMaxSigma = 3;

struct Arguments {
  std::string sequence;
  int tries = 200;
  double min_share = 0.25;
};

/// A drive as the front end saw it: its work does not depend on what a try shows.
struct Drive {
  StereoCamera camera;
  std::vector<StereoImages> images;
  std::vector<StereoFrame> frames;
  std::vector<Rigid3> truth;         ///< tells which pairs share a view
  std::vector<SessionUpdate> whole;  ///< what the odometry says of them, undisturbed
  StereoImages black;
  StereoFrame black_frame;
};

Drive Read(const std::string& folder) {
  KittiSequence sequence(folder, {});
  Drive drive;
  drive.camera = sequence.camera();
  StereoFrontend frontend(drive.camera, {});
  while (auto pair = sequence.Next()) {
    Require(pair->true_world_from_camera.has_value(), folder + ": poses.txt is needed");
    drive.truth.push_back(*pair->true_world_from_camera);
    drive.images.push_back(
        {pair->images.stamp_s, pair->images.left.clone(), pair->images.right.clone()});
    drive.frames.push_back(frontend.Process(drive.images.back()));
  }
  Require(drive.truth.size() > kLeastBefore + 1, folder + ": has too few pairs");
  drive.black = {0, cv::Mat::zeros(drive.images[0].left.size(), CV_8U),
                 cv::Mat::zeros(drive.images[0].left.size(), CV_8U)};
  drive.black_frame = frontend.Process(drive.black);
  VisualOdometry odometry(drive.camera, {});
  for (size_t i = 0; i < drive.frames.size(); ++i)
    drive.whole.push_back(odometry.Process(drive.frames[i], drive.images[i]));
  return drive;
}

/// How much of the view of one pose another has, for a camera that turns.
double SharedView(const Drive& drive, int a, int b) {
  const double view_rad = 2 * std::atan(drive.camera.width / (2 * drive.camera.fx));
  return 1 - (drive.truth[a].Inverse() * drive.truth[b]).Angle() / view_rad;
}

struct Outcome {
  bool is_found = false, is_wrong = false;
};

/// Drives to pair `last`, is blind for some pairs, and then sees pair `shown`.
Outcome Try(const Drive& drive, int last, int shown) {
  VisualOdometry odometry(drive.camera, {});
  int count = 0;
  const auto see = [&](StereoFrame frame, StereoImages images) {
    frame.stamp_s = images.stamp_s = kPeriod_s * count++;
    return odometry.Process(frame, images);
  };
  for (int i = 0; i <= last; ++i) see(drive.frames[i], drive.images[i]);
  for (int i = 0; i < kBlackPairs; ++i) see(drive.black_frame, drive.black);
  const SessionUpdate pose = see(drive.frames[shown], drive.images[shown]);
  if (!pose.IsTracked() || pose.epoch != 1) return {};
  const SessionUpdate& expected = drive.whole[shown];
  const double error_m =
      (pose.odom_from_base.translation - expected.odom_from_base.translation).norm();
  const Matrix6 covariance = pose.covariance + expected.covariance;
  const double sigma_m = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
  return {true, error_m > kMaxSigma * sigma_m + 0.01};
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  Program program;
  program.name = "relocalise";
  program.description =
      "Drives along a KITTI folder with poses.txt to a random pair, goes blind for ten pairs,\n"
      "and is then shown another random pair that shares a part of the last view. Prints how\n"
      "many tries find their place at once, and how many say a wrong one: beyond 3 standard\n"
      "deviations of what the undisturbed drive says, and 1 cm.";
  program.inputs = {{"SEQUENCE_DIR", &arguments.sequence}};
  program.Add("tries", arguments.tries, "N", "seeded tries (200)");
  program.Add("min-share", arguments.min_share, "PART",
              "of the last view that the pair shown shares at least (0.25)");
  program.run = [&] {
    const Drive drive = Read(arguments.sequence);
    const int num_pairs = static_cast<int>(drive.truth.size());
    int num_found = 0, num_wrong = 0;
    for (int seed = 0; seed < arguments.tries; ++seed) {
      std::mt19937 engine(seed);
      int last = 0, shown = 0;
      do {
        last = std::uniform_int_distribution<int>(kLeastBefore, num_pairs - 1)(engine);
        shown = std::uniform_int_distribution<int>(0, num_pairs - 1)(engine);
      } while (last == shown || SharedView(drive, last, shown) < arguments.min_share);
      const Outcome outcome = Try(drive, last, shown);
      num_found += outcome.is_found;
      num_wrong += outcome.is_wrong;
      if (!outcome.is_found || outcome.is_wrong) {
        std::printf("seed %d: pair %d after pair %d, %.0f %% shared: %s\n", seed, shown, last,
                    100 * SharedView(drive, last, shown), outcome.is_wrong ? "wrong" : "not found");
      }
    }
    std::printf("tries: %d\nfound: %d\nwrong: %d\n", arguments.tries, num_found, num_wrong);
  };
  return RunProgram(argc, argv, program);
}
