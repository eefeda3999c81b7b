#include <iostream>

#include "arfm_vo/base/check.h"
#include "arfm_vo/calibration/calibration_report.h"
#include "arfm_vo/calibration/pair_detection.h"
#include "arfm_vo/configuration/program.h"

namespace {

using namespace arfm_vo;

void Calibrate(const std::string& image_dir, const std::string& output_dir, const Chessboard& board,
               const StereoCalibrationOptions& options, double alpha) {
  options.Check();
  const std::vector<ImagePair> files = FindImagePairs(image_dir);
  DetectedPairs detected = DetectPairs(files, board, options.min_pairs);
  StereoCalibration calibration =
      CalibrateStereo(std::move(detected.pairs), board, detected.image_size, options);
  calibration.left_out.insert(calibration.left_out.begin(), detected.left_out.begin(),
                              detected.left_out.end());
  for (const LeftOutPair& pair : calibration.left_out)
    std::cout << "left out " << pair.name << ": " << pair.reason << "\n";
  const Rectification rectification = Rectify(calibration, alpha);
  WriteCalibration(output_dir, files, calibration, rectification, board);
  std::cout << FormatFigures(calibration, rectification);
}

}  // namespace

int main(int argc, char** argv) {
  std::string image_dir, output, size, model = ToString(DistortionModel::kPlumbBob);
  double square_m = 0, alpha = 0;
  StereoCalibrationOptions options;
  Program program;
  program.name = "calibrate_stereo";
  program.description =
      "Calibrates both cameras from pictures of a chessboard, after Zhang. IMAGE_DIR holds files\n"
      "left*.EXT and right*.EXT, or folders left/ and right/ with the same names. The output "
      "takes\n"
      "left.yaml and right.yaml for camera_info, report.md and pictures.";
  program.inputs = {{"IMAGE_DIR", &image_dir}};
  program.Add("board", size, "COLUMNSxROWS",
              "inner corners of the board (where four squares meet), such as 20x10");
  program.Add("square", square_m, "METRES", "side of a square");
  program.Add("output", output, "DIR", "made where it is not there");
  program.Add("model", model, "NAME", "plumb_bob (default) or rational_polynomial for wide lenses");
  program.Add("alpha", alpha, "A",
              "0 (default): only valid pixels in the rectified image; 1: all pixels");
  program.Add("min-pairs", options.min_pairs, "N", "fewer are an error (default 5)");
  program.run = [&] {
    Require(!size.empty() && square_m != 0 && !output.empty(),
            "--board, --square and --output must be given (see --help)");
    const cv::Size corners = ParseBoardSize(size);
    options.model = ParseDistortionModel(model);
    Require(alpha >= 0 && alpha <= 1, "--alpha must be in 0..1, is " + std::to_string(alpha));
    Calibrate(image_dir, output, {corners.width, corners.height, square_m}, options, alpha);
  };
  return RunProgram(argc, argv, program);
}
