#!/usr/bin/env bash
# Takes stored rows again, with the arguments they were taken with, and says what moved beyond its spread.
#   rerun.sh [NAME...]     the files of bench/results to take again, without .jsonl; by default all (hours)
#   rerun.sh --list        their names
# New rows go to build/rows/NAME.jsonl. To keep them: cat build/rows/NAME.jsonl >> bench/results/NAME.jsonl, then
# bench/figures.sh. Leave the machine alone meanwhile. GNOMON_DEVICE chooses another device,
# GNOMON_DEVICES those of "devices". The thesis' set-ups, which
# reproduce, exit_rule, ray_aware and ray_aware_time need, are named by THESIS_CONFIGS, THESIS_SCENES and THESIS_PUBLISHED.
set -euo pipefail
[[ " $* " != *" --help "* ]] || { sed -n '2,/^set /s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."
build=${BUILD:-build}
gnomon() { "$build/bin/gnomon" "$@"; }
beside_embree() { "$build/bench/gnomon_bench" "$@"; }

take_accuracy() { "$build/bench/accuracy_bench"; }
take_compact() {
  beside_embree --scenes atrium,terrain,city,random --flavours wide,thread,compact --rounds 2 --ray-count 131072 \
    --rays primary,bounce
}
# Reports lie beside the rows: build/rows/compare-atrium.html, compare-city.html, devices.html.
take_compare() {
  # Processor time: the scheduler's share of waiting time on few cores is larger than what is to be told apart.
  gnomon compare scenes/atrium.glb --clock cpu --afresh -o "$build/rows/compare-atrium.html" --rows /dev/fd/3 3>&1 >/dev/null
  gnomon compare gen:city:1M --clock cpu --time 600s --afresh -o "$build/rows/compare-city.html" --rows /dev/fd/3 3>&1 >/dev/null
}
# PoCL, with its portable path beside the other, and rusticl, which is slow there: small scenes, few rays.
take_devices() {
  local scene
  for scene in gen:cottage:7k gen:city:20k; do
    RUSTICL_ENABLE=llvmpipe gnomon compare "$scene" --devices "${GNOMON_DEVICES:-pthread,llvmpipe}" --rays primary,shadow,random \
      --methods sah-fast,sah-balanced/portable --ray-count 4096 --judged-rays 1000 --rounds 5 --time 10m --afresh \
      -o "$build/rows/devices.html" --rows /dev/fd/3 3>&1 >/dev/null
  done
}
take_exit_rule() {
  "$build/bench/exit_rule_bench" "${THESIS_CONFIGS:?the set-ups, a JSON file}" "${THESIS_SCENES:?a folder}"
}
take_failure_map() { "$build/bench/failure_map_bench"; }
take_heuristic() { "$build/bench/heuristic_bench"; }
take_heuristic_seam() { "$build/bench/spine_bench" atrium 200000; }
take_ray_aware() {
  "$build/bench/ray_aware_bench" thesis --configs "${THESIS_CONFIGS:?the set-ups, a JSON file}" \
    --scenes "${THESIS_SCENES:?a folder}"
  "$build/bench/ray_aware_bench" generated
}
take_ray_aware_time() {
  "$build/bench/ray_aware_time"
  "$build/bench/ray_aware_time" --scenes city,forest --triangles 1000000 --rays 16384
  "$build/bench/plan_clock_bench" thesis --configs "${THESIS_CONFIGS:?the set-ups, a JSON file}" \
    --scenes "${THESIS_SCENES:?a folder}"
  "$build/bench/plan_clock_bench" generated
}
take_render() {
  "$build/bench/render_bench" --scenes atrium --samples 64 --rounds 5
  "$build/bench/render_bench" --scenes atrium,city,terrain,forest,crowd,cottage --size 256 --samples 8 --rounds 5 --ways light
}
take_reproduce() {
  gnomon reproduce --configs "${THESIS_CONFIGS:?the set-ups, a JSON file}" --scenes "${THESIS_SCENES:?a folder}" \
    --published "${THESIS_PUBLISHED:?the published results, a CSV file}" --rows /dev/fd/3 3>&1 >/dev/null
}
take_scaling() {
  "$build/bench/scaling_bench" units
  "$build/bench/scaling_bench" sizes --scenes terrain,random --least 1000 --most 10000000
}
take_speed() {
  local single=bounce,bounce-shuffled,random,shadow coherent=primary,shadow,sun-axis,sun-oblique
  local flavours=wide,portable,auto,sorted builders=balanced,fast,best
  beside_embree --scenes atrium,terrain,random --ray-count 131072 --rounds 5 --rays $single \
    --flavours $flavours --builders $builders
  beside_embree --scenes city --ray-count 32768 --rounds 5 --rays $single --flavours $flavours \
    --builders $builders
  beside_embree --scenes atrium,terrain,random --ray-count 1048576 --rounds 5 --rays $coherent \
    --flavours auto,wide --no-build
  beside_embree --scenes city --ray-count 262144 --rounds 5 --rays $coherent --flavours auto,wide --no-build
  beside_embree --scenes atrium,terrain,city --ray-count 262144 --rounds 5 --no-build \
    --rays point-shuffled,sun-axis-shuffled,sun-oblique-shuffled,shadow-shuffled --flavours auto,sorted,light-sorted
  beside_embree --scenes atrium,terrain,random,city --ray-count 131072 --rounds 5 --all-threads --rays bounce,shadow \
    --flavours wide --builders balanced,fast,best
  beside_embree --scenes atrium,terrain,random,city --triangles 100000 --rounds 9 --ray-count 131072 \
    --rays primary,bounce --flavours auto,wide --builders balanced,fast
}
take_spine() { "$build/bench/spine_bench"; }
take_stability() {
  gnomon stability --rows /dev/fd/3 3>&1 >/dev/null
  gnomon stability --rays 1e8 --rows /dev/fd/3 3>&1 >/dev/null
}
take_stability_peer() { "$build/bench/stability_peer"; }
take_top_level() { "$build/bench/top_level_bench"; }

mapfile -t known < <(declare -F | sed -n 's/^declare -f take_//p' | sort)
if [ "${1:-}" = --list ]; then
  printf '%s\n' "${known[@]}"
  exit
fi
names=("$@")
[ ${#names[@]} -gt 0 ] || names=("${known[@]}")
for name in "${names[@]}"; do
  [[ " ${known[*]} " = *" $name "* ]] || { echo "no such rows: $name; rerun.sh --list names them" >&2; exit 2; }
done

[ -f "$build/CMakeCache.txt" ] || bash tests/install_packages.sh build bench
cmake -S . -B "$build" -G Ninja -DGNOMON_BUILD_BENCH=ON >/dev/null
cmake --build "$build" --parallel "$(nproc)"
mkdir -p "$build/rows"
for name in "${names[@]}"; do
  echo "== $name" >&2
  "take_$name" >"$build/rows/$name.partial"
  mv "$build/rows/$name.partial" "$build/rows/$name.jsonl"
  # 7: something moved, which is for people to read.
  [ -f "bench/results/$name.jsonl" ] || continue
  gnomon rows diff "bench/results/$name.jsonl" "$build/rows/$name.jsonl" || [ $? -eq 7 ]
done
