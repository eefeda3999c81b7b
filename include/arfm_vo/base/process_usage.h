#pragma once

namespace arfm_vo {

/// CPU time of all threads of this process so far, s.
double GetProcessCpuSeconds();
/// CPU time of the calling thread so far, s.
double GetThreadCpuSeconds();

/// The most memory that this process has held so far, MB (10^6 bytes).
double GetPeakMemoryMb();

}  // namespace arfm_vo
