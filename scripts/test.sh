#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests side by side, two for each CPU, as many of them wait.
# Usage: scripts/test.sh [--full] [CTEST_ARGUMENT ...]
#        --full   the tests of the label "full" too, which take long; CI runs them
# With arguments of ctest only ctest runs, without the tests in the virtual machine.
set -euo pipefail
[[ ${1-} != @(-h|--help) ]] || { sed -n '1d; /^#/!q; s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."
chosen=(-LE full)
if [[ ${1-} == --full ]]; then chosen=(); shift; fi
scripts/install_dependencies.sh
scripts/build.sh
export PATH=/usr/bin:$PATH
(cd "${BUILD_DIR:-_b}" && ctest -j $(($(nproc) * 2)) --output-on-failure "${chosen[@]}" "$@")
# On the kernel's own SocketCAN and V4L2. An emulated machine is 20 to 30 times slower than this one: what it shows of
# times and pairs is worth something only where nothing else runs, so that is left to be called by hand.
[ $# -gt 0 ] && exit
if [ -w /dev/kvm ] && grep -qwE 'vmx|svm' /proc/cpuinfo; then
  VM_TIMEOUT_S=900 scripts/test_hardware.sh --check
else
  echo "SKIPPED: tests on real SocketCAN and V4L2: no hardware virtualisation; scripts/test_hardware.sh runs them in an emulated machine"
fi
