#!/usr/bin/env bash
# The CAN bus and the chassis driver on the kernel's own SocketCAN. To be run where vcan0 is, as root.
# Usage: test/hardware/vcan.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
ip link show vcan0 > /dev/null
programs=${BUILD_DIR:-_b}/devel/lib/arfm_vo
status=0
output=$(mktemp)
for test in "test_hardware --gtest_filter=SocketCanTest.*:*GuardedBusTest*/vcan" "test_simulation --gtest_filter=VcanDriveTest.*"; do
  # shellcheck disable=SC2086
  "$programs"/$test >> "$output" 2>&1 || status=1
done
grep -E '^\[ .*(OK|FAILED|SKIPPED)|Failure|Which|actual' "$output" || true
echo "| fault on vcan0, while driving | the drive stops after, ms | to go on |"
echo "|---|---|---|"
grep '^|' "$output" || true
# A test that is skipped here has not shown anything.
if grep -q '^\[  SKIPPED' "$output"; then status=1; fi
exit $status
