#include "arfm_vo/mapping/map_file.h"

#include <signal.h>

#include <boost/crc.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/geometry/linear_algebra.h"

// The file: kMagic, then (little-endian) uint32 version, uint32 CRC-32 of what follows, uint64
// length of what follows, and that: the fields in the order of WalkMap.

namespace arfm_vo {
namespace {

constexpr char kMagic[] = "arfm_vo map\n";
constexpr size_t kMagicSize = sizeof(kMagic) - 1;
constexpr uint32_t kVersion = 2;
constexpr size_t kHeaderSize = kMagicSize + 2 * sizeof(uint32_t) + sizeof(uint64_t);
constexpr size_t kPointSize = 3 * sizeof(float) + sizeof(Appearance);
constexpr size_t kKeyframeSize =
    sizeof(double) + 14 * sizeof(double) + sizeof(int32_t) + sizeof(uint32_t);

class Writer {
 public:
  template <class Value>
  void Take(const Value& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  /// The number of elements of a container, of so many bytes each at least.
  template <class Container>
  void TakeSize(const Container& container, size_t) {
    Take(static_cast<uint32_t>(container.size()));
  }
  std::string bytes;
};

class Reader {
 public:
  Reader(const std::string& bytes, size_t at, std::string path)
      : bytes_(bytes), at_(at), path_(std::move(path)) {}

