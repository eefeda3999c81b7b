#!/usr/bin/env bash
# Tests the drivers on the kernel's real SocketCAN and V4L2, in a small virtual machine (test/virtual_machine.sh):
# every script in test/hardware/ runs in one of its own, and what they tell of faults and recoveries goes to
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
all=()
for script in test/hardware/*.sh; do all+=("$(basename "$script" .sh)"); done
is_check=
if [[ ${1-} == --check ]]; then is_check=1; shift; fi
parts=("$@")
[ $# -gt 0 ] || parts=("${all[@]}")
status=0
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
table=docs/hardware_faults.md

# The tables that a part printed between bars, for its section; of a part that has not run, those that stand there.
tables() {
  if [[ -e $results/$1 ]]; then
    awk '/^\|/ {if (!inside) print ""; print; inside = 1; next} {inside = 0}' "$results/$1"
  else
    awk -v title="## $1" '$0 == title {inside = 1; next} /^## / {inside = 0} inside' "$table" | sed '$ {/^$/d}'
  fi
}
write_tables() {
  echo "# Faults of real drivers, and how soon all is well again"
  echo
  echo "Made by \`scripts/test_hardware.sh\` in a virtual machine without hardware acceleration (20 to 30 times"
  echo "slower than the machine): Debian's kernel with vivid, v4l2loopback and vcan. Times are from the injection."
  for part in "${all[@]}"; do printf '\n## %s\n' "$part"; tables "$part"; done
}
for part in "${parts[@]}"; do
  echo "== $part, in the virtual machine"
  if test/virtual_machine.sh --timeout "${VM_TIMEOUT_S:-1500}" -- "test/hardware/$part.sh" | tee "$results/now"; then
    echo "== $part: passed"
    mv "$results/now" "$results/$part"
    [[ $is_check ]] || { write_tables > "$table.new"; mv "$table.new" "$table"; }
  else
    echo "== $part: FAILED"; status=1
  fi
done
exit $status
