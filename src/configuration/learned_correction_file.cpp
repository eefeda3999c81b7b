#include "arfm_vo/configuration/learned_correction_file.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <vector>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/format.h"
#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/configuration/yaml_writer.h"
#include "arfm_vo/geometry/linear_algebra.h"

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

struct LearnedFile {
  std::vector<double> camera, mean_px, covariance_px2;

  void Check() const {
    RequireLength(camera, CameraValues({}).size(), "camera");
    RequireLength(mean_px, StereoCorrection::kSize, "mean_px");
    RequireLength(covariance_px2, CorrectionBelief::Matrix::SizeAtCompileTime, "covariance_px2");
  }
  ARFM_FIELDS(camera, mean_px, covariance_px2)

 private:
  static void RequireLength(const std::vector<double>& list, size_t size, const char* key) {
    Require(list.size() == size,
            Format("%s must be a list of %zu numbers: delete the file if another version has "
                   "written it",
                   key, size));
  }
};

}  // namespace

void WriteLearnedCorrection(const std::string& path, const StereoCamera& camera,
                            const CorrectionBelief& correction) {
  const auto& mean = correction.mean.coefficients_px;
  const auto& covariance = correction.covariance;
  const LearnedFile file{CameraValues(camera),
                         {mean.data(), mean.data() + mean.size()},
                         {covariance.data(), covariance.data() + covariance.size()}};
  const auto parent = std::filesystem::path(path).parent_path();
  std::error_code ignored;  // the write tells
  if (!parent.empty()) std::filesystem::create_directories(parent, ignored);
  WriteWholeFile(
      path,
      "# What drives have told of a stereo camera's rectification (geometry/stereo_correction.h).\n"
      "# Delete the file to forget it.\n"
      "# camera: fx, fy, cx, cy (px), baseline (m), width, height (px)\n" +
          WriteYaml(file));
}

std::optional<CorrectionBelief> ReadLearnedCorrection(const std::string& path,
                                                      const StereoCamera& camera) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  const auto file = ReadYamlFile<LearnedFile>(path);
  if (file.camera != CameraValues(camera)) return std::nullopt;
  CorrectionBelief correction;
  correction.mean.coefficients_px =
      Eigen::Map<const StereoCorrection::Coefficients>(file.mean_px.data());
  correction.covariance = Eigen::Map<const CorrectionBelief::Matrix>(file.covariance_px2.data());
  correction.is_of_earlier_drive = true;
  Require(correction.covariance.isApprox(correction.covariance.transpose(), 1e-6) &&
              IsPositiveDefinite(correction.covariance),
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
