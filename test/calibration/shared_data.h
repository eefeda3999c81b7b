#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace arfm_vo {

/// A folder of the real data beside the checkout (or of $ARFM_VO_SHARED); may not be there.
inline std::filesystem::path SharedFolder(const std::string& name) {
  const char* shared = std::getenv("ARFM_VO_SHARED");
  const std::filesystem::path base =
      shared ? shared : std::filesystem::path(ARFM_VO_SOURCE_DIR) / ".." / "shared";
  return base / name;
}

}  // namespace arfm_vo
