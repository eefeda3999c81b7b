#!/usr/bin/env bash
# Measures the global adjustment on drives of 125 to 1,000 keyframes and writes docs/global_adjustment.md.
# Usage: scripts/measure.sh bundle_table        on a machine that does nothing else
set -euo pipefail
if [ -z "${BUILD_DIR:-}" ]; then scripts/build.sh bundle_benchmark; fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
load=$(cut -d' ' -f1 /proc/loadavg)
for threads in 1 2; do
  "${BUILD_DIR:-_b}/devel/lib/arfm_vo/bundle_benchmark" global --threads $threads > "$work/$threads"
done
{
  echo "# Time and memory of the global adjustment"
  echo
  echo "Written by \`scripts/measure.sh bundle_table\`: a simulated drive of 1 m a keyframe along a corridor, with noise of 0.5 px and"
  echo "an odometry's drift; all poses, all points and the stereo correction are free, from the drifted start to convergence."
  echo "Memory: what the adjustment adds at its peak. Other work on the machine's $(nproc) cores: a load of $load."
  echo
  echo "| keyframes | points | observations | threads | converged | iterations | wall s | CPU s | memory MB |"
  echo "|---|---|---|---|---|---|---|---|---|"
  for threads in 1 2; do
    awk -v threads=$threads 'NR > 1 {printf "| %s | %s | %s | %d | %s | %s | %s | %s | %s |\n", $1, $2, $3, threads,
                                     $4 ? "yes" : "no", $5, $6, $7, $8}' "$work/$threads"
  done
  echo
  echo "The nodes and \`kitti_odometry\` bound it: \`global.max_keyframes\` (110) move, whatever the drive's length."
} > "$work/table"
mv "$work/table" docs/global_adjustment.md
cat docs/global_adjustment.md
