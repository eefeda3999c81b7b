#pragma once

#include <cstdio>

namespace arfm_vo {

/// A bar on one line of a terminal, gone with the object; nothing where `stream` is no terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::FILE* stream);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void Show(int done, int all);

 private:
  std::FILE* stream_;  ///< null where nothing is shown
};

}  // namespace arfm_vo
