#!/usr/bin/env bash
# exit_rule_bench on one set-up: local trees with the exit rule answer as the global tree alone, in every form of the area,
# rows say of what they are, and arguments that cannot be are refused by name.
#   exit_rule.sh EXIT_RULE_BENCH
set -euo pipefail
bench=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cat >"$scratch/set-up.json" <<'EOF'
{"configs": [{"scene": "Random100", "area": "plane", "orientation": "parallel", "kind": "plane", "point": [5, 5, -4],
  "normal": [0, 0, 1], "half_width": 5, "half_height": 5, "forward_size": 20,
  "used_by_variants": ["Standard", "Full", "Facing", "Longest"]}]}
EOF
faults=0
fault() {
  echo "FAULT: $*"
  faults=$((faults + 1))
}
# refused STATUS WORD ARGUMENTS...
refused() {
  local expected=$1 word=$2 status=0
  shift 2
  "$bench" "$@" >"$scratch/out" 2>"$scratch/err" || status=$?
  [ "$status" = "$expected" ] || fault "'$*' exits $status, not $expected"
  grep -qF -- "$word" "$scratch/err" || fault "'$*' is refused without '$word': $(cat "$scratch/err")"
  [ ! -s "$scratch/out" ] || fault "'$*' is refused, and yet there are rows"
}
refused 2 "exit_rule_bench CONFIGS.json SCENES [RAYS]"
refused 2 "exit_rule_bench CONFIGS.json SCENES [RAYS]" "$scratch/set-up.json"
refused 1 "$scratch/none.json" "$scratch/none.json" "$scratch"
for count in many 0 -3 12x; do refused 1 "RAYS \"$count\"" "$scratch/set-up.json" "$scratch" "$count"; done

"$bench" "$scratch/set-up.json" "$scratch" >"$scratch/rows"
# 4000 rays of the area, of a camera, and at random; the published rule loses two of them here.
jq -se 'map(.form) == ["as published", "half size", "far end at median depth"]
  and all(.bench == "exit_rule" and .triangles == 100 and .rays == 12000
    and .exit_rule.wrong_closest == 0 and .exit_rule.wrong_any == 0 and .exit_rule.local_triangles > 0)
  and any(.published_rule.wrong_closest > 0)' "$scratch/rows" >/dev/null || fault "rows: $(cat "$scratch/rows")"
echo "$faults faults"
[ "$faults" = 0 ]
