#!/usr/bin/env bash
# Tests the drivers on the kernel's real SocketCAN and V4L2, in a small virtual machine (test/virtual_machine.sh):
# every part (test/hardware) runs in one of its own, and what they tell of faults and recoveries goes to
# docs/hardware_faults.md. The package must be built. Skipped, with the reason, where there can be no such machine.
# Usage: scripts/test_hardware.sh [--check] [PART ...]     video, vcan, chain; default: all
#        --check leaves docs/hardware_faults.md as it is
set -euo pipefail
[[ ${1-} != @(-h|--help) ]] || { sed -n '1d; /^#/!q; s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."
if reason=$(test/virtual_machine.sh --prepare 2>&1); then :; else
  echo "SKIPPED: tests on real SocketCAN and V4L2: $reason"
  exit 0
fi
is_check=
if [[ ${1-} == --check ]]; then is_check=1; shift; fi
parts=("$@")
[ $# -gt 0 ] || parts=(chain vcan video)
status=0
results=$(mktemp)
trap 'rm -f "$results"' EXIT

# The tables that a part printed, with a blank line between them, for its section.
tables() { grep '^|' "$results" | awk '/^\|-/ && n > 1 {print ""} n {print last} {last = $0; n++} END {print last}'; }
for part in "${parts[@]}"; do
  echo "== $part, in the virtual machine"
  test=("test/hardware/kernel_tests.sh" "$part")
  if [[ $part == chain ]]; then test=(test/hardware/chain.sh); fi
  if test/virtual_machine.sh --timeout "${VM_TIMEOUT_S:-1500}" -- "${test[@]}" | tee "$results"; then
    echo "== $part: passed"
    [[ $is_check ]] || tables | test/readme_section.py docs/hardware_faults.md "$part"
  else
    echo "== $part: FAILED"; status=1
  fi
done
exit $status
