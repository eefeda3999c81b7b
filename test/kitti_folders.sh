# shellcheck shell=bash
# To be sourced, with a script's name and arguments: fills the array `folders` with the KITTI folders given, or else with
# those of ../shared/data that are there, and `data` with where these lie; ends the script where there is none.
data=${ARFM_VO_SHARED:-../shared}/data/kitti
folders=("${@:2}")
if [ ${#folders[@]} -eq 0 ]; then
  for folder in "$data/odometry_06_000-050" "$data/raw_2011_09_26_drive_0001" "$data/odometry_05_100-159" \
    "$data/odometry_04_000-050"; do
    if [ -d "$folder" ]; then folders+=("$folder"); fi
  done
fi
[ ${#folders[@]} -gt 0 ] || { echo "$1: no KITTI folder given or found" >&2; exit 1; }
