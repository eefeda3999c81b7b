#!/usr/bin/env bash
# Breaks the code in many ways, one at a time, and tells which of them the tests notice.
# Usage: scripts/mutants.sh [OPTION ..]       scripts/mutants.sh --help; without options writes docs/mutation.md (hours)
#        scripts/mutants.sh FOLDER [--sample N] [--seed N]     such as src/pose: 60 changes of its sources
set -euo pipefail
cd "$(dirname "$0")/.."
export PATH=/usr/bin:$PATH
[ -z "$(git status --porcelain src include nodes)" ] || { echo "mutants: src, include and nodes must be as committed" >&2; exit 1; }
if [ $# -eq 0 ]; then set -- --sample 200 --output docs/mutation.md; fi
exec scripts/mutation/mutation.py "$@"
