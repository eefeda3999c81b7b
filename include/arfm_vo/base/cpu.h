#pragma once

namespace arfm_vo {

/// Whether this CPU runs the files that are compiled with AVX2 and FMA (see CMakeLists.txt).
bool HasAvx2AndFma();

}  // namespace arfm_vo
