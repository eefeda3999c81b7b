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

std::string FormatPaths() {
  std::string names;
  for (const std::string& name : Scene::PathNames()) names += (names.empty() ? "" : "|") + name;
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  std::string folder;
  SceneOptions scene;
  Program program;
  program.name = "render_sequence";
  program.description =
      "Renders a drive over a planetary terrain as a KITTI folder (image_0, image_1, calib.txt,\n"
      "times.txt, poses.txt) with exact calibration and ground truth. The same options give the\n"
      "same bytes.";
  program.inputs = {{"OUTPUT_DIR", &folder}};
  const std::string paths = FormatPaths();
  program.options.add_options()("path", po::value(&scene.path)->value_name(paths.c_str()),
                                "kind of drive, curve if not given")(
      "pairs", po::value(&scene.num_pairs)->value_name("N"), "number of pairs")(
      "step", po::value(&scene.step_m)->value_name("M"), "metres from pair to pair")(
      "turn-step", po::value(&scene.turn_step_deg)->value_name("DEG"),
      "degrees from pair to pair where the rover turns in place")(
      "seed", po::value(&scene.seed)->value_name("S"), "another seed, another terrain")(
      "width", po::value(&scene.width)->value_name("PX"), "of the images, with the same view")(
      "height", po::value(&scene.height)->value_name("PX"), "of the images")(
      "noise", po::value(&scene.noise_grey_levels)->value_name("LEVELS"),
      "standard deviation of the grey values")(
      "right-x", po::value(&scene.right_x_mrad)->value_name("MRAD"),
      "fault of rectification: the right camera's rotation about x (moves its rows)")(
      "right-y", po::value(&scene.right_y_mrad)->value_name("MRAD"),
      "about y (moves all disparities)")(
      "right-z", po::value(&scene.right_z_mrad)->value_name("MRAD"), "about z")(
      "sweep-pan", po::value(&scene.sweep_pan_deg)->value_name("DEG"),
      "the head sweeps through so much, once to both sides")(
      "sweep-tilt", po::value(&scene.sweep_tilt_deg)->value_name("DEG"), "twice up and down")(
      "threads", po::value(&scene.num_threads)->value_name("N"), "does not change the result");
  program.run = [&] { RenderSequence(folder, scene); };
  return RunProgram(argc, argv, program);
}
