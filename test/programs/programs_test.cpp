#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/geometry/kitti_poses.h"
#include "datasets/drawn_sequence.h"
#include "datasets/sequence_folder.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct Outcome {
  int status;
  std::string out, error;
};

/// Runs `command` (a program of this package and its arguments) after `environment`.
Outcome RunProgram(const SequenceFolder& folder, const std::string& command,
                   const std::string& environment = "") {
  const std::string out = folder.Root() + "/stdout", error = folder.Root() + "/stderr";
  const std::string program = environment + " " ARFM_VO_PROGRAM_DIR "/" + command;
  const int status = std::system((program + " >" + out + " 2>" + error).c_str());
  return {WEXITSTATUS(status), ReadWholeFile(out), ReadWholeFile(error)};
}

/// Drives the folder, the results below its root in `output`.
Outcome RunOdometry(const SequenceFolder& folder, const std::string& output,
                    const std::string& options = "", const std::string& environment = "") {
  return RunProgram(
      folder,
      "kitti_odometry " + folder.Path() + options + " --output " + folder.Root() + "/" + output,
      environment);
}
/// The lines `key: value`.
std::map<std::string, double> ReadLines(const std::string& text) {
  std::map<std::string, double> lines;
  std::istringstream stream(text);
  for (std::string key, value; stream >> key >> value;)
    lines[key.substr(0, key.size() - 1)] = std::stod(value);
  return lines;
}

/// That the program refuses the folder with one line that holds `complaint`, and writes nothing.
void ExpectRefused(const SequenceFolder& folder, const std::string& arguments,
                   const std::string& complaint) {
  const std::string output = folder.Root() + "/refused";
  const Outcome outcome = RunProgram(folder, arguments + " --output " + output);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.error, HasSubstr(complaint));
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  EXPECT_FALSE(fs::exists(output));
}

TEST(KittiOdometry, FollowsADrawnSequenceTheSameEachTime) {
  const SequenceFolder folder(0);
  DrawSequence(folder, 6);
  const std::string first = folder.Root() + "/first", second = folder.Root() + "/second";
  const Outcome outcome = RunOdometry(folder, "first");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(outcome.error, "");
  auto lines = ReadLines(outcome.out);
  EXPECT_EQ(lines["pairs"], 6);
  EXPECT_EQ(lines["lost"], 0);
  EXPECT_NEAR(lines["path_length_m"], 1.25, 0.05);
  EXPECT_NEAR(lines["length_ratio"], 1, 0.04);
  EXPECT_LT(lines["ate_rmse_m"], 0.05);
  EXPECT_GT(lines["ms_per_pair_p95"], 0);
  EXPECT_GT(lines["cpu_ms_per_pair"], 0);
  EXPECT_EQ(lines.count("t_rel_percent"), 0u) << "of 1.25 m";
  EXPECT_EQ(ReadKittiPoses(first + "/poses.txt").size(), 6u);
  EXPECT_TRUE(fs::exists(first + "/trajectory.png"));
  const std::string timing = ReadWholeFile(first + "/timing.csv");
  EXPECT_EQ(std::count(timing.begin(), timing.end(), '\n'), 7);

  ASSERT_EQ(RunOdometry(folder, "second").status, 0);
  for (const char* name : {"poses.txt", "poses_online.txt", "trajectory.tum", "trajectory.png"})
    EXPECT_EQ(ReadWholeFile(first + "/" + name), ReadWholeFile(second + "/" + name)) << name;
}

TEST(KittiOdometry, TakesStrideAndPairs) {
  const SequenceFolder folder(0);
  DrawSequence(folder, 6);
  const Outcome outcome = RunOdometry(folder, "out", " --stride 2 --pairs 2");
  auto lines = ReadLines(outcome.out);
  EXPECT_EQ(lines["pairs"], 2);
  EXPECT_NEAR(lines["path_length_m"], 0.5, 0.05);
  EXPECT_NEAR(lines["length_ratio"], 1, 0.1);
}

