#!/usr/bin/env bash
# Measures how the rover stops at each fault and writes docs/faults.md. Usage: scripts/measure.sh fault_table
set -euo pipefail
scripts/build.sh test_simulation
ARFM_VO_FAULT_TABLE=$PWD/docs/faults.md \
  "${BUILD_DIR:-_b}/devel/lib/arfm_vo/test_simulation" --gtest_filter='FaultTable.*' --gtest_brief=1
