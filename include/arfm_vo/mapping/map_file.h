#pragma once

#include <string>

#include "arfm_vo/mapping/known_map.h"

namespace arfm_vo {

/// Throws std::invalid_argument naming the first value of `other` that is not as in the map's
/// camera: its points would not lie where that camera sees them.
void CheckSameCamera(const KnownMap& map, const StereoCamera& other);

/// So many points at most has a map of `max_bytes`.
size_t MaxPoints(size_t max_bytes);

/// A map as a file's bytes, at most `max_bytes` (at least 100,000): points of keyframes that see
/// much the same are left out first, then every second place of the path.
std::string FormatMap(KnownMap map, size_t max_bytes);

/// The map of a file's bytes. Throws std::invalid_argument saying what is wrong where they are not
/// those of a whole, unchanged map that this version knows; `path` is what the file is called.
KnownMap ParseMap(const std::string& bytes, const std::string& path);

/// Writes the map whole or not at all; throws std::system_error naming the file.
void WriteMap(const std::string& path, KnownMap map, size_t max_bytes);
/// Throws std::invalid_argument as ParseMap, also where there is no such file.
KnownMap ReadMap(const std::string& path);

}  // namespace arfm_vo
