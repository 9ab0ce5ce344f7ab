#!/usr/bin/env bash
# Installs the Debian packages that gnomon needs, if any are missing. Which ones, by what is to be done:
#   install_packages.sh build          the library and the program, and PoCL to run them on the CPU
#   install_packages.sh build tests    also the test suite, with two more OpenCL implementations
#   install_packages.sh build bench    also the benchmarks and their peer
#   install_packages.sh build demo     also what bench/demo.sh and bench/figures.sh read results with
# Needs root or sudo, and only when something is missing. Never asks.
set -euo pipefail
[[ " $* " != *" --help "* ]] || { sed -n '2,/^set /s/^# \{0,1\}//p' "$0"; exit; }

declare -A packages=(
  [build]="g++ cmake ninja-build pkg-config ocl-icd-opencl-dev opencl-c-headers pocl-opencl-icd libtinygltf-dev
    libtinyobjloader-dev libcli11-dev nlohmann-json3-dev libstb-dev libxxhash-dev libglm-dev"
  [tests]="catch2 libboost-dev mesa-opencl-icd oclgrind help2man jq"
  [bench]="libembree-dev"
  [demo]="jq"
)

# What tests go without where the distribution does not have it as a package (Ubuntu's chromium is a snap).
declare -A optional=([tests]="chromium")

is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }
is_known() { [ -n "$(apt-cache madison "$1" 2>/dev/null)" ]; }

missing=()
wished=()
for group in "$@"; do
  for package in ${packages[$group]:?no such group of packages}; do
    is_installed "$package" || missing+=("$package")
  done
  for package in ${optional[$group]:-}; do
    is_installed "$package" || wished+=("$package")
  done
done
# Where all else is there, lists of packages are fresh enough to say whether those could be had.
if [ ${#missing[@]} -eq 0 ]; then
  for package in "${wished[@]}"; do
    ! is_known "$package" || missing+=("$package")
  done
  wished=()
fi
[ ${#missing[@]} -gt 0 ] || exit 0

echo "installing: ${missing[*]} ${wished[*]}"
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
or_fail() { "$@" >>"$log" 2>&1 || { tail -n 30 "$log" >&2; exit 1; }; }
or_fail apt update
for package in "${wished[@]}"; do
  if is_known "$package"; then
    missing+=("$package")
  else
    echo "$package is no package here; tests that need it are left out" >&2
  fi
done
[ ${#missing[@]} -eq 0 ] || or_fail apt install -y --no-install-recommends "${missing[@]}"