  template <class Value>
  void Take(Value& value) {
    Check(bytes_.size() - at_ >= sizeof(value), "ends too early");
    std::memcpy(&value, bytes_.data() + at_, sizeof(value));
    at_ += sizeof(value);
  }
  template <class Container>
  void TakeSize(Container& container, size_t element_size) {
    uint32_t size = 0;
    Take(size);
    Check(size <= (bytes_.size() - at_) / element_size, "ends too early");
    container.resize(size);
  }
  void Check(bool condition, const std::string& fault) const {
    Require(condition, path_ + ": " + fault);
  }
  bool IsAtEnd() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  size_t at_;
  std::string path_;
};

/// Reads or writes, by the kind of `file`, what the file says of a map.
template <class File, class Pose>
void WalkPose(File& file, Pose& pose) {
  for (int i = 0; i < 4; ++i) file.Take(pose.rotation.coeffs()[i]);
  for (int i = 0; i < 3; ++i) file.Take(pose.translation[i]);
}

template <class File, class Point>
void WalkPoint(File& file, Point& point) {
  Eigen::Vector3f x = point.x_in_place.template cast<float>();
  for (int i = 0; i < 3; ++i) file.Take(x[i]);
  file.Take(point.appearance);
  if constexpr (std::is_same_v<File, Reader>) {
    point.x_in_place = x.cast<double>();
    file.Check(x.allFinite() && std::abs(point.appearance.laplacian_sign) == 1,
               "a point is not one");
  }
}

template <class File, class Map>
void WalkMap(File& file, Map& map) {
  file.TakeSize(map.frame_id, 1);
  for (auto& letter : map.frame_id) file.Take(letter);
  auto& camera = map.camera;
  for (auto* value : {&camera.fx, &camera.fy, &camera.cx, &camera.cy, &camera.baseline_m})
    file.Take(*value);
  for (auto* value : {&camera.width, &camera.height}) file.Take(*value);
  auto has_correction = static_cast<uint8_t>(map.correction.has_value());
  file.Take(has_correction);
  if constexpr (std::is_same_v<File, Reader>) {
    if (has_correction != 0) map.correction.emplace();
  }
  if (map.correction) {
    for (int i = 0; i < StereoCorrection::kSize; ++i)
      file.Take(map.correction->mean.coefficients_px[i]);
    for (Eigen::Index i = 0; i < map.correction->covariance.size(); ++i)
      file.Take(map.correction->covariance.data()[i]);
  }
  file.TakeSize(map.keyframes, kKeyframeSize);
  for (auto& keyframe : map.keyframes) {
    file.Take(keyframe.stamp_s);
    WalkPose(file, keyframe.map_from_camera);
    WalkPose(file, keyframe.base_from_camera);
    file.Take(keyframe.frame);
    file.TakeSize(keyframe.points, kPointSize);
    for (auto& point : keyframe.points) WalkPoint(file, point);
  }
}

void CheckMap(const Reader& file, KnownMap& map) {
  map.camera.Check();
  if (map.correction) {
    CorrectionBelief& correction = *map.correction;
    correction.is_of_earlier_drive = true;
    file.Check(correction.mean.coefficients_px.allFinite() &&
                   correction.covariance.isApprox(correction.covariance.transpose(), 1e-6) &&
                   IsPositiveDefinite(correction.covariance),
               "its learnt calibration has no covariance");
  }
  for (KnownKeyframe& keyframe : map.keyframes) {
    for (Rigid3* pose : {&keyframe.map_from_camera, &keyframe.base_from_camera}) {
      file.Check(pose->IsFinite() && std::abs(pose->rotation.norm() - 1) < 1e-6,
                 "a pose is not one");
    }
    file.Check(std::isfinite(keyframe.stamp_s), "a stamp is not finite");
    file.Check(keyframe.frame >= 0 && keyframe.frame < 1 << 30, "a frame has no such number");
    keyframe.SetPoints(std::move(keyframe.points));
  }
}

uint32_t Checksum(const char* data, size_t size) {
  boost::crc_32_type crc;
  crc.process_bytes(data, size);
  return crc.checksum();
}

}  // namespace

void CheckSameCamera(const KnownMap& map, const StereoCamera& other) {
  const auto check = [](const char* name, double known, double value) {
    Require(known == value, std::string("it is of another camera: its ") + name + " is " +
                                FormatNumber(known) + ", that of the camera now " +
                                FormatNumber(value));
  };
  check("width", map.camera.width, other.width);
  check("height", map.camera.height, other.height);
  check("fx", map.camera.fx, other.fx);
  check("fy", map.camera.fy, other.fy);
  check("cx", map.camera.cx, other.cx);
  check("cy", map.camera.cy, other.cy);
  check("baseline", map.camera.baseline_m, other.baseline_m);
}

size_t MaxPoints(size_t max_bytes) { return max_bytes / kPointSize; }

std::string FormatMap(KnownMap map, size_t max_bytes) {
  Require(max_bytes >= 100000, "a map needs 100 kB");
  const size_t fixed = kHeaderSize + map.frame_id.size() + sizeof(CorrectionBelief) + 100;
  const auto of_path = [&] { return fixed + map.keyframes.size() * kKeyframeSize; };
  while (of_path() > max_bytes / 2) {
    for (size_t i = 0; 2 * i < map.keyframes.size(); ++i)
      std::swap(map.keyframes[i], map.keyframes[2 * i]);
    map.keyframes.resize((map.keyframes.size() + 1) / 2);
  }
  KeepAtMost(MaxPoints(max_bytes - of_path()), map.keyframes);
  Writer file;
  file.bytes.reserve(of_path() + NumPoints(map.keyframes) * kPointSize);
  file.bytes.assign(kHeaderSize, '\0');
  WalkMap(file, map);
  const size_t size = file.bytes.size() - kHeaderSize;
  Writer header;
  header.bytes.assign(kMagic, kMagicSize);
  header.Take(kVersion);
  header.Take(Checksum(&file.bytes[kHeaderSize], size));
  header.Take(static_cast<uint64_t>(size));
  file.bytes.replace(0, kHeaderSize, header.bytes);
  return std::move(file.bytes);
}

KnownMap ParseMap(const std::string& bytes, const std::string& path) {
  Require(bytes.compare(0, kMagicSize, kMagic, kMagicSize) == 0, path + ": is not a map");
  Reader file(bytes, kMagicSize, path);
  uint32_t version = 0, checksum = 0;
  uint64_t size = 0;
  file.Take(version);
  file.Check(version <= kVersion, "is of version " + std::to_string(version) +
                                      ", newer than this program's, " + std::to_string(kVersion));
  file.Check(version == kVersion, "is of version " + std::to_string(version) +
                                      ", older than this program's, " + std::to_string(kVersion) +
                                      ": its cameras have another model; make the map anew");
  file.Take(checksum);
  file.Take(size);
  file.Check(size == bytes.size() - kHeaderSize,
             "has " + std::to_string(bytes.size() - kHeaderSize) + " bytes of a map of " +
                 std::to_string(size) + ": it is not whole");
  file.Check(checksum == Checksum(bytes.data() + kHeaderSize, size),
             "its checksum is wrong: it is damaged");
  KnownMap map;
  WalkMap(file, map);
  file.Check(file.IsAtEnd(), "goes on after its end");
  CheckMap(file, map);
  return map;
}

void WriteMap(const std::string& path, KnownMap map, size_t max_bytes) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(path).parent_path();
  std::error_code ignored;  // the write tells
  fs::create_directories(folder, ignored);
  // What processes that were killed have left, WriteWholeFile's name for it.
  const std::string partial = fs::path(path).filename().string() + ".partial.";
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename();
    const int process =
        name.compare(0, partial.size(), partial) == 0 ? std::atoi(&name[partial.size()]) : 0;
    if (process > 0 && kill(process, 0) != 0 && errno == ESRCH) fs::remove(entry.path(), ignored);
  }
  WriteWholeFile(path, FormatMap(std::move(map), max_bytes));
}

KnownMap ReadMap(const std::string& path) { return ParseMap(ReadWholeFile(path), path); }

}  // namespace arfm_vo
