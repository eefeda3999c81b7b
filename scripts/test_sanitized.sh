#!/usr/bin/env bash
# Builds the unit tests, programs and nodes apart with the compiler's sanitizers and runs them. Status 1 where a test fails or a
# sanitizer reports, in whatever process. libstdc++'s and Eigen's assertions are on.
# Usage: scripts/test_sanitized.sh address|undefined|thread [TEST ...]
#        address     addresses, leaks, and undefined behaviour as well: one build for all
#        undefined   undefined behaviour alone
#        thread      data races and dead locks; what lies in libraries that are not built with it is left out
#                    (test/sanitizers/thread.txt)
#        TEST        test_pose .., or the name of a file of test/nodes: ba_node ..; default: all unit tests
# CXX=clang++ (Debian: clang, libclang-rt-dev) compiles in a third of GCC's time; nodelets' tests need GCC.
# BUILD_DIR (default _b_KIND) is the build tree. GTEST_FILTER chooses among the tests of a unit test.
set -euo pipefail
[[ ${1-} != @(-h|--help) ]] || { sed -n '1d; /^#/!q; s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."
undefined=undefined,float-cast-overflow
case ${1-} in
  address) sanitizers=address,$undefined ;;
  undefined) sanitizers=$undefined ;;
  thread) sanitizers=thread ;;
  *) sed -n '2,11s/^# \?//p' "$0" >&2; exit 2 ;;
esac
kind=$1; shift

export BUILD_DIR=${BUILD_DIR:-_b_$kind} PATH=/usr/bin:$PATH
# catkin keeps the environment of the tests as it is when it configures: Python's messages must have their folder.
mkdir -p "$BUILD_DIR/devel/lib/python3/dist-packages"
[ -f "$BUILD_DIR/build.ninja" ] || cmake -S . -B "$BUILD_DIR" -G Ninja -DCMAKE_BUILD_TYPE=Sanitized \
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=8 \
  -DCMAKE_CXX_FLAGS_SANITIZED="-O1 -g1 -fno-omit-frame-pointer -fsanitize=$sanitizers -fno-sanitize-recover=all -D_GLIBCXX_ASSERTIONS"
targets=("$@")
[ $# -gt 0 ] || mapfile -t targets < <(cd "$BUILD_DIR" && ctest -N | sed -n 's/.*_gtest_\(test_\w*\)$/\1/p')
build=() unit_tests=() node_tests=()
for target in "${targets[@]}"; do
  if [ -f "test/nodes/$target.test" ]; then
    build=(all tests arfm_vo_generate_messages_py)
    node_tests+=("$target")
  else
    build+=("$target")
    unit_tests+=("_gtest_$target")
  fi
done
scripts/build.sh "${build[@]}"

# A node's report does not fail a test that does not hear of it: reports go to files, of all processes.
reports=$PWD/$BUILD_DIR/reports
rm -rf "$reports"
mkdir -p "$reports"
log=log_path=$reports/report
export ASAN_OPTIONS=$log:detect_stack_use_after_return=1:strict_string_checks=1:check_initialization_order=1
export UBSAN_OPTIONS=$log:print_stacktrace=1
export TSAN_OPTIONS=$log:second_deadlock_stack=1:suppressions=$PWD/test/sanitizers/thread.txt
package=$PWD
cd "$BUILD_DIR"
status=0
run() { ctest --timeout 7200 --output-on-failure "$@" || status=1; }
[ ${#unit_tests[@]} -eq 0 ] || run -j "$(nproc)" -R "($(IFS='|'; echo "${unit_tests[*]}"))$"
for target in "${node_tests[@]}"; do
  if grep -q ARFM_VO_PRELOAD "$package/test/nodes/$target.test"; then
    # The nodelets' manager is not built with the sanitizer: it gets it at its start, and what it leaks is not ours.
    ARFM_VO_PRELOAD=$(gcc -print-file-name="lib${kind:0:1}san.so") ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0 \
      run -R "_rostest_test_nodes_$target.test$"
  else
    run -R "_rostest_test_nodes_$target.test$"
  fi
done
if compgen -G "$reports/*" > /dev/null; then cat "$reports"/*; status=1; fi
exit $status
