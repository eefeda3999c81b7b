// libFuzzer's entry (scripts/measure.sh fuzz): FUZZ_TARGET names what to feed.

#include <cstdio>
#include <cstdlib>

#include "fuzz/fuzz_targets.h"

namespace {

void (*FindTarget())(const std::string&) {
  const char* name = std::getenv("FUZZ_TARGET");
  for (const arfm_vo::FuzzTarget& target : arfm_vo::AllFuzzTargets())
    if (name && target.name == name) return target.run;
  std::fprintf(stderr, "FUZZ_TARGET must name one of:");
  for (const arfm_vo::FuzzTarget& target : arfm_vo::AllFuzzTargets())
    std::fprintf(stderr, " %s", target.name.c_str());
  std::fprintf(stderr, "\n");
  std::exit(2);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const auto run = FindTarget();
  run(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
