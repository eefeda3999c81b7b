#include "arfm_vo/evaluation/odometry_program.h"

#include <iostream>

#include "arfm_vo/configuration/learned_correction_file.h"
#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/configuration/yaml_writer.h"
#include "arfm_vo/evaluation/odometry_run.h"
#include "arfm_vo/evaluation/progress_bar.h"
#include "arfm_vo/evaluation/run_report.h"
#include "arfm_vo/odometry/reason.h"
#include "arfm_vo/odometry/visual_odometry.h"

namespace arfm_vo {
namespace {

struct Arguments {
  std::string input, config, output, learned_calibration;
  bool print_config = false, print_reasons = false;
  PairSelection selection;
};

void AddOptions(Arguments& arguments, Program& program) {
  program.Add("config", arguments.config, "FILE", "options of the odometry, YAML");
  program.Add("print-config", arguments.print_config,
              "print all options with their values and leave");
  program.Add(
      "print-reasons", arguments.print_reasons,
      "print why a pair may have no pose, or one to be wary of, and what follows, and leave");
  program.Add("learned-calibration", arguments.learned_calibration, "FILE",
              "what earlier drives told of the rectification: read where the file is there, "
              "written at the end");
  program.Add("pairs", arguments.selection.max_pairs, "N",
              "stop after N pairs (counted after --stride)");
  program.Add("stride", arguments.selection.stride, "K", "take every K-th pair");
  program.Add("output", arguments.output, "DIR",
              "write poses.txt, poses_online.txt, tracked.txt, trajectory.tum, timing.csv and "
              "trajectory.png there");
}

std::string FormatReasons() {
  std::string text = "| reason | what follows |\n|---|---|\n";
  for (const ReasonRow& row : ListReasons()) {
    text += std::string("| ") + row.text + " | " + row.effect + " |\n";
  }
  return text;
}

void Run(const std::string& name, const OpenSequence& open, const Arguments& arguments) {
  const OdometryOptions options = ReadYamlFileOrDefaults<OdometryOptions>(arguments.config);
  if (!arguments.output.empty()) CheckCanWriteRun(arguments.output);
  const auto sequence = open(arguments.input, arguments.selection);
  VisualOdometry odometry(sequence->camera(), options);
  const std::string& learned = arguments.learned_calibration;
  if (!learned.empty()) {
    if (const auto known = ReadLearnedCorrection(learned, sequence->camera())) {
      odometry.SetCorrection(*known);
    }
  }
  OdometryRun run;
  {
    ProgressBar bar(stderr);
    run = RunOdometry(*sequence, odometry, [&](int done, int all) { bar.Show(done, all); });
  }
  Require(!run.trajectory.empty(), arguments.input + ": holds no stereo pairs");
  if (!learned.empty() && odometry.correction()) {
    WriteLearnedCorrection(learned, sequence->camera(), *odometry.correction());
  }
  const std::string complaint = arguments.output.empty() ? "" : WriteRun(run, arguments.output);
  if (!complaint.empty()) std::cerr << name << ": " << complaint << "\n";
  std::cout << FormatRun(run) << sequence->FormatSummary();
}

}  // namespace

int RunOdometryProgram(int argc, const char* const* argv, Program program,
                       const std::string& input_name, const OpenSequence& open) {
  Arguments arguments;
  program.inputs = {{input_name, &arguments.input}};
  AddOptions(arguments, program);
  program.answer = [&] {
    if (arguments.print_config)
      std::cout << WriteYaml(ReadYamlFileOrDefaults<OdometryOptions>(arguments.config));
    if (arguments.print_reasons) std::cout << FormatReasons();
    return arguments.print_config || arguments.print_reasons;
  };
  program.run = [&] { Run(program.name, open, arguments); };
  return RunProgram(argc, argv, program);
}

}  // namespace arfm_vo
