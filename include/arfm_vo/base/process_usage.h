#pragma once

namespace arfm_vo {

/// CPU time of all threads of this process so far, s.
double GetProcessCpuSeconds();
/// CPU time of the calling thread so far, s.
double GetThreadCpuSeconds();

/// Resident memory of this process now, MB (10^6 bytes); 0 where the system does not tell.
double GetMemoryMb();
/// Lets the process give back large memory as soon as it is freed, so that what is resident does
/// not grow by what adjustments leave in between, but keep what each pair needs anew. To be called
/// first of all in main.
void KeepMemoryFlat();
/// Gives memory that was freed back to the system. What a thread has freed stays with it otherwise.
void ReturnFreeMemory();
/// The most memory that this process has held so far, MB (10^6 bytes).
double GetPeakMemoryMb();

}  // namespace arfm_vo