TEST(KittiOdometry, ASequenceWithNothingToSeeIsLostAndSaidSo) {
  const SequenceFolder folder(4);
  const std::string output = folder.Root() + "/out";
  const Outcome outcome = RunOdometry(folder, "out");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(ReadLines(outcome.out)["lost"], 4);
  EXPECT_EQ(ReadKittiPoses(output + "/poses.txt").size(), 4u);
  const std::string tum = ReadWholeFile(output + "/trajectory.tum");
  EXPECT_EQ(std::count(tum.begin(), tum.end(), '\n'), 1) << "the comment";
}

TEST(KittiOdometry, SaysSoWhereThePlotterIsMissing) {
  const SequenceFolder folder(2);
  const std::string output = folder.Root() + "/out";
  const Outcome outcome = RunOdometry(folder, "out", "", "PATH=/no/such/folder");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.error, "kitti_odometry: no trajectory.png: gnuplot is not installed\n");
  EXPECT_TRUE(fs::exists(output + "/poses.txt"));
  EXPECT_FALSE(fs::exists(output + "/trajectory.png"));
}

TEST(KittiOdometry, RefusesDamageWithOneLineAndWritesNothing) {
  const SequenceFolder folder(4);
  const std::string program = "kitti_odometry " + folder.Path();
  ExpectRefused(folder, "kitti_odometry /no/such/folder", "/no/such/folder: no such folder");
  const std::string png = ReadWholeFile(folder.Right(3));
  WriteWholeFile(folder.Right(3), png.substr(0, png.size() - 12));
  ExpectRefused(folder, program, folder.Right(3) + ": PNG file is truncated");
  folder.Write("calib.txt", folder.Calibration("350"));
  ExpectRefused(folder, program, "baseline");
}

TEST(KittiOdometry, NamesAMistypedConfigKey) {
  const SequenceFolder folder(2);
  folder.Write("config.yaml", "frontend:\n  no_such_key: 3\n");
  ExpectRefused(folder,
                "kitti_odometry " + folder.Path() + " --config " + folder.File("config.yaml"),
                "config.yaml:2: frontend.no_such_key: unknown key");
}

TEST(KittiOdometry, PrintsAConfigThatItReads) {
  const SequenceFolder folder(0);
  const Outcome defaults = RunProgram(folder, "kitti_odometry --print-config");
  ASSERT_EQ(defaults.status, 0);
  folder.Write("config.yaml", defaults.out);
  const Outcome again =
      RunProgram(folder, "kitti_odometry --print-config --config " + folder.File("config.yaml"));
  EXPECT_EQ(again.status, 0) << again.error;
  EXPECT_EQ(again.out, defaults.out);
}

TEST(KittiOdometry, WrongArgumentsShowTheUsage) {
  const SequenceFolder folder(2);
  for (const char* arguments : {"", "a b", "a --no-such-option", "a --pairs x"}) {
    const Outcome outcome = RunProgram(folder, std::string("kitti_odometry ") + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.error, HasSubstr("usage: kitti_odometry SEQUENCE_DIR [options]"));
  }
  EXPECT_EQ(RunProgram(folder, "kitti_odometry --help").status, 0);
  const Outcome in_the_way = RunProgram(
      folder, "kitti_odometry " + folder.Path() + " --output " + folder.File("calib.txt"));
  EXPECT_EQ(in_the_way.status, 1);
  EXPECT_THAT(in_the_way.error, HasSubstr("calib.txt: cannot be written"));
}

