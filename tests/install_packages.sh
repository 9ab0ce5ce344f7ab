#!/usr/bin/env bash
# Installs the Debian packages that gnomon needs, if any are missing. Which ones, by what is to be done:
#   install_packages.sh build          the library and the program, and PoCL to run them on the CPU
#   install_packages.sh build tests    also the test suite, with two more OpenCL implementations
#   install_packages.sh build bench    also the benchmarks and their peer
#   install_packages.sh build demo     also what bench/demo.sh and bench/figures.sh read results with
# Needs root or sudo, and only when something is missing. Never asks.
set -euo pipefail

declare -A packages=(
  [build]="g++ cmake ninja-build pkg-config ocl-icd-opencl-dev opencl-c-headers pocl-opencl-icd libtinygltf-dev
    libtinyobjloader-dev libcli11-dev nlohmann-json3-dev libstb-dev libxxhash-dev libglm-dev"
  [tests]="catch2 libboost-dev mesa-opencl-icd oclgrind help2man jq chromium"
  [bench]="libembree-dev libbenchmark-dev"
  [demo]="jq"
)

missing=()
for group in "$@"; do
  for package in ${packages[$group]:?no such group of packages}; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing+=("$package")
  done
done
[ ${#missing[@]} -gt 0 ] || exit 0

echo "installing: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! sudo -n true 2>/dev/null; then
    echo "these packages are missing and neither root nor sudo without a password is at hand; install them with:" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
# env: sudo does not pass variables on.
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 -o Acquire::Retries=3 "$@"; }
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { apt update && apt install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
  tail -n 30 "$log" >&2
  exit 1
fi
