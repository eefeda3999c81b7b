#!/usr/bin/env bash
# The camera driver on the kernel's own V4L2: vivid and v4l2loopback. To be run where they are.
# Usage: test/hardware/video.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
[[ -e /dev/video0 && -e /dev/video10 && -e /dev/video11 ]] || { echo "no test cameras here" >&2; exit 1; }
status=0
output=$(mktemp)
"${BUILD_DIR:-_b}/devel/lib/arfm_vo/test_hardware" --gtest_filter='V4l2*Test.*' > "$output" 2>&1 || status=1
grep -E '^\[ .*(OK|FAILED|SKIPPED)|^\||Failure|Which|actual|Value|Expected|what\(\)|C\+\+ exception' "$output" || true
# A test that is skipped here has not shown anything.
if grep -q '^\[  SKIPPED' "$output"; then status=1; fi
exit $status
