# shellcheck shell=bash
# Sourced by the scripts: --help or -h prints the comment at the caller's head and ends it.
if [[ ${1-} == --help || ${1-} == -h ]]; then
  sed -n '1d; /^#/!q; s/^# \{0,1\}//p' "$0"
  exit
fi
