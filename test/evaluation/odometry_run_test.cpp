#include "arfm_vo/evaluation/odometry_run.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/evaluation/run_report.h"
#include "arfm_vo/geometry/kitti_poses.h"
#include "base/folder_test.h"

namespace arfm_vo {
namespace {

using testing::HasSubstr;

namespace fs = std::filesystem;

/// `num_pairs` pairs 0.5 s apart; truth 1 m a pair along z, where `has_truth`.
class FakeSequence : public StereoSequence {
 public:
  explicit FakeSequence(int num_pairs, bool has_truth = true)
      : num_pairs_(num_pairs), has_truth_(has_truth) {}
  const StereoCamera& camera() const override { return camera_; }
  int size() const override { return num_pairs_; }
  std::optional<SequencePair> Next() override {
    if (next_ == num_pairs_) return std::nullopt;
    SequencePair pair;
    pair.images.stamp_s = 0.5 * next_;
    if (has_truth_) {
      pair.true_world_from_camera =
          Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(7, 0, next_));
    }
    ++next_;
    return pair;
  }

 private:
  StereoCamera camera_;
  int num_pairs_, next_ = 0;
  bool has_truth_;
};

/// Says 1.01 m a pair at once and 1.02 m in the end; loses pair 2. Every third pair is a keyframe.
class FakeOdometry {
 public:
  SessionUpdate Process(const StereoImages& images) {
    const int pair = static_cast<int>(trajectory_.size());
    const bool is_tracked = pair != 2;
    trajectory_.push_back({images.stamp_s, At(1.02 * pair), is_tracked});
    SessionUpdate pose;
    OdometryUpdate& update = pose.update;
    update.pose.status = is_tracked ? PoseStatus::kTracked : PoseStatus::kNoConsensus;
    pose.odom_from_base = At(1.01 * (is_tracked ? pair : pair - 1));
    update.stage_ms = {{"features", 2}};
    if (pair % 3 == 1) update.stage_ms.emplace_back("adjustment", 5.25);
    return pose;
  }
  Trajectory Finish() { return trajectory_; }

 private:
  static Rigid3 At(double z) { return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, z)}; }
  Trajectory trajectory_;
};

OdometryRun RunFakes(int num_pairs, bool has_truth = true) {
  FakeSequence sequence(num_pairs, has_truth);
  FakeOdometry odometry;
  return RunOdometry(sequence, odometry, [](int, int) {});
}

TEST(RunOdometry, TakesEveryPairAndReportsProgress) {
  FakeSequence sequence(5);
  FakeOdometry odometry;
  std::vector<int> reported;
  const OdometryRun run = RunOdometry(sequence, odometry, [&](int done, int all) {
    EXPECT_EQ(all, 5);
    reported.push_back(done);
  });
  EXPECT_EQ(reported, (std::vector<int>{1, 2, 3, 4, 5}));
  EXPECT_EQ(run.trajectory.size(), 5u);
  EXPECT_EQ(run.pair_ms.size(), 5u);
  EXPECT_EQ(run.CountLost(), 1);
  EXPECT_GE(run.cpu_s, 0);
}

TEST(RunOdometry, HoldsTheLastPoseWhereAPairIsLost) {
  const OdometryRun run = RunFakes(5);
  EXPECT_NEAR(run.online[1].world_from_camera.translation.z(), 1.01, 1e-12);
  EXPECT_NEAR(run.online[2].world_from_camera.translation.z(), 1.01, 1e-12);
  EXPECT_FALSE(run.online[2].is_tracked);
}

TEST(FormatRun, SaysTheErrorsWhereTheTruthIsKnown) {
  const std::string text = FormatRun(RunFakes(101));
  EXPECT_THAT(text,
              testing::StartsWith("pairs: 101\nlost: 1\ndegraded: 0\npath_length_m: 102.0000\n"));
  EXPECT_THAT(text, HasSubstr("\nend_error_percent: 2.00000\n"));
  EXPECT_THAT(text, testing::EndsWith("\nlength_ratio: 1.02000\n"));
  EXPECT_THAT(text, HasSubstr("\nlive_length_ratio: 1.01000\n"));
  EXPECT_LT(text.find("live_length_ratio"), text.find("\nlength_ratio"));
  for (const char* key :
       {"ms_per_pair_median", "ms_per_pair_p95", "cpu_ms_per_pair", "peak_rss_mb",
        "t_rel_short_percent", "r_rel_short_deg_per_m", "ate_rmse_m", "live_t_rel_short_percent",
        "live_ate_rmse_m", "live_end_error_percent"}) {
    EXPECT_THAT(text, HasSubstr(std::string("\n") + key + ": ")) << key;
  }
}

