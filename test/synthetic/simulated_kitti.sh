#!/usr/bin/env bash
# Drives KITTI's true paths 00-10 with simulated observations (0.5 px noise, 20 % outliers) and writes docs/simulated.md.
# Usage: scripts/measure.sh simulated_kitti [POSES_DIR]     default: ../shared/data/kitti/ground_truth_poses
# A quarter of an hour on two cores that do nothing else. WORK=DIR: keeps each run's numbers there, and does not repeat
# the runs whose numbers it finds there.
set -euo pipefail
poses=${1:-${ARFM_VO_SHARED:-../shared}/data/kitti/ground_truth_poses}
[ -d "$poses" ] || { echo "simulated_kitti: $poses: no such folder of KITTI poses" >&2; exit 1; }
if [ -z "${BUILD_DIR:-}" ]; then scripts/build.sh simulate_kitti simulate_rest; fi
programs=${BUILD_DIR:-_b}/devel/lib/arfm_vo
work=${WORK:-$(mktemp -d)}
mkdir -p "$work"
if [ -z "${WORK:-}" ]; then trap 'rm -rf "$work"' EXIT; fi
# The simulated right image is displaced by nothing. No limit of time, so that a busy machine finds the same.
echo 'global: {learn_correction: false, solver: {max_time_s: 3600}}' > "$work/loops.yaml"
sed 's/solver/loops: {enabled: false}, solver/' "$work/loops.yaml" > "$work/global.yaml"
echo 'adjust_globally: false' > "$work/online.yaml"

run() {  # NAME COMMAND...
  local name=$1; shift
  [ -f "$work/$name.csv" ] || { "$@" > "$work/$name.unfinished" && mv "$work/$name.unfinished" "$work/$name.csv"; }
}
simulate=("$programs/simulate_kitti" "$poses")
run all "${simulate[@]}" --config "$work/global.yaml" &
all=$!
run loops "${simulate[@]}" --config "$work/loops.yaml" --sequences 00,02,05,06,07,09
for with in global loops; do
  run "false_$with" "${simulate[@]}" --config "$work/$with.yaml" --sequences 10 --false-loops 20
  run "paced_$with" "${simulate[@]}" --config "$work/$with.yaml" --sequences 07 --paced; done
run nees "${simulate[@]}" --config "$work/online.yaml" --runs 20 --frames 200
run rest "$programs/simulate_rest"
wait "$all"

section() { test/readme_section.py docs/simulated.md "$1"; }
{
  echo "| sequence | frames | length m | not tracked | t_rel % | r_rel deg/100 m | ATE | adjusted t_rel % | ATE | NEES | ms a frame |"
  echo "|---|---|---|---|---|---|---|---|---|---|---|"
  awk -F, 'NR > 1 {printf "| %s | %s | %s | %d | %s | %s | %s | %s | %s | %s | %.1f |\n",
                   $1, $2, $3, $4, $6, $7, $8, $9, $11, $12, 1000 * $15 / $2
                   t += $6; r += $7; f += $9; e += $12; n++}
           END {printf "| mean | | | | %.4f | %.4f | | %.4f | | %.2f | |\n", t / n, r / n, f / n, e / n}' "$work/all.csv"
} | section all
{
  echo "| sequence | keyframes | loops | ATE | falls by | and by | ms a frame | without loops | at the end s |"
  echo "|---|---|---|---|---|---|---|---|---|"
  awk -F, 'FNR == 1 {next}
           NR == FNR {online[$1] = $8; adjusted[$1] = $11; ms[$1] = 1000 * $15 / $2; next}
           {printf "| %s | %d | %d | %s | %.1f x | %.1f x | %.1f | %.1f | %s |\n", $1, $5, $14, $11,
            online[$1] / $11, adjusted[$1] / $11, 1000 * $15 / $2, ms[$1], $16}' "$work/all.csv" "$work/loops.csv"
  awk -F, 'FNR == 2 {ate[++n] = $11; ms[n] = $17}
           END {printf "\n20 places of sequence 10 that look like others, 20 m and more away: ATE %s m, without loops %s m. Of 07 at ten\n" \
                       "frames a second 99 of 100 frames took no more than %s ms, without loops %s ms.\n", ate[2], ate[1], ms[4], ms[3]}' \
    "$work"/false_{global,loops}.csv "$work"/paced_{global,loops}.csv
} | section loops
{
  echo "| sequence | NEES | frames within % |"
  echo "|---|---|---|"
  awk -F, 'NR > 1 {printf "| %s | %s | %s |\n", $1, $12, $13; e += $12; w += $13; n++}
           END {printf "| mean | %.2f | %.1f |\n", e / n, w / n}' "$work/nees.csv"
} | section nees
{
  echo "| | m | deg | degraded |"
  echo "|---|---|---|---|"
  awk -F, 'NR > 1 {printf "| %s | %s | %s | %s |\n", $1, $2, $3, $4}' "$work/rest.csv"
} | section rest
