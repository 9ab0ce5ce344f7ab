#!/usr/bin/env bash
# Runs a test program in the OpenCL simulator oclgrind, which watches every load and store of the kernels.
#   memcheck.sh PROGRAM ARGUMENTS...
# oclgrind's own exit status says nothing of what it saw: the program must succeed and the log must be empty.
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# Programs from the cache would have been compiled with other options.
export XDG_CACHE_HOME=$scratch GNOMON_DEVICE=oclgrind
status=0
# Inlining makes calls that oclgrind 21.10 does not know (llvm.experimental.noalias.scope.decl).
oclgrind --data-races --uninitialized --build-options -cl-opt-disable --max-errors 20 --log "$scratch/log" "$@" ||
  status=$?
if [ -s "$scratch/log" ]; then
  echo "oclgrind reports:"
  head -n 200 "$scratch/log"
  exit 1
fi
exit "$status"
