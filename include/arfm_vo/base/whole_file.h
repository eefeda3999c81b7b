#pragma once

#include <string>

namespace arfm_vo {

/// All bytes of a file. Throws std::invalid_argument naming it where it cannot be read.
std::string ReadWholeFile(const std::string& path);

/// Writes a file whole or not at all (a temporary file beside it is renamed). Throws
/// std::system_error naming it.
void WriteWholeFile(const std::string& path, const std::string& content);

}  // namespace arfm_vo
