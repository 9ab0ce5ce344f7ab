#!/usr/bin/env bash
# A machine without any OpenCL platform must not look healthy: the device tests fail, and say what to install.
#   no_device.sh DEVICE_TEST [ARGUMENTS...]
set -euo pipefail
export OCL_ICD_VENDORS=/nonexistent
unset GNOMON_DEVICE
test=$1
shift
if output=$("$test" "[portable]" "$@" 2>&1); then
  echo "the device tests pass where there is no device:"
  echo "$output"
  exit 1
fi
grep -q "no OpenCL device found. Install" <<<"$output" || { echo "no word of what to install:"; echo "$output"; exit 1; }
