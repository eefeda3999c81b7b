#!/usr/bin/env bash
# Drives the simulated rover to 24 goals by sight alone, more than an hour, as many at a time as there are CPUs, then 200
# times with drawn poses, and writes docs/driving.md and docs/drives.jpg. Usage: scripts/measure.sh closed_loop [DIR]     drives already in DIR are not driven again
set -euo pipefail
goals=24
scripts/build.sh drive_simulation
work=${1:-$(mktemp -d)}
[ $# -gt 0 ] || trap 'rm -rf "$work"' EXIT
mkdir -p "$work"; work=$(realpath "$work")
export work program=${BUILD_DIR:-_b}/devel/lib/arfm_vo/drive_simulation

drive() {
  local report=$work/drive_$1.txt; [ -s "$report" ] && return
  # A drive that fails is a row of the table too.
  "$program" --seed "$1" --goals 1 --output "$work" > "$report.new" || true
  mv "$report.new" "$report"
  sed -n 2p "$report"
}
export -f drive
seq $goals | xargs -P "$(nproc)" -I{} bash -c 'drive {}'

rows() { for ((seed = 1; seed <= goals; ++seed)); do sed -n 2p "$work/drive_$seed.txt"; done; }
# Columns: seed, goal_m, driven_m, error_m, allowed, head_deg, slope_deg, slip_%, max_mps, before, pairs, lost, drive_s, stops
sum() { rows | awk -v c="$1" '{ s += $c } END { print s }'; }
most() { rows | awk -v c="$1" 'NR == 1 || $c > m { m = $c } END { print m }'; }
count() { for file in "$work"/drive_*.txt; do awk -v key="$1:" '$1 == key { print $2 }' "$file"; done | awk '{ s += $1 } END { print s }'; }

{
  echo "| | asked | measured |"
  echo "|---|---|---|"
  echo "| goals reached | $goals | $(count reached) |"
  echo "| within the allowed error | $goals | $(count within_allowed_error) |"
  echo "| largest error over allowed | 1 | $(rows | awk '$4 / $5 > m { m = $4 / $5 } END { printf "%.2f", m }') |"
  echo "| fastest frame, m/s | 0.1 | $(most 9) |"
  echo "| frames before start | 0 | $(sum 10) |"
  echo "| steepest slope under the rover, degrees | 10 | $(most 7) |"
  echo "| slip of the tracks, mean of the drives, % | 10 | $(rows | awk '{ s += $8 } END { printf "%.1f", s / NR }') |"
  echo "| stops on the way, in all | 0 | $(sum 14) |"
  echo "| driving, simulated, s | 3600 | $(sum 13) |"
  echo "| way in all, m | | $(sum 3) |"
  echo "| stereo pairs, of them without a pose | | $(sum 11), $(sum 12) |"
  echo
  echo "| goal | away, m | driven, m | error, m | allowed, m | heading error, deg | steepest, deg | slip, % | fastest frame, m/s | frames before start | pairs | without a pose | time, s | stops | outcome |"
  echo "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
  rows | awk '{ printf "|"; for (i = 1; i <= 14; ++i) printf " %s |", $i
                for (i = 15; i <= NF; ++i) printf " %s", $i; print " |" }'
} > "$work/driving"

[ -s "$work/drawn.txt" ] || { "$program" --goals 1 --drawn 200 > "$work/drawn.new" || true; mv "$work/drawn.new" "$work/drawn.txt"; }
# The second summary, and what stopped a drive: rows as above.
sed -n '/^poses drawn/,$p' "$work/drawn.txt" | awk '
  BEGIN { print "| | |\n|---|---|" }
  $1 + 0 > 0 { s += $8; n++; if ($8 > m) m = $8; if ($14 > 0) stops = stops "\n\nGoal " $1 ": " $15 " " $16 " " $17 " " $18 " " $19 " " $20 }
  /^[a-z_]+: / { sub(":", "", $1); gsub("_", " ", $1); print "| " $1 " | " $2 " |" }
  END { printf "| slip, mean and most, %% | %.1f, %.1f |%s\n", s / n, m, stops }' > "$work/drawn"

mapfile -t pictures < <(find "$work" -name 'drive_*.png' | sort | tail -4)
montage "${pictures[@]}" -tile 2x2 -geometry 500x552+4+4 -quality 80 "$work/drives.jpg"
test/readme_section.py docs/driving.md driving < "$work/driving"
test/readme_section.py docs/driving.md drawn < "$work/drawn"
mv "$work/drives.jpg" docs/
[ "$(count within_allowed_error)" -eq $goals ] || { echo "closed_loop: not all goals were reached well" >&2; exit 1; }
