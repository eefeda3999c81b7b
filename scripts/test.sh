#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test. Usage: scripts/test.sh [CTEST_ARGUMENT ...]
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_dependencies.sh
scripts/build.sh
export PATH=/usr/bin:$PATH
cd "${BUILD_DIR:-_b}" && ctest --output-on-failure "$@"