TEST(FormatRun, SaysNoErrorsWithoutTruth) {
  EXPECT_THAT(FormatRun(RunFakes(5, false)), testing::Not(HasSubstr("ate_rmse_m")));
}

TEST(FormatRun, LeavesFramesWithoutTruthOut) {
  OdometryRun run = RunFakes(101);
  for (int i = 0; i < 50; ++i) run.truth[i].reset();
  const PathComparison comparison = CompareWithTruth(run, run.trajectory);
  ASSERT_EQ(comparison.truth.size(), 51u);
  EXPECT_EQ(comparison.truth[0].translation.z(), 50);
  EXPECT_NEAR(comparison.estimate[0].translation.z(), 51, 1e-9);
}

TEST(FormatTiming, HasAColumnAStage) {
  OdometryRun run = RunFakes(2);
  run.pair_ms = {7.5, 8};
  ASSERT_EQ(run.memory_mb.size(), 2u);
  for (const double megabytes : run.memory_mb) EXPECT_GT(megabytes, 1);
  run.memory_mb = {90, 91.25};
  run.states[0] = {PoseStatus::kTracked, Reason::kNone, 5.25, 90, 80};
  run.states[1] = {PoseStatus::kNoConsensus, Reason::kGroundHidden, -1, 30, 0};
  EXPECT_EQ(
      FormatTiming(run),
      "frame,stamp_s,total_ms,memory_mb,state,reason,log_odds,matches,inliers,features,"
      "adjustment\n"
      "0,0,7.500,90.00,tracked,\"\",5.2,90,80,2.000,\n"
      "1,0.5,8.000,91.25,no consensus,\"what is seen moves otherwise than the ground is known "
      "to\",-1.0,30,0,2.000,5.250\n");
}

class RunFilesTest : public FolderTest {
 protected:
  std::vector<std::string> List(const fs::path& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }
};

TEST_F(RunFilesTest, FillsTheFolderAndNothingElse) {
  const std::string complaint = WriteRun(RunFakes(20), folder_ / "deep's" / "out");
  std::vector<std::string> expected = {"poses.txt", "poses_online.txt", "timing.csv"};
  expected.push_back("tracked.txt");
  if (complaint.empty()) expected.push_back("trajectory.png");
  expected.push_back("trajectory.tum");
  EXPECT_EQ(List(folder_ / "deep's" / "out"), expected);
  EXPECT_EQ(ReadKittiPoses(folder_ / "deep's" / "out" / "poses.txt").size(), 20u);
}

TEST_F(RunFilesTest, KeepsWhatElseIsInTheFolder) {
  WriteWholeFile(folder_ / "notes", "mine");
  WriteWholeFile(folder_ / "poses.txt", "old");
  WriteRun(RunFakes(3), folder_);
  EXPECT_EQ(ReadWholeFile(folder_ / "notes"), "mine");
  EXPECT_EQ(ReadKittiPoses(folder_ / "poses.txt").size(), 3u);
}

TEST_F(RunFilesTest, WhatIsInTheWayIsAnErrorBeforeTheRun) {
  WriteWholeFile(folder_ / "file", "mine");
  EXPECT_THROW(CheckCanWriteRun(folder_ / "file"), std::system_error);
  EXPECT_THROW(CheckCanWriteRun(folder_ / "file" / "below"), std::system_error);
  EXPECT_NO_THROW(CheckCanWriteRun(folder_ / "new" / "folder"));
  EXPECT_FALSE(fs::exists(folder_ / "new"));
  EXPECT_THROW(WriteRun(RunFakes(3), folder_ / "file" / "below"), std::system_error);
  EXPECT_EQ(ReadWholeFile(folder_ / "file"), "mine");
}

}  // namespace
}  // namespace arfm_vo
