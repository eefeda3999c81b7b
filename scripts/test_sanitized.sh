#!/usr/bin/env bash
# Builds the unit tests and the programs apart with GCC's sanitizers and runs them. Status 1 where a test fails or a
# sanitizer reports; nothing is suppressed. libstdc++'s and Eigen's assertions are on.
# Usage: scripts/test_sanitized.sh address|undefined|thread [TEST ...]        test_pose ..; default: all unit tests
#        address     addresses, leaks, and undefined behaviour as well: one build for all
#        undefined   undefined behaviour alone
#        thread      data races and dead locks
# BUILD_DIR (default _b_KIND) is the build tree.
set -euo pipefail
cd "$(dirname "$0")/.."
undefined=undefined,float-cast-overflow
case ${1-} in
  address) sanitizers=address,$undefined ;;
  undefined) sanitizers=$undefined ;;
  thread) sanitizers=thread ;;
  *) sed -n '2,8s/^# \?//p' "$0" >&2; exit 2 ;;
esac
kind=$1; shift

export BUILD_DIR=${BUILD_DIR:-_b_$kind} PATH=/usr/bin:$PATH
# catkin keeps the environment of the tests as it is when it configures: Python's messages must have their folder.
mkdir -p "$BUILD_DIR/devel/lib/python3/dist-packages"
[ -f "$BUILD_DIR/build.ninja" ] || cmake -S . -B "$BUILD_DIR" -G Ninja -DCMAKE_BUILD_TYPE=Sanitized \
  -DCMAKE_CXX_FLAGS_SANITIZED="-O1 -g1 -fno-omit-frame-pointer -fsanitize=$sanitizers -fno-sanitize-recover=all -D_GLIBCXX_ASSERTIONS"
targets=("$@")
[ $# -gt 0 ] || mapfile -t targets < <(cd "$BUILD_DIR" && ctest -N | sed -n 's/.*_gtest_\(test_\w*\)$/\1/p')
scripts/build.sh "${targets[@]}"

export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1:check_initialization_order=1
export UBSAN_OPTIONS=print_stacktrace=1 TSAN_OPTIONS=second_deadlock_stack=1
cd "$BUILD_DIR"
ctest --output-on-failure -R "_gtest_($(IFS='|'; echo "${targets[*]}"))$"
