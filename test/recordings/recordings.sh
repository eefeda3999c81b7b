#!/usr/bin/env bash
# Makes recordings by seeds, real clips changed and rendered drives, with and without faults (test/recordings), runs the
# odometry on each and writes what became of them to docs/recordings.md. Goes on where an earlier run stopped.
# Usage: scripts/measure.sh recordings [--output DIR] [--half tune|judge] [--seconds N] [--count N] [--from SEED] ...
#        --output DIR  where recordings.csv is kept (default: recordings in the build folder); what was found with other
#                      code belongs into another one
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
  --references "$build/recordings_references" --seconds "$seconds" \
  "${options[@]}"
work=$(mktemp)
trap 'rm -f "$work"' EXIT
{
  echo "# Recordings made by seeds"
  echo
  echo "Written by \`scripts/measure.sh recordings${half:+ --half $half}\`${half:+ (of the seeds the half to ${half})}. Real clips are a window of at most 60 pairs, every n-th one, forward or backward,"
  echo "as taken, mirrored or turned by 180 degrees with the eyes swapped, cropped, scaled, with other light and noise; rendered"
  echo "drives are random rigs, motions and scenes. Half of the recordings have a fault. A pair is *trackable* where, by the"
  echo "truth, at least 40 % of the left picture was seen by the pair before (its point lies in that picture, is not behind"
  echo "something there, was between half and twice as far) and has 60 corners (FAST, one a cell of 6 x 6 px), what a fault hides"
  echo "left out; a pair whose right picture is black or frozen is not. Depths for this are exact where rendered, else of block"
  echo "matching. A corner must exceed 2.5 times the noise put in. *Wrong*: called tracked, and the displacement since the start"
  echo "(since the last pose before the fault) off by more than 3 times the root of the covariance's trace and by more than 1 % of"
  echo "the path since then. The truth of real clips is the places of their poses with the directions of a reference, or (backyard,"
  echo "library) the reference itself: what the odometry has after the whole clip as taken, the library driven backward. It is"
  echo "trusted to 1 % of the path and 3 cm (KITTI's odometry), 1.5 % and 3 cm (raw drive), 1.5 % and 2 mm (backyard, room1), 2.5 %"
  echo "and 2 mm (library), and less is not called wrong. Directions on real clips are therefore not judged. Pairs before a fault and"
  echo "the first one are not judged. Sigma and error are of the position since the start, rms over all tracked pairs"
  echo "(and the median of the recordings' own ratios). NEES (6 degrees of freedom, against the first camera) is the mean over the tracked"
  echo "pairs of rendered recordings without a fault."
  echo
  python3 test/recordings/recordings_report.py "$output/recordings.csv" ${half:+"$half"}
} > "$work"
mv "$work" docs/recordings.md
trap - EXIT
chmod 644 docs/recordings.md
