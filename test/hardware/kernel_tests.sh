#!/usr/bin/env bash
# The drivers of the CAN bus and the chassis on the kernel's own SocketCAN (vcan), or that of the camera on its own V4L2
# (video: vivid and v4l2loopback). To be run where these are, as root.
# Usage: test/hardware/kernel_tests.sh vcan|video
set -euo pipefail
cd "$(dirname "$0")/../.."
if [[ ${1-} == vcan ]]; then
  ip link show vcan0 > /dev/null
  tests=("test_hardware --gtest_filter=SocketCanTest.*:*GuardedBusTest*/vcan" "test_simulation --gtest_filter=VcanDriveTest.*")
else
  [[ -e /dev/video0 && -e /dev/video10 && -e /dev/video11 ]] || { echo "no test cameras here" >&2; exit 1; }
  tests=("test_hardware --gtest_filter=V4l2*Test.*")
fi
status=0
output=$(mktemp)
for test in "${tests[@]}"; do
  # shellcheck disable=SC2086
  "${BUILD_DIR:-_b}/devel/lib/arfm_vo"/$test >> "$output" 2>&1 || status=1
done
grep -E '^\[ .*(OK|FAILED|SKIPPED)|Failure|Which|actual|Value|Expected|what\(\)|C\+\+ exception' "$output" || true
if [[ $1 == vcan ]]; then printf '| fault on vcan0, while driving | the drive stops after, ms | to go on |\n|---|---|---|\n'; fi
grep '^|' "$output" || true
# A test that is skipped here has not shown anything.
if grep -q '^\[  SKIPPED' "$output"; then status=1; fi
exit $status
