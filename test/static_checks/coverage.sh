#!/usr/bin/env bash
# Builds apart with gcc's coverage counters, runs the unit tests, and prints for each layer how many of its lines and
# branches they reached, as a table; with --lines also the lines that none reached. Needs gcovr (apt-get install gcovr).
# Usage: scripts/measure.sh coverage [--lines] [LAYER ...]     default: all; with LAYER .. only the tests of these
# For the layer ros the nodes' tests run too.
# BUILD_DIR (default _b_coverage) is the build tree.
set -euo pipefail
lines=
if [[ ${1-} == --lines ]]; then lines=1; shift; fi
command -v gcovr > /dev/null || { echo "coverage: gcovr is missing (apt-get install gcovr)" >&2; exit 2; }
export BUILD_DIR=${BUILD_DIR:-_b_coverage}
mkdir -p "$BUILD_DIR/devel/lib/python3/dist-packages"
# (No ccache: the counters' notes are written beside the object files.)
[ -f "$BUILD_DIR/build.ninja" ] || cmake -S . -B "$BUILD_DIR" -G Ninja -DCMAKE_BUILD_TYPE=Coverage \
  -DCMAKE_CXX_COMPILER_LAUNCHER= -DCMAKE_CXX_FLAGS_COVERAGE="-O1 -g1 --coverage -fprofile-update=atomic"
mapfile -t tests < <(cd "$BUILD_DIR" && ctest -N | sed -n 's/.*_gtest_\(test_\w*\)$/\1/p')
filter=src/
if [ $# -gt 0 ]; then tests=("${@/#/test_}"); filter="src/($(IFS='|'; echo "$*"))/"; fi
chosen="_gtest_($(IFS='|'; echo "${tests[*]}"))$"
if [[ " ${tests[*]} " == *" test_ros "* ]]; then tests=() chosen+="|_rostest_"; fi
scripts/build.sh "${tests[@]}"
find "$BUILD_DIR" -name '*.gcda' -delete
status=0
(cd "$BUILD_DIR" && ctest --timeout 7200 --output-on-failure -R "$chosen") || status=1
gcovr --root . --object-directory "$BUILD_DIR" --filter "$filter" --exclude-throw-branches --csv "$BUILD_DIR/coverage.csv" \
  ${lines:+--txt -} >&2
echo "| layer | lines | reached | branches | reached |"
echo "|---|---|---|---|---|"
awk -F, 'NR > 1 {split($1, part, "/"); layer = part[2]; lines[layer] += $2; hit[layer] += $3; branches[layer] += $5; taken[layer] += $6}
  END {for (layer in lines) printf "| %s | %d | %.1f %% | %d | %.1f %% |\n", layer, lines[layer],
    100 * hit[layer] / lines[layer], branches[layer], branches[layer] ? 100 * taken[layer] / branches[layer] : 100}' \
  "$BUILD_DIR/coverage.csv" | sort
[ $status -eq 0 ] || echo "coverage: tests failed, see above; what they reached is counted" >&2
exit $status
