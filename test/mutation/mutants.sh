#!/usr/bin/env bash
# Breaks the code in many ways, one at a time, and tells which of them the tests notice.
# Usage: scripts/measure.sh mutants [OPTION ..]       scripts/measure.sh mutants --help; without options writes docs/mutation.md (hours)
#        scripts/measure.sh mutants FOLDER [--sample N] [--seed N]     such as src/pose: 60 changes of its sources
set -euo pipefail
[ -z "$(git status --porcelain src include nodes)" ] || { echo "mutants: src, include and nodes must be as committed" >&2; exit 1; }
if [ $# -eq 0 ]; then set -- --sample 200 --output docs/mutation.md; fi
exec test/mutation/mutation.py "$@"
