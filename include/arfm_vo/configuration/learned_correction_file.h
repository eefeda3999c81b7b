#pragma once

#include <optional>
#include <string>

#include "arfm_vo/geometry/correction_belief.h"

namespace arfm_vo {

/// Writes what drives have told of a camera's stereo correction, with the camera that it belongs
/// to, as YAML: whole or not at all. Throws std::system_error naming the file.
void WriteLearnedCorrection(const std::string& path, const StereoCamera& camera,
                            const CorrectionBelief& correction);

/// What the file says, as a belief of an earlier drive. Nothing where there is no such file, or it
/// belongs to a camera with other values. Throws std::invalid_argument naming file and key where
/// the file is not as written.
std::optional<CorrectionBelief> ReadLearnedCorrection(const std::string& path,
                                                      const StereoCamera& camera);

/// A file name of its own for each camera: its size and a hash of its values.
std::string NameLearnedCorrection(const StereoCamera& camera);

}  // namespace arfm_vo
