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
  std::ofstream file(partial, std::ios::binary);
  if (!file) ThrowWriteError(path);
  file << content << std::flush;
  file.close();
  if (!file || std::rename(partial.c_str(), path.c_str()) != 0) {
    const int error = errno;
    std::remove(partial.c_str());
    errno = error;
    ThrowWriteError(path);
  }
}

}  // namespace arfm_vo
