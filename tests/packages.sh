#!/usr/bin/env bash
# README's table of dependencies names every package that install_packages.sh installs, and no other.
#   packages.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
installed=$(sed -n '/^declare -A packages=(/,/^)/p; /^declare -A optional=/p' tests/install_packages.sh |
  sed 's/^declare -A [a-z]*=(//; s/\[[a-z]*\]=//g' | tr -d '"()' | tr ' ' '\n' | grep . | sort -u)
named=$(sed -n '/^## Dependencies/,/^## [^D]/p' README.md | grep '^| `' | cut -d'|' -f2 | grep -oE '`[^`]+`' | tr -d '`' | sort -u)
[ "$(wc -l <<<"$named")" -gt 10 ] || { echo "no table of dependencies was found"; exit 1; }
difference=$(diff <(echo "$installed") <(echo "$named")) ||
  { echo "install_packages.sh (<) and README (>) differ:"; echo "$difference"; exit 1; }
