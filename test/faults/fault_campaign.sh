#!/usr/bin/env bash
# Injects faults into the running nodes of the simulated rover and writes the tables of docs/fault_campaign.md.
# Usage: scripts/measure.sh fault_campaign [--only TEXT|TEXT|..]      with --only nothing is written
set -euo pipefail
scripts/build.sh chassis_node chassis_guard simulator_node arfm_node pose_node ba_node truth_path_node arfm_vo_generate_messages_py
set +u; . "${BUILD_DIR:-_b}/devel/setup.sh"; set -u
if [ $# -eq 0 ]; then set -- --output docs/fault_campaign.md; fi
exec test/faults/fault_campaign.py "$@"
