#include "arfm_vo/evaluation/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <string>

namespace arfm_vo {

ProgressBar::ProgressBar(std::FILE* stream) : stream_(isatty(fileno(stream)) ? stream : nullptr) {}

ProgressBar::~ProgressBar() {
  if (stream_) std::fputs("\r\x1b[K", stream_);
}

void ProgressBar::Show(int done, int all) {
  if (!stream_) return;
  constexpr int kWidth = 50;
  const int filled = all > 0 ? std::min(kWidth, kWidth * done / all) : kWidth;
  const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
  std::fprintf(stream_, "\r[%s] %d/%d", bar.c_str(), done, all);
  std::fflush(stream_);
}

}  // namespace arfm_vo
