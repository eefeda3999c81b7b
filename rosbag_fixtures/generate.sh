#!/usr/bin/env bash
# Renders the fixture anew: a drive over planetary terrain as a bag. Usage: generate.sh [OUTPUT.bag]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
programs=${BUILD_DIR:-$here/../_b}/devel/lib/arfm_vo
output=$(realpath "${1:-$here/terrain.bag}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$programs/render_sequence" "$folder/terrain" --path curve --pairs 36 --step 0.1 \
  --width 480 --height 360 --threads 2
"$programs/kitti_to_bag" "$folder/terrain" "$output"
