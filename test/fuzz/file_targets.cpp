#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "arfm_vo/configuration/learned_correction_file.h"
#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/configuration/yaml_writer.h"
#include "arfm_vo/datasets/kitti_files.h"
#include "arfm_vo/geometry/kitti_poses.h"
#include "arfm_vo/image/png_image.h"
#include "arfm_vo/mapping/localiser.h"
#include "arfm_vo/mapping/map_file.h"
#include "arfm_vo/odometry/trajectory_files.h"
#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/ros/replay/bag_sequence.h"
#include "arfm_vo/ros/rover/chassis_node.h"
#include "fuzz/fuzz_targets.h"
#include "fuzz/memory_file.h"
#include "fuzz/promise.h"

namespace arfm_vo {
namespace {

/// Larger pictures take the decoder's time, not its mistakes.
constexpr int kMaxPixels = 1 << 20;

/// Of four bytes, the highest first.
uint32_t NumberAt(const std::string& png, size_t at) {
  uint32_t value = 0;
  for (size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<uint8_t>(png[i]);
  return value;
}

/// Puts in the checksums of PNG chunks, which no fuzzer guesses.
std::string WithChecksums(std::string png) {
  for (size_t chunk = 8; chunk + 12 <= png.size();) {
    const size_t length = NumberAt(png, chunk);
    if (length > png.size() - chunk - 12) break;
    const auto* data = reinterpret_cast<const unsigned char*>(png.data()) + chunk + 4;
    const auto checksum = static_cast<uint32_t>(crc32_z(0, data, length + 4));
    for (int i = 0; i < 4; ++i)
      png[chunk + 8 + length + i] = static_cast<char>(checksum >> (24 - 8 * i));
    chunk += length + 12;
  }
  return png;
}

void ReadPng(const std::string& bytes) {
  const std::string png = WithChecksums(bytes);
  const MemoryFile file(png);
  const bool has_size = png.size() >= 24;
  const uint64_t width = has_size ? NumberAt(png, 16) : 0,
                 height = has_size ? NumberAt(png, 20) : 0;
  if (width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels) return;
  GreyWindow window;
  for (int i = 0; i < 2; ++i) {
    Takes([&] {
      const cv::Mat image = ReadGreyPng(file.path(), window);
      Promise(image.type() == CV_8UC1 && image.size() == cv::Size(width, height),
              "a PNG has the size that it says");
    });
  }
}

void ReadCalibration(const std::string& bytes) {
  const MemoryFile file(bytes);
  for (const int left : {0, 2}) {
    Takes([&] {
      const StereoCamera camera = ReadKittiCalibration(file.path(), left, 1226, 370);
      camera.Check();
    });
  }
}

void ReadTimes(const std::string& bytes) {
  const MemoryFile file(bytes);
  Takes([&] {
    const std::vector<double> stamps = ReadKittiTimes(file.path());
    Promise(std::is_sorted(stamps.begin(), stamps.end()), "times increase");
    for (const double stamp : stamps) Promise(std::isfinite(stamp), "times are finite");
  });
}

void ReadPoses(const std::string& bytes) {
  const MemoryFile file(bytes);
  Takes([&] {
    for (const Rigid3& pose : ReadKittiPoses(file.path()))
      Promise(pose.IsFinite() && std::abs(pose.rotation.norm() - 1) < 1e-9, "poses are poses");
  });
}

void ReadTum(const std::string& bytes) {
  const MemoryFile file(bytes);
  Takes([&] {
    const Trajectory trajectory = ReadTumTrajectory(file.path());
    const MemoryFile again(FormatTum(trajectory));
    Promise(ReadTumTrajectory(again.path()).size() == trajectory.size(),
            "a trajectory that was read can be written and read");
  });
}

template <class Options>
void ReadOptions(const std::string& path) {
  Takes([&] {
    const auto options = ReadYamlFile<Options>(path);
    const std::string text = WriteYaml(options);
    const MemoryFile again(text);
    Promise(WriteYaml(ReadYamlFile<Options>(again.path())) == text,
            "options that were read can be written and read");
  });
}

void ReadYamlOptions(const std::string& bytes) {
  const MemoryFile file(bytes);
  ReadOptions<OdometryOptions>(file.path());
  ReadOptions<ChassisNodeOptions>(file.path());
}

void ReadLearned(const std::string& bytes) {
  const MemoryFile file(bytes);
  const StereoCamera camera{700, 700, 600, 180, 0.5, 1226, 370};
  Takes([&] {
    const auto correction = ReadLearnedCorrection(file.path(), camera);
    if (correction) Promise(correction->covariance.allFinite(), "a covariance is finite");
  });
}

/// Puts in the length and checksum, which no fuzzer guesses.
void ReadMapFile(std::string bytes) {
  constexpr size_t kHeaderSize = 28;
  Takes([&] { ParseMap(bytes, "map"); });
  if (bytes.size() < kHeaderSize) return;
  const uint64_t length = bytes.size() - kHeaderSize;
  const auto* body = reinterpret_cast<const unsigned char*>(bytes.data()) + kHeaderSize;
  const auto checksum = static_cast<uint32_t>(crc32_z(0, body, length));
  std::memcpy(&bytes[16], &checksum, sizeof(checksum));
  std::memcpy(&bytes[20], &length, sizeof(length));
  Takes([&] {
    const KnownMap map = ParseMap(bytes, "map");
    const std::string again = FormatMap(map, 1 << 30);
    Promise(FormatMap(ParseMap(again, "map"), 1 << 30) == again,
            "a map that was read can be written and read");
    Localiser localiser;
    localiser.Keep(map, 1000);
    Promise(localiser.state() != MapState::kLocalised, "nothing is found before it is looked for");
  });
}

void ReadBag(const std::string& bytes) {
  const MemoryFile file(bytes);
  Takes([&] {
    BagSequence bag(file.path(), StereoTopics());
    double last_s = -1;
    while (const auto pair = bag.Next()) {
      pair->images.Check();
      Promise(pair->images.stamp_s > last_s, "stamps increase");
      last_s = pair->images.stamp_s;
    }
  });
}

}  // namespace

std::vector<FuzzTarget> FileTargets() {
  return {{"png", ReadPng},
          {"kitti_calibration", ReadCalibration},
          {"kitti_times", ReadTimes},
          {"kitti_poses", ReadPoses},
          {"tum", ReadTum},
          {"options", ReadYamlOptions},
          {"learned", ReadLearned},
          {"bag", ReadBag},
          {"map", [](const std::string& bytes) { ReadMapFile(bytes); }}};
}

}  // namespace arfm_vo
