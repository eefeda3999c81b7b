// Loaded before the libraries (LD_PRELOAD): the code for every CPU runs, whatever this one can.
#include "arfm_vo/base/cpu.h"

namespace arfm_vo {

bool HasAvx2AndFma() { return false; }

}  // namespace arfm_vo
