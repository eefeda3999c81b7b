#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>

#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/configuration/program.h"
#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/simulation/kitti_folder_writer.h"
#include "recordings/clip.h"
#include "recordings/judged_run.h"
#include "recordings/recording_plan.h"
#include "recordings/rendered_drive.h"
#include "recordings/result_table.h"

namespace {

using namespace arfm_vo;

constexpr long kNoSeed = -1;

struct Arguments {
  std::string output, data = "../shared/data", config, references, half, only, dump;
  long first_seed = 1, seed = kNoSeed;
  long count = std::numeric_limits<int>::max();
  double seconds = std::numeric_limits<double>::infinity();
  int max_pairs = 60;
  bool is_verbose = false, is_plain = false;
};

/// Makes recordings of seeds.
class Maker {
 public:
  explicit Maker(const Arguments& arguments)
      : arguments_(arguments),
        options_(ReadYamlFileOrDefaults<OdometryOptions>(arguments.config)),
        clips_(FindClips(arguments.data)) {}

  RecordingPlan Plan(uint32_t seed) const {
    RecordingPlan plan = DrawRecording(seed, clips_, arguments_.max_pairs);
    if (arguments_.is_plain) {
      plan.clip.is_backward = false;
      plan.clip.transform = {};
      plan.light = {};
      plan.fault = {};
    }
    return plan;
  }
  Recording Make(const RecordingPlan& plan) const {
    if (plan.kind == Kind::kRendered) return {plan, std::make_unique<RenderedDrive>(plan.drive)};
    const Clip& clip = clips_.at(plan.clip.clip);
    const auto truth = ReadClipTruth(clip, options_, arguments_.references);
    return {plan, std::make_unique<ClipWindow>(clip, plan.clip, truth)};
  }
  Properties Describe(const Recording& recording) const {
    return DescribeRecording(recording.plan(), clips_, recording.source().camera());
  }
  JudgedRun Run(Recording& recording) const {
    Tolerance tolerance;
    if (recording.plan().kind == Kind::kReal) {
      const Clip& clip = clips_.at(recording.plan().clip.clip);
      tolerance = {clip.truth_percent, clip.truth_m};
    }
    return RunAndJudge(recording, options_, tolerance);
  }

 private:
  Arguments arguments_;
  OdometryOptions options_;
  std::vector<Clip> clips_;
};

void PrintPairs(const JudgedRun& run) {
  std::printf("pair,state,judged,trackable,share,corners,path_m,error_m,sigma_m,wrong,nees,text\n");
  for (size_t i = 0; i < run.pairs.size(); ++i) {
    const JudgedPair& pair = run.pairs[i];
    std::printf("%zu,%s,%d,%d,%.2f,%d,%.3f,%.4f,%.4f,%d,%.2f,\"%s\"\n", i, ToString(pair.state),
                pair.is_judged, pair.can_be_tracked, pair.view.share, pair.view.num_corners,
                pair.path_m, pair.error_m, pair.sigma_m, pair.is_wrong, pair.nees,
                pair.text.c_str());
  }
}

void Dump(Recording& recording, const std::string& folder) {
  KittiFolderWriter writer(folder, recording.source().camera());
  for (int i = 0; i < recording.source().size(); ++i) {
    writer.Write(recording.Take(i).images, recording.source().WorldFromLeft(i));
  }
  writer.Close();
}

void RunOne(const Arguments& arguments) {
  const Maker maker(arguments);
  const RecordingPlan plan = maker.Plan(static_cast<uint32_t>(arguments.seed));
  Recording recording = maker.Make(plan);
  const Properties properties = maker.Describe(recording);
  if (!arguments.dump.empty()) {
    Dump(recording, arguments.dump);
    return;
  }
  Stopwatch watch;
  const JudgedRun run = maker.Run(recording);
  if (arguments.is_verbose) PrintPairs(run);
  std::printf("%s\n%s\n", ResultHeader(properties).c_str(),
              FormatResult(plan.seed, properties, run, watch.LapMs() / 1000).c_str());
}

bool IsAsked(const Arguments& arguments, uint32_t seed) {
  const bool is_half = arguments.half.empty() || (arguments.half == "tune") == IsForTuning(seed);
  const bool is_kind = arguments.only.empty() ||
                       (arguments.only == "rendered") == (KindOfSeed(seed) == Kind::kRendered);
  return is_half && is_kind;
}

void RunMany(const Arguments& arguments) {
  const Maker maker(arguments);
  ResultTable table(arguments.output + "/recordings.csv");
  double spent_s = 0;
  for (long i = 0; i < arguments.count && spent_s < arguments.seconds; ++i) {
    const auto seed = static_cast<uint32_t>(arguments.first_seed + i);
    if (!IsAsked(arguments, seed) || table.Has(seed)) continue;
    Stopwatch watch;
    Recording recording = maker.Make(maker.Plan(seed));
    const JudgedRun run = maker.Run(recording);
    const double seconds = watch.LapMs() / 1000;
    spent_s += seconds;
    const Properties properties = maker.Describe(recording);
    const std::string line = FormatResult(seed, properties, run, seconds);
    table.Append(seed, properties, line);
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  }
}

void CheckArguments(const Arguments& arguments) {
  const auto is_one_of = [](const std::string& word, const char* a, const char* b) {
    return word.empty() || word == a || word == b;
  };
  Require(is_one_of(arguments.half, "tune", "judge"), "half must be tune or judge");
  Require(is_one_of(arguments.only, "real", "rendered"), "only must be real or rendered");
  Require(arguments.max_pairs >= 16, "pairs must be at least 16");
  Require(arguments.first_seed >= 0 && arguments.seed >= kNoSeed && arguments.count >= 0,
          "from, seed and count must not be negative");
  Require(arguments.dump.empty() || arguments.seed != kNoSeed, "dump needs seed");
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  Program program;
  program.name = "recordings";
  program.description =
      "Makes recordings, each determined by its seed: real clips changed and rendered drives, "
      "with\n"
      "and without faults. Runs the odometry on each and appends a line to OUTPUT_DIR/\n"
      "recordings.csv; seeds that stand there are left out.";
  program.inputs = {{"OUTPUT_DIR", &arguments.output}};
  program.Add("from", arguments.first_seed, "SEED", "the first seed (1)");
  program.Add("count", arguments.count, "N", "so many seeds; else without an end");
  program.Add("seconds", arguments.seconds, "S", "stops after so long");
  program.Add("half", arguments.half, "tune|judge", "of the seeds");
  program.Add("only", arguments.only, "real|rendered", "recordings of this kind");
  program.Add("pairs", arguments.max_pairs, "N", "of a recording at most (60)");
  program.Add("data", arguments.data, "DIR", "the real clips (../shared/data)");
  program.Add("config", arguments.config, "FILE", "options of the odometry, YAML");
  program.Add("references", arguments.references, "DIR",
              "what the odometry makes of the clips as taken, kept there (OUTPUT_DIR/references)");
  program.Add("seed", arguments.seed, "SEED", "this recording, not into the file");
  program.Add("plain", arguments.is_plain,
              "with seed: without transform, light and fault, forward");
  program.Add("verbose", arguments.is_verbose, "with seed: each pair");
  program.Add("dump", arguments.dump, "DIR", "with seed: writes it as a KITTI folder instead");
  program.run = [&] {
    CheckArguments(arguments);
    std::filesystem::create_directories(arguments.output);
    if (arguments.references.empty()) arguments.references = arguments.output + "/references";
    if (arguments.seed != kNoSeed) {
      RunOne(arguments);
    } else {
      RunMany(arguments);
    }
  };
  return RunProgram(argc, argv, program);
}
