#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds, and runs the whole default test suite. Everything it makes is in build/.
# Fails when a test fails, when there are no tests, and when there is no OpenCL device to run them on.
set -euo pipefail
[[ " $* " != *" --help "* ]] || { sed -n '2,/^set /s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."

# PoCL asks them about the machine, and aborts without a word of why when they are not there.
for folder in /proc/self /sys/devices; do
  [ -e "$folder" ] || { echo "${folder%/*} is not mounted here; PoCL needs /proc and /sys" >&2; exit 1; }
done
bash tests/install_packages.sh build tests

cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DGNOMON_BUILD_TESTS=ON
cmake --build build --parallel "$(nproc)"

# Exits 3 when there is none.
build/bin/gnomon devices
ctest --test-dir build --no-tests=error --output-on-failure --parallel "$(nproc)"
