#include "arfm_vo/base/whole_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <vector>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

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
  const std::string complaint = path + ": cannot be written";
  if (!file) ThrowSystemError(complaint);
  int error = 0;  // the first
  const auto note = [&error](bool is_done) {
    if (!is_done && error == 0) error = errno;
  };
  // On the disk before it has the name: else a power cut may leave the name to an empty file.
  note(std::fwrite(content.data(), 1, content.size(), file) == content.size() &&
       std::fflush(file) == 0 && fsync(fileno(file)) == 0);
  note(std::fclose(file) == 0);
  if (error == 0) note(std::rename(partial.c_str(), path.c_str()) == 0);
  if (error == 0) return;
  std::remove(partial.c_str());
  ThrowSystemError(complaint, error);
}

}  // namespace arfm_vo
