#!/usr/bin/env bash
# The code for a CPU with AVX2 and that for every CPU, glibc's and OpenCV's too, give the same trajectory to the last byte.
# Usage: cpu_paths_test.sh PROGRAM_DIR BASELINE_LIBRARY
set -euo pipefail
grep -qw avx2 /proc/cpuinfo || { echo "SKIPPED: this CPU has no AVX2"; exit 77; }
pairs=30
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
drive() {  # NAME [VARIABLE=VALUE ...]
  env "${@:2}" "$programs/kitti_odometry" "$work/curve" --output "$work/$1" > /dev/null 2> "$work/$1.txt"
}
programs=$1
"$programs/render_sequence" "$work/curve" --path curve --pairs $pairs > /dev/null
drive fast
drive baseline LD_PRELOAD="$2" GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4 \
  OPENCV_CPU_DISABLE=SSE4.1,SSE4.2,AVX,FP16,AVX2,FMA3,AVX512F,AVX512-SKX
if grep -q "baseline code" "$work/fast.txt" || ! grep -q "baseline code" "$work/baseline.txt"; then
  echo "the baseline's code ran in the first drive, or not in the second"; exit 1
fi
for name in poses_online.txt poses.txt; do
  [ "$(wc -l < "$work/fast/$name")" -eq $pairs ] || { echo "$name: not $pairs poses"; exit 1; }
  cmp "$work/fast/$name" "$work/baseline/$name"
done
