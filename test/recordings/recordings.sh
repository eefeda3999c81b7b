#!/usr/bin/env bash
# Makes recordings by seeds, real clips changed and rendered drives, with and without faults (test/recordings), runs the
# odometry on each and writes what became of them to docs/recordings.md. Goes on where an earlier run stopped.
# Usage: scripts/measure.sh recordings [--output DIR] [--half tune|judge] [--seconds N] [--count N] [--from SEED] ...
#        --output DIR  for recordings.csv and the references (default: recordings in the build folder); another one for other code
#        --seconds N   stops after so many seconds of work (default 3600); other options are those of the program `recordings`
set -euo pipefail
build=${BUILD_DIR:-_b}
output=$build/recordings
half=
seconds=3600
options=()
while [ $# -gt 0 ]; do
  case $1 in
    --output) output=$2 ;;
    --seconds) seconds=$2 ;;
    --half) half=$2; options+=(--half "$2") ;;
    *) options+=("$1" "${2-}") ;;
  esac
  shift $(($# > 1 ? 2 : 1))
done
scripts/build.sh recordings
"$build/devel/lib/arfm_vo/recordings" "$output" --data "${ARFM_VO_SHARED:-../shared}/data" \
  --references "$output/references" --seconds "$seconds" "${options[@]}"
python3 test/recordings/recordings_report.py "$output/recordings.csv" ${half:+"$half"} |
  test/readme_section.py docs/recordings.md recordings