TEST(BagOdometry, GivesTheTrajectoryOfTheFolderThatTheBagWasMadeOf) {
  const SequenceFolder folder(0);
  DrawSequence(folder, 4);
  const std::string bag = folder.Root() + "/drawn.bag", output = folder.Root() + "/out";
  ASSERT_EQ(RunProgram(folder, "kitti_to_bag " + folder.Path() + " " + bag).status, 0);
  const Outcome outcome =
      RunProgram(folder, "bag_odometry " + bag + " --output " + output + "/bag");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(ReadLines(outcome.out)["pairs"], 4);
  EXPECT_EQ(ReadLines(outcome.out).at("unpaired_images"), 0);
  EXPECT_LT(ReadLines(outcome.out).at("ate_rmse_m"), 0.05);
  ASSERT_EQ(RunOdometry(folder, "out/kitti").status, 0);
  const auto from_bag = ReadKittiPoses(output + "/bag/poses.txt");
  const auto from_folder = ReadKittiPoses(output + "/kitti/poses.txt");
  ASSERT_EQ(from_bag.size(), from_folder.size());
  for (size_t i = 0; i < from_bag.size(); ++i)
    EXPECT_LT((from_bag[i].Matrix() - from_folder[i].Matrix()).norm(), 1e-6);

  const std::string bytes = ReadWholeFile(bag);
  WriteWholeFile(bag, bytes.substr(0, bytes.size() / 2));
  ExpectRefused(folder, "bag_odometry " + bag, "drawn.bag: ");
  ExpectRefused(folder, "bag_odometry /no/such.bag", "/no/such.bag: no such file");
}

TEST(KittiToBag, WritesNothingFromADamagedFolder) {
  const SequenceFolder folder(4);
  WriteWholeFile(folder.Right(3), "no picture");
  const Outcome outcome =
      RunProgram(folder, "kitti_to_bag " + folder.Path() + " " + folder.Path() + "/made.bag");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.error, HasSubstr(folder.Right(3) + ": is not a PNG file"));
  for (const auto& entry : fs::directory_iterator(folder.Path()))
    EXPECT_THAT(entry.path().filename(), testing::Not(HasSubstr("made.bag")));
}

TEST(EvaluateTrajectory, PrintsTheErrorsAndSaysWhatItCompares) {
  const SequenceFolder folder(0);
  std::string truth, estimate;
  for (int i = 0; i < 61; ++i) {
    truth += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(i) + "\n";
    if (i < 31) estimate += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(1.02 * i) + "\n";
  }
  folder.Write("truth.txt", truth);
  folder.Write("estimate.txt", estimate);
  const std::string program = "evaluate_trajectory " + folder.File("estimate.txt") + " ";
  const Outcome outcome = RunProgram(folder, program + folder.File("truth.txt"));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.error, HasSubstr("the first 31 are compared"));
  EXPECT_EQ(ReadLines(outcome.out)["frames"], 31);
  EXPECT_NEAR(ReadLines(outcome.out)["end_error_percent"], 2, 1e-4);
  EXPECT_EQ(RunProgram(folder, program + "/no/such/file").status, 1);
  EXPECT_EQ(RunProgram(folder, program).status, 2);
}

TEST(EvaluateTrajectory, ComparesTumFilesByTheirStamps) {
  const SequenceFolder folder(0);
  std::string truth = "# stamp x y z qx qy qz qw\n", estimate;
  for (int i = 0; i < 61; ++i) {
    // The true world is another one, and every second true pose is missing.
    if (i % 2 == 0)
      truth += std::to_string(100.001 + i) + " 5 6 " + std::to_string(7 + i) + " 0 0 0 1\n";
    estimate += std::to_string(100 + i) + " 0 0 " + std::to_string(1.02 * i) + " 0 0 0 1\n";
  }
  folder.Write("truth.tum", truth);
  folder.Write("estimate.tum", estimate);
  const std::string program = "evaluate_trajectory " + folder.File("estimate.tum") + " ";
  const Outcome outcome = RunProgram(folder, program + folder.File("truth.tum"));
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.error, HasSubstr("30 of 61 poses"));
  EXPECT_EQ(ReadLines(outcome.out)["frames"], 31);
  EXPECT_NEAR(ReadLines(outcome.out)["end_error_percent"], 2, 1e-4);
  const Outcome mixed = RunProgram(folder, program + folder.File("poses.txt"));
  EXPECT_EQ(mixed.status, 1);
  EXPECT_THAT(mixed.error, HasSubstr("one is a TUM file"));
}

}  // namespace
}  // namespace arfm_vo
