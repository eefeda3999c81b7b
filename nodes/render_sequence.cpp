#include <boost/algorithm/string/join.hpp>

#include "arfm_vo/configuration/program.h"
#include "arfm_vo/evaluation/progress_bar.h"
#include "arfm_vo/simulation/kitti_folder_writer.h"
#include "arfm_vo/simulation/scene.h"

namespace {

using namespace arfm_vo;

void RenderSequence(const std::string& folder, const SceneOptions& options) {
  const Scene scene(options);
  KittiFolderWriter writer(folder, scene.camera());
  ProgressBar bar(stderr);
  for (int pair = 0; pair < scene.num_pairs(); ++pair) {
    writer.Write(scene.RenderPair(pair), scene.FirstFromLeft(pair));
    bar.Show(pair + 1, scene.num_pairs());
  }
  writer.Close();
}

}  // namespace

int main(int argc, char** argv) {
  std::string folder;
  SceneOptions scene;
  Program program;
  program.name = "render_sequence";
  program.description =
      "Renders a drive over a planetary terrain as a KITTI folder (image_0, image_1, calib.txt,\n"
      "times.txt, poses.txt) with exact calibration and ground truth. The same options give the\n"
      "same bytes.";
  program.inputs = {{"OUTPUT_DIR", &folder}};
  const std::string paths = boost::join(Scene::PathNames(), "|");
  program.Add("path", scene.path, paths.c_str(), "kind of drive, curve if not given");
  program.Add("pairs", scene.num_pairs, "N", "number of pairs");
  program.Add("step", scene.step_m, "M", "metres from pair to pair");
  program.Add("turn-step", scene.turn_step_deg, "DEG",
              "degrees from pair to pair where the rover turns in place");
  program.Add("seed", scene.seed, "S", "another seed, another terrain");
  program.Add("width", scene.width, "PX", "of the images, with the same view");
  program.Add("height", scene.height, "PX", "of the images");
  program.Add("noise", scene.noise_grey_levels, "LEVELS", "standard deviation of the grey values");
  program.Add("right-x", scene.right_x_mrad, "MRAD",
              "fault of rectification: the right camera's rotation about x (moves its rows)");
  program.Add("right-y", scene.right_y_mrad, "MRAD", "about y (moves all disparities)");
  program.Add("right-z", scene.right_z_mrad, "MRAD", "about z");
  program.Add("sweep-pan", scene.sweep_pan_deg, "DEG",
              "the head sweeps through so much, once to both sides");
  program.Add("sweep-tilt", scene.sweep_tilt_deg, "DEG", "twice up and down");
  program.Add("threads", scene.num_threads, "N", "does not change the result");
  program.run = [&] { RenderSequence(folder, scene); };
  return RunProgram(argc, argv, program);
}
