#!/usr/bin/env bash
# Takes the picture of a report that README shows, of a page made from stored rows, in chromium. Not part of figures.sh:
# browsers and fonts differ, so its bytes do. BUILD: the build folder, build by default.
set -euo pipefail
[[ " $* " != *" --help "* ]] || { sed -n '2,/^set /s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."
build=${BUILD:-build}
bash tests/install_packages.sh build tests
cmake --build "$build" --target compare_figures >/dev/null
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$build/bench/compare_figures" --page bench/results/compare.jsonl "$scratch/report.html"
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --window-size=1100,1330 --user-data-dir="$scratch/profile" \
  --screenshot="$PWD/bench/pictures/report.png" "file://$scratch/report.html" 2>/dev/null
