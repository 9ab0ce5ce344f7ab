#!/usr/bin/env bash
# Writes the tables of host/notes that come from stored rows, between their markers; the thesis' figures among them are
# constants here. With --check it changes nothing and fails where a note is not what its rows give. Needs jq.
#   note_tables.sh [--check]
set -euo pipefail
[[ " $* " != *" --help "* ]] || { sed -n '2,/^set /s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."
check=${1:-}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
behind=0

# fixed(2): two digits after the point, half up.
common='
def fixed($d): pow(10; $d) as $p | (. * $p + 0.5 | floor) as $i |
  if $d == 0 then "\($i)" else "\($i / $p | floor).\("000\($i % $p)" | .[-$d:])" end;
def line: "| " + join(" | ") + " |";
'

# table NOTE NAME ROWS JQ: the lines that the jq program makes of all rows, between "<!-- NAME begin -->" and its end.
table() {
  local note=host/notes/$1 name=$2
  jq -rs "$common $4" "bench/results/$3" >"$scratch/table"
  grep -qF "<!-- $name begin -->" "$note" && grep -qF "<!-- $name end -->" "$note" ||
    { echo "$note has no markers for $name" >&2; exit 1; }
  awk -v name="$name" -v table="$scratch/table" '
    $0 == "<!-- " name " end -->" { inside = 0 }
    !inside
    $0 == "<!-- " name " begin -->" { inside = 1; while ((getline text < table) > 0) print text }' "$note" >"$scratch/note"
  cmp -s "$scratch/note" "$note" && return
  behind=1
  if [ "$check" = --check ]; then
    echo "$note is behind bench/results/$3: run bench/figures.sh" >&2
    diff "$note" "$scratch/note" >&2 || true
  else
    cp "$scratch/note" "$note"
  fi
}

# The newest rows, beside those of the commit before precise measures were looked into.
table heuristics.md measures heuristic.jsonl '
  def of($commit; $scene; $measure):
    map(select(.commit == $commit and .scene == $scene and .measure == $measure))[-1].ratio.median | fixed(2);
  last.commit as $new | "b1925250ecc2" as $old | . as $rows |
  (["rays", "city", "atrium", "before, city and atrium"] | line), "|---|---|---|---|",
  (["parallel", "plane"], ["parallel, window", "plane, culled"], ["point, solid angle", "point, solid angle"],
   ["point, solid angle, window", "point, solid angle, culled"],
   ["point, near plane, window", "point, near plane, culled"],
   ["point, yaw and pitch, window", "point, yaw and pitch, culled"] |
   .[0] as $name | .[1] as $measure | $rows |
   [$name, of($new; "city"; $measure), of($new; "atrium"; $measure),
    "\(of($old; "city"; $measure)), \(of($old; "atrium"; $measure))"] | line)'

table top-level.md "areas of a point" top_level.jsonl '
  {"4": ["", "(0.74)"], "10": ["", "(1.25)"], "20": ["2.2", "3.9 (1.75)"], "40": ["", "(3.0)"], "80": ["", "(5.3)"]}
    as $thesis | . as $rows |
  (["areas", "list", "octree, level 7", "on the host", "thesis: list", "octree, level 7"] | line),
  "|---|---|---|---|---|---|",
  (4, 10, 20, 40, 80 | tostring as $n | . as $areas |
   ($rows | map(select(.areas == $areas and .structure == "list"))[-1]) as $list |
   ($rows | map(select(.areas == $areas and .max_level == 7))[-1]) as $octree |
   "| \($n) | \($list.device_mqueries_per_s.median | fixed(1)) | " +
   "\($octree.device_mqueries_per_s.median | fixed(1)) (\($octree.device_ratio_to_list.median | fixed(2))) | " +
   "\($list.host_mqueries_per_s.median | fixed(1)), \($octree.host_mqueries_per_s.median | fixed(1)) " +
   "(\($octree.host_ratio_to_list.median | fixed(2))) |" +
   ($thesis[$n][0] | if . == "" then " | " else " \(.) | " end) + "\($thesis[$n][1]) |")'

table top-level.md "octree levels" top_level.jsonl '
  map(select(.areas == 20 and .structure != "bvh")) |
  "| 20 areas, level | list | 4 | 5 | 6 | 7 | 8 | 9 |", "|---|---|---|---|---|---|---|---|",
  (["millions of queries a second"] + map(.device_mqueries_per_s.median | fixed(1)) | line),
  (["false candidates per true one"] + map(.false_per_true_candidate | fixed(2)) | line),
  "| thesis: millions of queries a second | 2.2 | 8.1 | 7.3 | 6.1 | 3.9 | 2.6 | 1.9 |",
  "| thesis: false candidates per true one | | 1.10 | 0.40 | 0.14 | 0.07 | 0.03 | 0.01 |"'

# Rays and measure agree; the wide view of the cottage is apart.
table reproduction.md predictions reproduce.jsonl '
  def percent: (if . < 0 then 0 else . end) * 100 | fixed(1) + " %";
  def noise: .real.standard_error / .real.mean;
  map(select(.task == "prediction" and .rays == .measure)) |
  def of($suffix; $wide): map(select((.rays | endswith($suffix)) and (.orientation == "130x45") == $wide));
  . as $all |
  (["rays", "mean error", "worst", "mean noise", "worst beyond 2 noise", "130 by 45, cottage"] | line),
  "|---|---|---|---|---|---|",
  (["parallel rays", "parallel"], ["yaw and pitch", "yaw and pitch"], ["near plane", "near plane"],
   ["solid angle", "solid angle"] |
   .[0] as $suffix | .[1] as $name | ($all | of($suffix; false)) as $rows | ($all | of($suffix; true)) as $wide |
   "| \($name), \($rows | length)" + (if $name == "parallel" then " set-ups | " else " | " end) +
   ([($rows | map(.error | fabs) | add / length), ($rows | map(.error | fabs) | max),
     ($rows | map(noise) | add / length), ($rows | map((.error | fabs) - 2 * noise) | max) | percent] | join(" | ")) +
   (if $wide == [] then " | |" else
      " | \($wide[0].error | fabs | percent) (noise \($wide[0] | noise | percent)) |" end))'

# Ratios to Embree of the newest rows, a line for each figure that is asked for; of one thread, or of all.
speed='  map(select(.triangles > 900000 and (.threads == 1) == $one)) | last.commit as $new | map(select(.commit == $new)) as $rows |
  ["atrium", "terrain", "random", "city"] as $scenes |
  def geomean: (map(log) | add / length | exp);
  def cell: .ratio | "\(.median | fixed(2)) (\(.min | fixed(2))–\(.max | fixed(2)))";
  def found($scene; $task; $rays; $ours; $peer; $many): $rows | map(select(.scene == $scene and .task == $task and .rays == $rays and
    .ours == $ours and .peer == $peer and ($many == null or (.ray_count > 150000) == $many)))[-1];
  def entry($name; $task; $rays; $ours; $peer; $many):
    [$scenes[] | found(.; $task; $rays; $ours; $peer; $many) | select(. != null)] as $found |
    "| \($name) | " + ([$scenes[] | found(.; $task; $rays; $ours; $peer; $many) | if . == null then "–" else cell end] | join(" | ")) +
    " | \([$found[].ratio.median] | geomean | fixed(2)) |";
'
table speed.md speed speed.jsonl "true as \$one | $speed"'
  def over($name; $task; $rays):
    [$scenes[] | (found(.; $task; $rays; "portable"; "MEDIUM 1"; false).ratio.median /
                  found(.; $task; $rays; "wide"; "MEDIUM 1"; false).ratio.median)] as $shares |
    "| \($name) | " + ([$shares[] | fixed(2)] | join(" | ")) + " | \($shares | geomean | fixed(2)) |";
  "Commit \($new), \($rows[0].device).", "",
  (["", "atrium", "terrain", "random", "city", "geomean"] | line), "|---|---|---|---|---|---|",
  entry("closest hit, bounce, single"; "closest hit"; "bounce"; "wide"; "MEDIUM 1"; false),
  entry("the same, ROBUST"; "closest hit"; "bounce"; "wide"; "MEDIUM ROBUST 1"; false),
  entry("any hit, shadow, single"; "any hit"; "shadow"; "wide"; "MEDIUM 1"; false),
  entry("the same, `kAuto`"; "any hit"; "shadow"; "auto"; "MEDIUM 1"; false),
  entry("primary, `kAuto`, of 16"; "closest hit"; "primary"; "auto"; "MEDIUM 16"; null),
  entry("shadow, `kAuto`, of 16"; "any hit"; "shadow"; "auto"; "MEDIUM 16"; true),
  entry("sun along an axis, `kAuto`, of 16"; "any hit"; "sun-axis"; "auto"; "MEDIUM 16"; null),
  entry("oblique sun, `kAuto`, of 16"; "any hit"; "sun-oblique"; "auto"; "MEDIUM 16"; null),
  entry("shuffled bounce, sorted, single"; "closest hit"; "bounce-shuffled"; "sorted"; "MEDIUM 1"; false),
  entry("shuffled shadow, sorted by light, single"; "any hit"; "shadow-shuffled"; "light-sorted"; "MEDIUM 1"; null),
  entry("balanced, MEDIUM"; "build"; null; "balanced"; "MEDIUM"; null),
  entry("fast, LOW"; "build"; null; "fast"; "LOW"; null),
  entry("its tree, bounce, single"; "closest hit"; "bounce"; "wide"; "LOW 1"; false),
  entry("best, HIGH"; "build"; null; "best"; "HIGH"; null),
  entry("its tree, bounce, single"; "closest hit"; "bounce"; "wide"; "HIGH 1"; false),
  entry("its tree, shadow, single"; "any hit"; "shadow"; "wide"; "HIGH 1"; false),
  over("portable over wide, bounce"; "closest hit"; "bounce"),
  over("portable over wide, shadow"; "any hit"; "shadow")'
table speed.md "all threads" speed.jsonl "false as \$one | $speed"'
  "Commit \($new), \($rows[0].device), \($rows[0].threads) threads.", "",
  (["", "atrium", "terrain", "random", "city", "geomean"] | line), "|---|---|---|---|---|---|",
  entry("closest hit, bounce, single"; "closest hit"; "bounce"; "wide"; "MEDIUM 1"; null),
  entry("the same, ROBUST"; "closest hit"; "bounce"; "wide"; "MEDIUM ROBUST 1"; null),
  entry("any hit, shadow, single"; "any hit"; "shadow"; "wide"; "MEDIUM 1"; null),
  entry("balanced, MEDIUM"; "build"; null; "balanced"; "MEDIUM"; null),
  entry("fast, LOW"; "build"; null; "fast"; "LOW"; null),
  entry("best, HIGH"; "build"; null; "best"; "HIGH"; null)'

# The compact layout: bytes of trees, and rays beside those of other flavours.
table compact-layout.md "compact bytes" compact.jsonl '
  last.commit as $new | map(select(.commit == $new)) | . as $rows | "Commit \($new), \($rows[0].device).", "",
  (["scene", "compact", "wide", "making it of the wide tree, ms"] | line), "|---|---|---|---|",
  ("terrain", "atrium", "city", "random" | . as $scene | $rows | map(select(.task == "build" and .scene == $scene))[-1] |
   [$scene, (.compact_bytes_per_triangle | fixed(1)), (.bytes_per_triangle | fixed(1)), (.compact_ms | fixed(0))] | line)'
table compact-layout.md "compact rays" compact.jsonl '
  last.commit as $new | map(select(.commit == $new and .task == "closest hit" and .peer == "MEDIUM 1")) as $rows |
  def cell($scene; $rays; $ours): $rows | map(select(.scene == $scene and .rays == $rays and .ours == $ours))[-1] |
    "\(1000 / .cpu_time | fixed(2)) (\(.boxes_per_ray | fixed(0)) + \(.triangles_per_ray | fixed(0)))";
  (["scene, rays", "thread", "wide", "compact"] | line), "|---|---|---|---|",
  ("atrium", "terrain", "city", "random" | . as $scene | ("primary", "bounce") | . as $rays |
   ["\($scene), \($rays)", cell($scene; $rays; "thread"), cell($scene; $rays; "wide"), cell($scene; $rays; "compact")] | line)'

# The newest rows of whole pictures.
table ray-aware.md "whole pictures" render.jsonl '
  last.commit as $new | map(select(.commit == $new)) | . as $rows |
  def cell: "\(.median | fixed(3)) (\(.min | fixed(3))–\(.max | fixed(3)))";
  "Commit \($new), \($rows[0].device), one thread.", "",
  (["picture", "way", "whole", "building, planning, rays", "rays", "balanced: rays, shading, s"] | line), "|---|---|---|---|---|---|",
  ($rows[] | ["\(.scene) \(.triangles), \(.size)², \(.samples) samples", .way, (.whole_ratio | cell), (.rays_ratio | cell),
    (.trace_ratio | cell), "\(.balanced_trace_s.median | fixed(1)), \(.balanced_shade_s.median | fixed(1))"] | line)'

[ "$behind" = 0 ] || [ "$check" != --check ]
