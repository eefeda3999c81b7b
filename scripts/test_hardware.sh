#!/usr/bin/env bash
# Tests the drivers on the kernel's real SocketCAN and V4L2, in a small virtual machine (scripts/virtual_machine.sh):
# every script in test/hardware/ runs in one of its own, and what they tell of faults and recoveries goes to
# docs/hardware_faults.md. The package must be built. Skipped, with the reason, where there can be no such machine.
# Usage: scripts/test_hardware.sh [PART ...]     video, vcan, chain; default: all
set -euo pipefail
cd "$(dirname "$0")/.."
if reason=$(scripts/virtual_machine.sh --prepare 2>&1); then :; else
  echo "SKIPPED: tests on real SocketCAN and V4L2: $reason"
  exit 0
fi
parts=("$@")
[ $# -gt 0 ] || for script in test/hardware/*.sh; do parts+=("$(basename "$script" .sh)"); done
status=0
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
for part in "${parts[@]}"; do
  echo "== $part, in the virtual machine"
  if scripts/virtual_machine.sh --timeout "${VM_TIMEOUT_S:-1500}" -- "test/hardware/$part.sh" | tee "$results/$part"; then
    echo "== $part: passed"
  else
    echo "== $part: FAILED"; status=1
  fi
done
# Tables only: what the tests printed between bars.
if [ $status -eq 0 ] && [ $# -eq 0 ]; then
  {
    echo "# Faults of real drivers, and how soon all is well again"
    echo
    echo "Made by \`scripts/test_hardware.sh\` in a virtual machine without hardware acceleration (20 to 30 times"
    echo "slower than the machine): Debian's kernel with vivid, v4l2loopback and vcan."
    for part in "${parts[@]}"; do
      grep -q '^|' "$results/$part" || continue
      printf '\n## %s\n' "$part"
      awk '/^\|/ {if (!inside) print ""; print; inside = 1; next} {inside = 0}' "$results/$part"
    done
  } > docs/hardware_faults.md.new
  mv docs/hardware_faults.md.new docs/hardware_faults.md
fi
exit $status
