#!/usr/bin/env bash
# Feeds what is wrong to all that listens, under the address and undefined behaviour sanitizers: a million CAN frames,
# 10,000 replies of the pan-tilt unit, and NUMBER (default 100000) malformed messages on each subscribed topic
# through the nodes' classes. Prints the figures of the messages; status 1
# where a test fails or a sanitizer reports.
# Usage: scripts/measure.sh malformed_input [NUMBER]
set -euo pipefail
number=${1:-100000}
[[ $number =~ ^[0-9]+$ ]] || { sed -n '2,6s/^# \?//p' "$0" >&2; exit 2; }
export BUILD_DIR=${BUILD_DIR:-_b_address}
mkdir -p "$BUILD_DIR"
export ARFM_VO_MALFORMED_MESSAGES=$number ARFM_VO_MALFORMED_TABLE=$PWD/$BUILD_DIR/malformed.md
export GTEST_FILTER='ChassisFuzz*:ChassisProtocolFuzz*:PanTiltTest.TenThousand*:Malformed*'
rm -f "$ARFM_VO_MALFORMED_TABLE"
scripts/test_sanitized.sh address test_hardware malformed_nodes
cat "$ARFM_VO_MALFORMED_TABLE"
