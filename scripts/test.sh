#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test. Usage: scripts/test.sh [CTEST_ARGUMENT ...]
# With arguments only ctest runs, without the tests in the virtual machine.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_dependencies.sh
scripts/build.sh
export PATH=/usr/bin:$PATH
(cd "${BUILD_DIR:-_b}" && ctest --output-on-failure "$@")
# On the kernel's own SocketCAN and V4L2; says so where there can be no virtual machine for it.
[ $# -gt 0 ] || VM_TIMEOUT_S=900 scripts/test_hardware.sh video vcan
