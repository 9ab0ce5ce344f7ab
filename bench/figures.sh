#!/usr/bin/env bash
# Makes every table, page and chart that comes from stored rows anew, from the rows alone: README's tables, example and
# charts, the pages of failures, of hard rays, of trees for given rays, of methods, of devices and of growth, the page that
# describes rows, and tables of the notes. The tests readme_is_current, compare_figures_are_current, failure_map_is_current,
# ray_aware_is_current, scaling_is_current, stability_page_is_current, results_page_is_current and note_tables_are_current
# hold what is stored against the same programs. BUILD: the build folder, build by default.
set -euo pipefail
[[ " $* " != *" --help "* ]] || { sed -n '2,/^set /s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."
build=${BUILD:-build}
bash tests/install_packages.sh build demo
cmake -S . -B "$build" -G Ninja -DGNOMON_BUILD_BENCH=ON >/dev/null
cmake --build "$build" --parallel "$(nproc)" --target readme_table compare_figures failure_map_page \
  ray_aware_page ray_aware_time_page stability_page scaling_page results_page

results=bench/results
"$build/bench/readme_table" $results/spine.jsonl tests/consumer/main.cpp README.md
[ ! -f $results/compare.jsonl ] || [ ! -f $results/devices.jsonl ] ||
  "$build/bench/compare_figures" $results/compare.jsonl $results/devices.jsonl README.md $results bench/pictures
"$build/bench/failure_map_page" $results/failure_map.jsonl $results/failure-map.md
"$build/bench/ray_aware_page" $results/ray_aware.jsonl $results/ray-aware.md
"$build/bench/stability_page" $results/{stability,stability_peer,accuracy}.jsonl $results/stability.md
"$build/bench/ray_aware_time_page" $results/ray_aware_time.jsonl $results/ray-aware-time.md
"$build/bench/scaling_page" $results/scaling.jsonl $results/scaling.md bench/pictures
"$build/bench/results_page" $results/README.md
bash bench/note_tables.sh
git --no-pager diff --stat -- README.md $results bench/pictures host/notes 2>/dev/null || true
