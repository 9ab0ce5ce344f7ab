#!/usr/bin/env bash
# Every program and script named answers --help at once, without a device, and tells its use.
#   help.sh PROGRAM...
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
faults=0
fault() {
  echo "FAULT: $*"
  faults=$((faults + 1))
}
for program in "$@"; do
  name=$(basename "$program")
  start=("$program")
  [[ $program != *.sh ]] || start=(bash "$program")
  OCL_ICD_VENDORS=/nonexistent timeout 20 "${start[@]}" --help >"$scratch/out" 2>"$scratch/err" || fault "$name exits $?"
  [ ! -s "$scratch/err" ] || fault "$name complains: $(head -n 3 "$scratch/err")"
  [ "$(wc -c <"$scratch/out")" -ge 100 ] || fault "$name says little: $(cat "$scratch/out")"
done
echo "$# programs, $faults faults"
[ "$faults" = 0 ] && [ $# -gt 15 ]
