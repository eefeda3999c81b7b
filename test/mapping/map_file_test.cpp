#include "arfm_vo/mapping/map_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "arfm_vo/base/random.h"
#include "arfm_vo/base/whole_file.h"
#include "base/folder_test.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

const StereoCamera kCamera{400, 410, 320, 240, 0.3, 640, 480};

KnownMap MakeMap(int num_keyframes, int num_points = 40) {
  RandomEngine engine(5);
  KnownMap map{"map", kCamera, CorrectionBelief::Isotropic(0.1), {}};
  map.correction->is_of_earlier_drive = true;
  for (int k = 0; k < num_keyframes; ++k) {
    KnownKeyframe& keyframe = map.keyframes.emplace_back();
    keyframe.stamp_s = 100 + k;
    keyframe.map_from_camera = {ExpSO3({0, 0.1 * k, 0}), {2.0 * k, 0, 1}};
    keyframe.base_from_camera = {ExpSO3({0.5, 0, 0}), {0.1, 0.2, 1}};
    keyframe.frame = k % 2;
    Place points;
    for (int i = 0; i < num_points; ++i) {
      std::array<float, 64> descriptor{};
      for (float& value : descriptor) value = static_cast<float>(RandomUnit(engine) - 0.5);
      points.push_back({i, {RandomUnit(engine), RandomUnit(engine), 4}, {descriptor.data(), 1}});
    }
    keyframe.SetPoints(std::move(points));
  }
  return map;
}

std::string Refusal(const std::string& bytes) {
  return RefusalOf([&] { ParseMap(bytes, "a.map"); });
}

class MapFileTest : public FolderTest {
 protected:
  const std::string path_ = folder_ / "a.map";
};

TEST_F(MapFileTest, ReadsWhatWasWritten) {
  const KnownMap map = MakeMap(3);
  WriteMap(path_, map, 1000000);
  const KnownMap read = ReadMap(path_);
  EXPECT_EQ(read.frame_id, "map");
  EXPECT_TRUE(read.camera == kCamera);
  EXPECT_TRUE(*read.correction == *map.correction);
  ASSERT_EQ(read.keyframes.size(), 3u);
  for (size_t k = 0; k < 3; ++k) {
    const KnownKeyframe &was = map.keyframes[k], &is = read.keyframes[k];
    EXPECT_EQ(is.stamp_s, was.stamp_s);
    EXPECT_EQ(is.frame, was.frame);
    EXPECT_EQ(is.map_from_camera.Matrix(), was.map_from_camera.Matrix());
    EXPECT_EQ(is.base_from_camera.Matrix(), was.base_from_camera.Matrix());
    ASSERT_EQ(is.points.size(), 40u);
    EXPECT_NEAR(is.distance_m, was.distance_m, 1e-6);
    for (size_t i = 0; i < 40; ++i) {
      EXPECT_LT((is.points[i].x_in_place - was.points[i].x_in_place).norm(), 1e-6);
      EXPECT_EQ(is.points[i].appearance.SquaredDistance(was.points[i].appearance), 0);
    }
  }
  EXPECT_EQ(FormatMap(read, 1000000), FormatMap(map, 1000000));
}

TEST_F(MapFileTest, IsBoundedAndKeepsPlacesThatDiffer) {
  for (const int num_keyframes : {100, 2000}) {
    const std::string bytes = FormatMap(MakeMap(num_keyframes), 200000);
    EXPECT_LE(bytes.size(), 200000u);
    EXPECT_GT(bytes.size(), 100000u);
    const KnownMap read = ParseMap(bytes, "a.map");
    EXPECT_GT(NumPoints(read.keyframes), 200u);
    EXPECT_EQ(read.keyframes.front().stamp_s, 100);
  }
}

