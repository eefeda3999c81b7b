// Loaded before the libraries (LD_PRELOAD): the code for every CPU runs, whatever this one can, and
// says so.
#include <cstdio>

#include "arfm_vo/base/cpu.h"

namespace arfm_vo {

bool HasAvx2() {
  static const int said = std::fputs("baseline code\n", stderr);
  return said < 0;
}

}  // namespace arfm_vo
