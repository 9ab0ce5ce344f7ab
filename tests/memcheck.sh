#!/usr/bin/env bash
# Runs a test program in the OpenCL simulator oclgrind, which watches every load and store of the kernels.
#   memcheck.sh PROGRAM ARGUMENTS...
# oclgrind's own exit status says nothing of what it saw: the program must succeed and the log must be empty.
set -euo pipefail
log=$(mktemp)
trap 'rm -f "$log"' EXIT
status=0
GNOMON_DEVICE=oclgrind oclgrind --data-races --uninitialized --max-errors 20 --log "$log" "$@" || status=$?
if [ -s "$log" ]; then
  echo "oclgrind reports:"
  head -n 200 "$log"
  exit 1
fi
exit "$status"
