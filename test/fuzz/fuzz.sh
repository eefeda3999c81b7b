#!/usr/bin/env bash
# Feeds what takes bytes from outside (test/fuzz/*_targets.cpp) by libFuzzer, with clang's address and undefined
# behaviour sanitizers. What is found is left in BUILD_DIR/findings and fails; once mended it belongs into
# test/fuzz/corpus, which the test test_fuzz replays. Inputs that reached something new are kept in BUILD_DIR/corpus and
# fed first the next time. Needs clang (apt-get install clang).
# Usage: scripts/measure.sh fuzz [SECONDS [TARGET ...]]     default: 60 s for each target
# BUILD_DIR (default _b_fuzz) is the build tree; JOBS (default: all processors) targets are fed at a time.
set -euo pipefail
seconds=${1:-60}; shift || true
[[ $seconds =~ ^[0-9]+$ ]] || { sed -n '2,8s/^# \?//p' "$0" >&2; exit 2; }
command -v clang++ > /dev/null || { echo "fuzz: clang++ is missing (apt-get install clang)" >&2; exit 2; }

export BUILD_DIR=${BUILD_DIR:-_b_fuzz}
mkdir -p "$BUILD_DIR/devel/lib/python3/dist-packages"
flags="-O1 -g1 -fno-omit-frame-pointer -D_GLIBCXX_ASSERTIONS -Wno-everything"
flags+=" -fsanitize=fuzzer-no-link,address,undefined,float-cast-overflow -fno-sanitize=vptr,function -fno-sanitize-recover=all"
[ -f "$BUILD_DIR/build.ninja" ] || cmake -S . -B "$BUILD_DIR" -G Ninja -DCMAKE_BUILD_TYPE=Fuzzed \
  -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS_FUZZED="$flags"
scripts/build.sh fuzz
program=$BUILD_DIR/devel/lib/arfm_vo/fuzz

targets=("$@")
if [ $# -eq 0 ]; then for folder in test/fuzz/corpus/*/; do targets+=("$(basename "$folder")"); done; fi
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1
run() {  # TARGET
  local target=$1 log=$BUILD_DIR/findings/$1.log status=passed
  mkdir -p "$BUILD_DIR/corpus/$target" "$BUILD_DIR/findings/$target"
  FUZZ_TARGET=$target "$program" -max_total_time="$seconds" -max_len=65536 -timeout=20 -rss_limit_mb=3000 -malloc_limit_mb=8000 \
    -print_final_stats=1 -artifact_prefix="$BUILD_DIR/findings/$target/" \
    "$BUILD_DIR/corpus/$target" "test/fuzz/corpus/$target" > "$log" 2>&1 || status=FAILED
  printf '| %s | %s s | %s | %s | %s |\n' "$target" "$seconds" \
    "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
    "$(sed -n 's/.* cov: \([0-9]*\).*/\1/p' "$log" | tail -1)" "$status"
  [[ $status == passed ]]
}
export -f run
export seconds program
mkdir -p "$BUILD_DIR/findings"
echo "| target | time | inputs | edges covered | |"
echo "|---|---|---|---|---|"
printf '%s\n' "${targets[@]}" | xargs -P "${JOBS:-$(nproc)}" -I{} bash -c 'run {}' \
  || { echo "fuzz: findings and logs are in $BUILD_DIR/findings"; exit 1; }
