#!/usr/bin/env bash
# Builds the unit tests and programs apart with GCC's sanitizers and runs them; with --nodes also the chain of nodes and
# nodelets. Status 1 where a test fails or a sanitizer reports. libstdc++'s and Eigen's assertions are on.
# Usage: scripts/test_sanitized.sh address|undefined|thread [--nodes] [CTEST_ARGUMENT ...]
#        address     addresses, leaks, and undefined behaviour as well: one build for all
#        undefined   undefined behaviour alone
#        thread      data races and dead locks
# BUILD_DIR (default _b_KIND) is the build tree. What is suppressed, and why: test/sanitizers/.
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
with_nodes=
if [[ ${1-} == --nodes ]]; then with_nodes=1; shift; fi

export BUILD_DIR=${BUILD_DIR:-_b_$kind} PATH=/usr/bin:$PATH
# catkin keeps the environment of the tests as it is when it configures: Python's messages must have their folder.
mkdir -p "$BUILD_DIR/devel/lib/python3/dist-packages"
[ -f "$BUILD_DIR/build.ninja" ] || cmake -S . -B "$BUILD_DIR" -G Ninja -DCMAKE_BUILD_TYPE=Sanitized \
  -DCMAKE_CXX_FLAGS_SANITIZED="-O1 -g1 -fno-omit-frame-pointer -fsanitize=$sanitizers -fno-sanitize-recover=all -D_GLIBCXX_ASSERTIONS"
mapfile -t targets < <(cd "$BUILD_DIR" && ctest -N | sed -n 's/.*_gtest_\(test_\w*\)$/\1/p')
chosen=_gtest_
if [[ $with_nodes ]]; then
  targets+=(arfm_node pose_node ba_node arfm_vo_nodelets test_live_poses test_odometry_chain arfm_vo_generate_messages_py)
  chosen+='|live_poses|odometry_chain|ba_node'
fi
scripts/build.sh "${targets[@]}"

suppressions=$PWD/test/sanitizers
# (Debian's nodelet manager has no sanitizer's runtime of its own: that of the nodelets comes later than it likes.)
export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1:check_initialization_order=1:verify_asan_link_order=0
export LSAN_OPTIONS=suppressions=$suppressions/leaks.txt:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=suppressions=$suppressions/races.txt:second_deadlock_stack=1
cd "$BUILD_DIR"
if [ $# -gt 0 ]; then ctest --output-on-failure "$@"; else ctest --output-on-failure -R "$chosen"; fi
