#include <chrono>
#include <cmath>
#include <sstream>
#include <thread>

#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/calibration/camera_info_file.h"
#include "arfm_vo/configuration/program.h"
#include "arfm_vo/ros/bag_sequence.h"
#include "hardware/loopback_writer.h"

namespace {

using namespace arfm_vo;

struct Playing {
  std::string bag, folder, left = "/dev/video10", right = "/dev/video11";
  double rate_hz = 0.5;
  int num_pairs = 12, num_repeats = 4;
  double wait_s = 60;
};

/// The calibration as camera_info_manager reads it: the pictures are rectified already.
void WriteCalibration(const std::string& folder, const StereoCamera& camera) {
  const cv::Matx33d matrix(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  for (const bool is_right : {false, true}) {
    const double tx = is_right ? -camera.fx * camera.baseline_m : 0;
    const cv::Matx34d projection(camera.fx, 0, camera.cx, tx, 0, camera.fy, camera.cy, 0, 0, 0, 1,
                                 0);
    const std::string name = is_right ? "right" : "left";
    WriteWholeFile(
        folder + "/" + name + ".yaml",
        FormatCameraInfo(name, {camera.width, camera.height},
                         {matrix, cv::Mat::zeros(1, 5, CV_64FC1)}, cv::Matx33d::eye(), projection));
  }
}

std::string FormatPose(const Rigid3& pose) {
  const Eigen::Vector3d& t = pose.translation;
  std::ostringstream text;
  text << "true_end_m: " << t.x() << " " << t.y() << " " << t.z() << "\n";
  return text.str();
}

/// Shows the first picture until all listen, then the others, and the last a few times.
void Play(const Playing& playing) {
  PairSelection selection;
  selection.max_pairs = playing.num_pairs;
  BagSequence sequence(playing.bag, {}, selection);
  const StereoCamera& camera = sequence.camera();
  LoopbackWriter left(playing.left, camera.width, camera.height);
  LoopbackWriter right(playing.right, camera.width, camera.height);
  WriteCalibration(playing.folder, camera);
  const std::chrono::duration<double> interval(1 / playing.rate_hz);
  Rigid3 first, last;
  const auto show = [&](const SequencePair& pair, int times) {
    for (int i = 0; i < times; ++i) {
      left.Write(pair.images.left);
      right.Write(pair.images.right);
      std::this_thread::sleep_for(interval);
    }
  };
  std::optional<SequencePair> shown;
  while (std::optional<SequencePair> pair = sequence.Next()) {
    if (!pair->true_world_from_camera) throw std::invalid_argument(playing.bag + ": has no truth");
    last = *pair->true_world_from_camera;
    if (!shown) first = last;
    show(*pair, shown ? 1 : static_cast<int>(std::ceil(playing.wait_s * playing.rate_hz)));
    shown = std::move(pair);
  }
  if (shown) show(*shown, playing.num_repeats);
  WriteWholeFile(playing.folder + "/truth.txt", FormatPose(first.Inverse() * last));
}

}  // namespace

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  Playing playing;
  Program program;
  program.name = "loopback_player";
  program.description =
      "Shows the pairs of a bag with ground truth on two v4l2loopback cameras. FOLDER takes the\n"
      "calibration (left.yaml, right.yaml) at the start and truth.txt at the end.";
  program.inputs = {{"BAG", &playing.bag}, {"FOLDER", &playing.folder}};
  program.options.add_options()("rate", po::value(&playing.rate_hz)->value_name("HZ"), "of pairs")(
      "pairs", po::value(&playing.num_pairs)->value_name("N"), "at most")(
      "wait", po::value(&playing.wait_s)->value_name("S"), "how long the first is shown");
  program.run = [&] { Play(playing); };
  return RunProgram(argc, argv, program);
}
