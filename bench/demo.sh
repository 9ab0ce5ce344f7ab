#!/usr/bin/env bash
# The main job on a fresh Debian 12: installs what is missing, builds the program, makes a picture of the atrium through a
# tree built on the default OpenCL device, checks the answers, sets every method beside the others, and prints where the
# pictures and the report are and what it cost.
# Everything it makes is in build/demo/. GNOMON_DEVICE chooses another device; SCENE another scene, a file or gen:NAME.
set -euo pipefail
[[ " $* " != *" --help "* ]] || { sed -n '2,/^set /s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."
bash tests/install_packages.sh build demo

out=build/demo
cmake -S . -B $out -G Ninja -DCMAKE_BUILD_TYPE=Release -DGNOMON_BUILD_TESTS=OFF -DGNOMON_BUILD_BENCH=OFF
cmake --build $out --parallel "$(nproc)" --target gnomon_program

gnomon=$out/bin/gnomon
scene=${SCENE:-scenes/atrium.glb}
kinds="primary bounce shadow random parallel"
$gnomon render "$scene" -o $out/atrium.png --heat-map $out/atrium-boxes.png
$gnomon build "$scene" --repeat 5 --json >$out/build.json
for kind in $kinds; do
  $gnomon trace "$scene" --rays "$kind" --count 250k --json >$out/trace-"$kind".json
done
# Exits 6 for a mismatch, which ends the demo here.
$gnomon validate "$scene" --json >$out/validate.json

# Which method to use for this scene on this device, and why: a page to open in a browser.
$gnomon compare "$scene" --time 2m -o $out/report.html >$out/advice.txt

row() { printf '%-18s %s\n' "$1" "$2"; }
tree=$(jq -er '"device\t\(.device), driver \(.driver)",
  "triangles\t\(.triangles)",
  "build\t\(.build.total_ms * 100 | round / 100) ms (median of \(.build.runs))",
  (.build.stages | to_entries[] | "  \(.key)\t\(.value * 100 | round / 100) ms"),
  "tree\t\(.tree.nodes) nodes, \(.tree.leaves) leaves, depth \(.tree.max_depth)",
  "SAH cost\t\(.tree.sah_cost * 100 | round / 100)"' $out/build.json)
echo
while IFS=$'\t' read -r name value; do row "$name" "$value"; done <<<"$tree"
for kind in $kinds; do
  speed=$(jq -er '.mrays_per_s.median * 1000 | round / 1000' $out/trace-"$kind".json)
  row "$kind rays" "$speed Mrays/s"
done
judged=$(jq -er '"\(.mismatches) in \(.rays_judged) rays judged"' $out/validate.json)
row "mismatches" "$judged"
row "picture" "$PWD/$out/atrium.png"
row "boxes per pixel" "$PWD/$out/atrium-boxes.png"
row "report" "$PWD/$out/report.html"
echo
sed '/^$/,$d' $out/advice.txt
echo "Next: open the report in a browser; then ask for your own scene (glTF or OBJ), or a generated one:"
echo "  $gnomon compare my.glb -o my.html        $gnomon compare gen:city:100k -o city.html"
echo "  $gnomon --help teaches the rest"
