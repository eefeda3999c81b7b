#include "arfm_vo/base/process_usage.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <ctime>
#include <fstream>

namespace arfm_vo {
namespace {

double ReadSeconds(clockid_t clock) {
  timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

double GetProcessCpuSeconds() { return ReadSeconds(CLOCK_PROCESS_CPUTIME_ID); }
double GetThreadCpuSeconds() { return ReadSeconds(CLOCK_THREAD_CPUTIME_ID); }

double GetMemoryMb() {
  std::ifstream pages("/proc/self/statm");
  double all = 0, resident = 0;
  if (!(pages >> all >> resident)) return 0;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

void KeepMemoryFlat() {
#ifdef __GLIBC__
  // Bytes: an image of KITTI is below kLarge, or its pages would be zeroed anew for each pair.
  constexpr int kLarge = 512 << 10, kKept = 16 << 20;
  mallopt(M_MMAP_THRESHOLD, kLarge);  // set once, or glibc raises it to what was freed
  mallopt(M_TRIM_THRESHOLD, kKept);
  mallopt(M_ARENA_MAX, 1);  // what one thread frees, another can use
#endif
}

void ReturnFreeMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

double GetPeakMemoryMb() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;
}

}  // namespace arfm_vo
