#!/usr/bin/env bash
# Injects faults into the running nodes of the simulated rover and writes docs/fault_campaign.md.
# Usage: scripts/fault_campaign.sh [--only TEXT|TEXT|..]      with --only nothing is written
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
export PATH=/usr/bin:$PATH
scripts/build.sh chassis_node simulator_node arfm_node pose_node ba_node truth_path_node arfm_vo_generate_messages_py
set +u; . "${BUILD_DIR:-_b}/devel/setup.sh"; set -u
if [ $# -eq 0 ]; then set -- --output docs/fault_campaign.md; fi
exec scripts/fault_campaign/fault_campaign.py "$@"
