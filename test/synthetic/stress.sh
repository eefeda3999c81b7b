#!/usr/bin/env bash
# Spoils the pictures of recordings and of a rendered drive (test/synthetic/disturbances.cpp) and writes what the odometry
# makes of them to docs/stress.md, and the state of each pair over time to docs/stress.png.
# Usage: scripts/measure.sh stress [--all] [KITTI_FOLDER ...]
#        default folders: those of ../shared/data that are there, the hand-held walk too
#        --all   60 disturbances instead of 16, to docs/stress_all.md, and how long it took
set -euo pipefail
all=()
page=stress
if [[ ${1-} == --all ]]; then all=(--all) page=stress_all; shift; fi
. test/kitti_folders.sh stress "$@"
walk=${ARFM_VO_SHARED:-../shared}/data/handheld/boofcv_backyard
if [ $# -eq 0 ] && [ -d "$walk" ]; then folders+=("$walk"); fi
scripts/build.sh stress_odometry render_sequence relocalise
programs=${BUILD_DIR:-_b}/devel/lib/arfm_vo
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$programs/render_sequence" "$work/rendered_curve" --path curve --pairs 60 > "$work/log" 2>&1 ||
  { cat "$work/log" >&2; exit 1; }
folders+=("$work/rendered_curve")

# A row a disturbance, a column a pair: tracked 0, degraded 1, lost 2.
plot() {  # SEQUENCE_NAME
  local names files labels
  mapfile -t names < <(cut -d, -f1 "$work/lines" | sed 1d)
  files=("${names[@]/#/$work/states/}")
  files=("${files[@]/%/.csv}")
  awk -F, 'FNR == 1 {++row; next} {print row - 1, $1, $2 == "tracked" ? 0 : $2 == "degraded" ? 1 : 2}' \
    "${files[@]}" > "$work/grid"
  labels=$(printf '%s\n' "${names[@]}" | awk '{printf "%s\"%s\" %d", (NR > 1 ? ", " : ""), $1, NR - 1}')
  gnuplot <<PLOT
set terminal pngcairo size 900,520 noenhanced font "sans,10"
set output "$work/stress.png"
set title "$1: state of each pair (green tracked, yellow degraded, red lost)"
set palette defined (0 "#58a65c", 1 "#f2c14e", 2 "#c8443c")
set cbrange [0:2]
unset colorbox
set xlabel "pair"
set xrange [-0.5:59.5]
set yrange [*:*] reverse noextend
set ytics ($labels)
plot "$work/grid" using 2:1:3 with image notitle
PLOT
}

{
  for folder in "${folders[@]}"; do
    name=$(basename "$folder")
    mkdir -p "$work/states"
    "$programs/stress_odometry" "$folder" "${all[@]}" --states "$work/states" > "$work/lines"
    picture=
    [ "$name$page" != raw_2011_09_26_drive_0001stress ] || picture=stress.png
    [ -z "$picture" ] || { plot "$name" && mv "$work/stress.png" docs/stress.png; }
    echo "## $name"
    echo
    [ -z "$picture" ] || { echo "![state of each pair](stress.png)"; echo; }
    echo "| disturbance | live | after | tracked | degraded | lost | wrong | largest |"
    echo "|---|---|---|---|---|---|---|---|"
    awk -F, 'NR > 1 {gsub("nan", "-"); printf "| %s | %s / %s | %s / %s | %s | %s | %s | %s | %s |\n", \
      $1, $2, $3, $4, $5, $6, $7, $8, $9, $10}' "$work/lines"
    awk -F, -v name="$name" 'NR > 1 && $9 > 0 {printf "| %s | %s | %s | %s |\n", name, $1, $9, $10}' "$work/lines" >> "$work/wrong"
    echo
  done
} > "$work/stress"
if [ $page = stress_all ]; then
  last=wrong
  {
    echo "| sequence | disturbance | wrong | largest |"
    echo "|---|---|---|---|"
    cat "$work/wrong"
    echo
    echo "It took $SECONDS s."
  } > "$work/last"
else
  last=relocalisation
  "$programs/render_sequence" "$work/turn" --path wide_turn > "$work/log" 2>&1
  {
    echo "| shared view at least | tries | found by the first pair | wrong |"
    echo "|---|---|---|---|"
    for share in 0.5 0.25 0.1; do
      "$programs/relocalise" "$work/turn" --min-share $share |
        awk -F': ' -v share=$share '{v[$1] = $2} END {printf "| %s | %d | %d | %d |\n", share, v["tries"], v["found"], v["wrong"]}'
    done
  } > "$work/last"
fi
test/readme_section.py docs/$page.md stress < "$work/stress"
test/readme_section.py docs/$page.md $last < "$work/last"
