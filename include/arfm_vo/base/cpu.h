#pragma once

namespace arfm_vo {

/// Whether this CPU runs the files that are compiled with AVX2 (see CMakeLists.txt).
bool HasAvx2();

}  // namespace arfm_vo
