#include "arfm_vo/base/whole_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <vector>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

[[noreturn]] void ThrowWriteError(const std::string& path) {
  throw std::system_error(errno, std::generic_category(), path + ": cannot be written");
}

}  // namespace

std::string ReadWholeFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string content;
  std::vector<char> part(1 << 18);
  while (file.read(part.data(), part.size()), file.gcount() > 0) {
    content.append(part.data(), file.gcount());
  }
  Require(file.eof() && !file.bad(), path + ": cannot be read");
  return content;
}

void WriteWholeFile(const std::string& path, const std::string& content) {
  const std::string partial = path + ".partial." + std::to_string(getpid());
  FILE* file = std::fopen(partial.c_str(), "wb");
  if (!file) ThrowWriteError(path);
  // On the disk before it has the name: else a power cut may leave the name to an empty file.
  bool is_written = std::fwrite(content.data(), 1, content.size(), file) == content.size() &&
                    std::fflush(file) == 0 && fsync(fileno(file)) == 0;
  int error = errno;
  if (std::fclose(file) != 0 && is_written) {
    error = errno;
    is_written = false;
  }
  if (is_written && std::rename(partial.c_str(), path.c_str()) == 0) return;
  if (is_written) error = errno;
  std::remove(partial.c_str());
  errno = error;
  ThrowWriteError(path);
}

}  // namespace arfm_vo
