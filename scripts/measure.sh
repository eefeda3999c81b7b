#!/usr/bin/env bash
# Measures or proves one thing of the package, and writes its page of docs/.
# Usage: scripts/measure.sh                  lists the names: how long each takes on two cores, and what it needs
#        scripts/measure.sh NAME [ARG ...]   runs it; scripts/measure.sh NAME --help says more
set -euo pipefail
cd "$(dirname "$0")/.."
# KITTI: the clips of ../shared/data/kitti, or KITTI folders as arguments. quiet: a machine that does nothing else.
# sanitizers, fuzz and mutants build a tree of their own first, which takes 15 minutes more.
table='
api_page             test/static_checks/api_page.py          1_s     _b            docs/api.md from the code; --check only compares
benchmark            test/benchmark/benchmark.py             1_min   KITTI,quiet   time of SURF and matching
benchmark_nodes      test/benchmark/benchmark_nodes.sh       5_min   BAG,quiet     latency and drops of the nodes
closed_loop          test/rehearsal/closed_loop.sh           12_min  -             24 simulated drives to a goal
cost                 test/benchmark/cost.py                  8_min   _b            time, CPU and instructions a pair
experiments          test/experiments/experiments.sh         10_min  KITTI         section 4 of the paper
fault_campaign       test/faults/fault_campaign.sh           26_min  quiet         faults in the running nodes, time to stop
fault_table          test/faults/fault_table.sh              10_s    -             faults in process, time to stop
fuzz                 test/fuzz/fuzz.sh                       15_min  clang         readers of bytes from outside
malformed_input      test/fuzz/malformed_input.sh            15_min  -             malformed messages, with sanitizers
mutants              test/mutation/mutation.py               3_h     -             changes of the code that the tests notice
recordings           test/recordings/recordings.sh           60_min  KITTI         recordings made by seeds, with faults
results              test/experiments/results.sh             2_min   KITTI,_b      the tables of accuracy
simulated_kitti      test/synthetic/simulated_kitti.sh       15_min  KITTI,quiet   KITTI sequences 00 to 10, simulated
stress               test/synthetic/stress.sh                20_min  KITTI         disturbed pictures'
if [ $# -eq 0 ] || [[ $1 == @(-h|--help) ]]; then
  sed -n '1d; /^#/!q; s/^# \{0,1\}//p' "$0"
  printf '\n%-21s %-7s %-12s %s\n' NAME TAKES NEEDS ""
  while read -r name _ takes needs what; do
    [ -z "$name" ] || printf '%-21s %-7s %-12s %s\n' "$name" "${takes/_/ }" "${needs/_b/build.sh}" "$what"
  done <<< "$table"
  exit
fi
script=$(awk -v name="$1" '$1 == name {print $2}' <<< "$table")
[ -n "$script" ] || { echo "measure: no $1 among the names that scripts/measure.sh lists" >&2; exit 2; }
shift
export PATH=/usr/bin:$PATH  # Debian's python3 first: another one breaks ROS' tools
if [[ $script == *.sh && ${1-} == @(-h|--help) ]]; then sed -n '1d; /^#/!q; s/^# \{0,1\}//p' "$script"; exit; fi
exec "$script" "$@"
