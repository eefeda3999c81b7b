#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test. Usage: scripts/test.sh [CTEST_ARGUMENT ...]
# With arguments only ctest runs, without the tests in the virtual machine.
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
scripts/install_dependencies.sh
scripts/build.sh
export PATH=/usr/bin:$PATH
(cd "${BUILD_DIR:-_b}" && ctest --output-on-failure "$@")
# On the kernel's own SocketCAN and V4L2. An emulated machine is 20 to 30 times slower than this one: what it shows of
# times and pairs is worth something only where nothing else runs, so that is left to be called by hand.
[ $# -gt 0 ] && exit
if [ -w /dev/kvm ] && grep -qwE 'vmx|svm' /proc/cpuinfo; then
  VM_TIMEOUT_S=900 scripts/test_hardware.sh --check
else
  echo "SKIPPED: tests on real SocketCAN and V4L2: no hardware virtualisation; scripts/test_hardware.sh runs them in an emulated machine"
fi
