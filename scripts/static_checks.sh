#!/usr/bin/env bash
# Reads the sources without running them: shellcheck, pyflakes, what a layer may use, the sizes of files and folders
# (test/static_checks/sizes_test.py), cppcheck, and with --tidy clang-tidy over FOLDER ... (default: src and nodes). Fails with
# the first finding. Needs: apt-get install shellcheck pyflakes3 cppcheck [clang-tidy]
# Usage: scripts/static_checks.sh [--tidy [FOLDER ...]]
set -euo pipefail
[[ ${1-} != @(-h|--help) ]] || { sed -n '1d; /^#/!q; s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."
export PATH=/usr/bin:$PATH
for tool in shellcheck pyflakes3 cppcheck; do
  command -v $tool > /dev/null || { echo "static_checks: $tool is missing (apt-get install $tool)" >&2; exit 2; }
done

mapfile -t shell_scripts < <(find scripts test rosbag_fixtures .ci -name '*.sh' -o -path .ci/run | sort)
mapfile -t python_scripts < <(find launch scripts test -name '*.py' | sort)
# (SC1091: devel/setup.sh is made by the build.)
shellcheck -e SC1091 "${shell_scripts[@]}"
echo "shellcheck: ${#shell_scripts[@]} scripts, no finding"
pyflakes3 "${python_scripts[@]}"
echo "pyflakes: ${#python_scripts[@]} scripts, no finding"
test/layers_test.py
test/static_checks/sizes_test.py
test/static_checks/pages_test.py
# (The three macros are of headers that it is not shown.)
cppcheck -q -j"$(nproc)" --std=c++17 --language=c++ --enable=warning,performance,portability --error-exitcode=1 \
  --inline-suppr --suppressions-list=test/static_checks/cppcheck.txt --suppress=missingInclude -Iinclude \
  '-DPLUGINLIB_EXPORT_CLASS(a,b)=' '-DBOOST_PP_SEQ_FOR_EACH(a,b,c)=' '-Dtimercmp(a,b,compare)=((a)->tv_sec compare (b)->tv_sec)' src nodes
echo "cppcheck: src and nodes, no finding"

[[ ${1-} == --tidy ]] && shift || exit 0
folders=("$@")
[ $# -gt 0 ] || folders=(src nodes)
# Apart, as clang does not read gcc's precompiled headers; sources in groups, as headers take most of the time.
build=${BUILD_DIR:-_b_tidy}
[ -f "$build/compile_commands.json" ] || cmake -S . -B "$build" -G Ninja -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
  -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=8 > /dev/null
ninja -C "$build" arfm_vo_generate_messages_cpp > /dev/null
inside="$PWD/($(IFS='|'; echo "${folders[*]}"))/"
sed -n 's/^ *"file": "\(.*\)".*/\1/p' "$build/compile_commands.json" | sort -u |
  while read -r group; do if (echo "$group"; cat "$group") | grep -qE "^(#include \")?$inside"; then echo "$group"; fi; done |
  xargs -P "$(nproc)" -n 1 clang-tidy -p "$build" --quiet --warnings-as-errors='*' 2> /dev/null
echo "clang-tidy: ${folders[*]}: no finding"
