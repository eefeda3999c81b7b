#include "arfm_vo/configuration/learned_correction_file.h"

#include <Eigen/Cholesky>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <vector>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/format.h"
#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/configuration/yaml_reader.h"

namespace arfm_vo {
namespace {

std::vector<double> CameraValues(const StereoCamera& camera) {
  return {camera.fx,
          camera.fy,
          camera.cx,
          camera.cy,
          camera.baseline_m,
          static_cast<double>(camera.width),
          static_cast<double>(camera.height)};
}

std::string FormatList(const char* key, const double* values, size_t size) {
  std::string text = std::string(key) + ": [";
  for (size_t i = 0; i < size; ++i) text += (i > 0 ? ", " : "") + FormatNumber(values[i]);
  return text + "]\n";
}

std::vector<double> ReadList(const YAML::Node& file, const char* key, size_t size,
                             const std::string& path) {
  const std::string name = path + ": " + key;
  const YAML::Node node = file[key];
  Require(node && node.IsSequence() && node.size() == size,
          name + " must be a list of " + std::to_string(size) +
              " numbers: delete the file if another version has written it");
  std::vector<double> values;
  for (const YAML::Node& value : node) {
    const std::vector<double> number = ParseNumbers(value.Scalar(), name);
    Require(number.size() == 1, name + ": '" + value.Scalar() + "' is not a number");
    values.push_back(number[0]);
  }
  return values;
}

YAML::Node Parse(const std::string& path) {
  const YAML::Node file = LoadYamlFile(path);
  Require(file.IsMap(), path + ": is not a file of learned calibration");
  return file;
}

}  // namespace

void WriteLearnedCorrection(const std::string& path, const StereoCamera& camera,
                            const CorrectionBelief& correction) {
  const std::vector<double> values = CameraValues(camera);
  const auto parent = std::filesystem::path(path).parent_path();
  std::error_code ignored;  // the write tells
  if (!parent.empty()) std::filesystem::create_directories(parent, ignored);
  WriteWholeFile(
      path,
      "# What drives have told of a stereo camera's rectification (geometry/stereo_correction.h).\n"
      "# Delete the file to forget it.\n"
      "# camera: fx, fy, cx, cy (px), baseline (m), width, height (px)\n" +
          FormatList("camera", values.data(), values.size()) +
          FormatList("mean_px", correction.mean.coefficients_px.data(), StereoCorrection::kSize) +
          FormatList("covariance_px2", correction.covariance.data(), correction.covariance.size()));
}

std::optional<CorrectionBelief> ReadLearnedCorrection(const std::string& path,
                                                      const StereoCamera& camera) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  const YAML::Node file = Parse(path);
  const std::vector<double> values = CameraValues(camera);
  if (ReadList(file, "camera", values.size(), path) != values) return std::nullopt;
  CorrectionBelief correction;
  const auto mean = ReadList(file, "mean_px", StereoCorrection::kSize, path);
  const auto covariance = ReadList(file, "covariance_px2", correction.covariance.size(), path);
  correction.mean.coefficients_px = Eigen::Map<const StereoCorrection::Coefficients>(mean.data());
  correction.covariance = Eigen::Map<const CorrectionBelief::Matrix>(covariance.data());
  correction.is_of_earlier_drive = true;
  Require(correction.covariance.isApprox(correction.covariance.transpose(), 1e-6) &&
              correction.covariance.llt().info() == Eigen::Success,
          path + ": covariance_px2 is not a covariance");
  return correction;
}

std::string NameLearnedCorrection(const StereoCamera& camera) {
  uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (const double value : CameraValues(camera)) {
    unsigned char bytes[sizeof(value)];
    std::memcpy(bytes, &value, sizeof(value));
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211u;
  }
  return Format("%dx%d-%016llx.yaml", camera.width, camera.height,
                static_cast<unsigned long long>(hash));
}

}  // namespace arfm_vo
