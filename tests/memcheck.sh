#!/usr/bin/env bash
# Runs a test program in the OpenCL simulator oclgrind, which watches every load and store of the kernels.
#   memcheck.sh PROGRAM ARGUMENTS...
# oclgrind's own exit status says nothing of what it saw: the program must succeed and the log must be empty.
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# Programs from the cache would have been compiled with other options.
export XDG_CACHE_HOME=$scratch GNOMON_DEVICE=oclgrind
# A kernel that never ends writes to its stack for ever, and oclgrind keeps every page of it: it shall fail, not take the
# machine's memory with it. 8 GiB is four times what the tests need.
ulimit -v 8388608
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