TEST_F(MapFileTest, IsRefusedWithItsReason) {
  const std::string good = FormatMap(MakeMap(2), 1000000);
  const auto with = [&](size_t at, char byte) {
    std::string bytes = good;
    bytes[at] = byte;
    return bytes;
  };
  const std::vector<std::pair<std::string, std::string>> table = {
      {"", "a.map: is not a map"},
      {"P5 640 480 255\n", "a.map: is not a map"},
      {with(0, 'A'), "a.map: is not a map"},
      {with(12, 3), "a.map: is of version 3, newer than this program's, 2"},
      {with(12, 1), "a.map: is of version 1, older than this program's, 2"},
      {good.substr(0, 14), "a.map: ends too early"},
      {good.substr(0, good.size() - 1), "it is not whole"},
      {good + "x", "it is not whole"},
      {with(good.size() - 5, 77), "a.map: its checksum is wrong: it is damaged"},
  };
  for (const auto& [bytes, reason] : table)
    EXPECT_NE(Refusal(bytes).find(reason), std::string::npos) << Refusal(bytes) << " / " << reason;
  EXPECT_THROW(ReadMap(folder_ / "none.map"), std::invalid_argument);
}

TEST_F(MapFileTest, AThousandDamagedFilesAreRefused) {
  const std::string good = FormatMap(MakeMap(4), 1000000);
  RandomEngine engine(3);
  const auto at = [&](size_t size) { return static_cast<size_t>(RandomUnit(engine) * size); };
  for (int i = 0; i < 1000; ++i) {
    std::string bytes = good;
    if (i % 3 == 0) {
      bytes.resize(at(bytes.size()));
    } else if (i % 3 == 1) {
      bytes[at(bytes.size())] ^= static_cast<char>(1 << at(8));
    } else {
      for (char& byte : bytes) byte = static_cast<char>(at(256));
    }
    EXPECT_NE(Refusal(bytes), "") << i;
  }
}

TEST_F(MapFileTest, NamesTheValueOfAnotherCamera) {
  StereoCamera other = kCamera;
  EXPECT_NO_THROW(CheckSameCamera(MakeMap(1), other));
  other.fy = 411;
  EXPECT_EQ(RefusalOf([&] { CheckSameCamera(MakeMap(1), other); }),
            "it is of another camera: its fy is 410, that of the camera now 411");
}

/// Runs `save` in a process of its own, which is killed after `kill_after_us` unless that is 0.
void InAnotherProcess(const std::function<void()>& save, int kill_after_us) {
  const pid_t child = fork();
  if (child == 0) {
    save();
    _exit(0);
  }
  if (kill_after_us > 0) {
    usleep(kill_after_us);
    kill(child, SIGKILL);
  }
  waitpid(child, nullptr, 0);
}

TEST_F(MapFileTest, KilledInTheMiddleOfASaveItIsTheOldOrTheNew) {
  const KnownMap old = MakeMap(30), with_more = MakeMap(60);
  const std::string old_bytes = FormatMap(old, 10000000);
  const std::string new_bytes = FormatMap(with_more, 10000000);
  int num_old = 0;
  for (int i = 0; i < 100; ++i) {
    WriteWholeFile(path_, old_bytes);
    InAnotherProcess([&] { WriteWholeFile(path_, new_bytes); }, 1 + 40 * i);
    const std::string bytes = ReadWholeFile(path_);
    EXPECT_TRUE(bytes == old_bytes || bytes == new_bytes) << i;
    num_old += bytes == old_bytes;
  }
  EXPECT_GT(num_old, 0);
  WriteMap(path_, old, 10000000);  // takes away what is left of them
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(MapFileTest, OnAFullDiskTheOldOneStays) {
  WriteMap(path_, MakeMap(3), 1000000);
  const std::string old_bytes = ReadWholeFile(path_);
  InAnotherProcess(
      [&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{20000, 20000};
        setrlimit(RLIMIT_FSIZE, &limit);
        try {
          WriteMap(path_, MakeMap(30), 1000000);
          std::remove(path_.c_str());  // the test fails
        } catch (const std::system_error&) {
        }
      },
      0);
  EXPECT_EQ(ReadWholeFile(path_), old_bytes);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace arfm_vo
