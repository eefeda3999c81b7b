// Drives out, is switched off and on, drives home: how far from the start each drive ends. Half of
// the drives slip by 10 %. Usage: home_drives METRES DRIVES
#include <cstdlib>

#include "rehearsal/home_drive.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  for (int seed = 1; seed <= std::atoi(argv[2]); ++seed) {
    arfm_vo::GoalSceneOptions options;
    options.seed = seed;
    options.min_distance_m = options.max_distance_m = std::atof(argv[1]);
    const double slip = seed % 2 == 1 ? 0.1 : 0;
    const auto error_m = arfm_vo::DriveOutAndHome(arfm_vo::GoalScene(options, {}), slip, seed);
    std::printf("drive %d, slip %.0f %%: error %.3f m\n", seed, 100 * slip, error_m.value_or(NAN));
    std::fflush(stdout);
  }
  return 0;
}
