#!/usr/bin/env bash
# Builds the package and its tests into BUILD_DIR (default _b in the package).
# Usage: scripts/build.sh [TARGET ...]        default targets: all, tests and the messages for Python
set -euo pipefail
[[ ${1-} != @(-h|--help) ]] || { sed -n '1d; /^#/!q; s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."
# Debian's python3 first: another one on PATH breaks catkin_pkg.
export PATH=/usr/bin:$PATH
build=${BUILD_DIR:-_b}
# catkin keeps the environment of the tests as it is when it configures: Python's messages must have their folder.
mkdir -p "$build/devel/lib/python3/dist-packages"
[ -f "$build/build.ninja" ] || cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release
if [ $# -gt 0 ]; then ninja -C "$build" "$@"; else ninja -C "$build" all tests arfm_vo_generate_messages_py; fi
