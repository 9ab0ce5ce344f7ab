#!/usr/bin/env bash
# Every subcommand and every option that --help shows is in the completion and, where pages are made, on its page.
#   manual.sh GNOMON FOLDER WITH_PAGES      FOLDER: of host/app/manual.sh; WITH_PAGES: 1 or 0
set -euo pipefail
gnomon=$1
folder=$2
with_pages=$3
# shellcheck source=/dev/null
source "$folder/completions/gnomon"

faults=0
checked=0
fault() {
  echo "FAULT: $*"
  faults=$((faults + 1))
}
# What the shell offers after these words.
offered() {
  COMP_WORDS=(gnomon "$@")
  COMP_CWORD=$#
  COMPREPLY=()
  _gnomon
  printf '%s\n' "${COMPREPLY[@]}"
}
commands_of() { "$gnomon" "$@" --help | sed -n '/^Subcommands:/,/^$/p' | sed -n 's/^  \([a-z]\+\) .*/\1/p'; }
options_of() { "$gnomon" "$@" --help | grep -oE '^ +(-[a-zA-Z], *)?--[a-z-]+' | grep -oE -e '--[a-z-]+$'; }

# check [SUBCOMMAND...]
check() {
  local name words option page
  name=$(IFS=-; echo "gnomon${*:+-}$*")
  words=$(offered "$@" "")
  if [ "$with_pages" = 1 ]; then
    [ -s "$folder/man1/$name.1" ] || fault "no page $name.1"
    page=$(sed 's/\\-/-/g; s/\\fB//g; s/\\fR//g' "$folder/man1/$name.1")
    grep -qF "$name - " <<<"$page" || fault "$name.1 has no name"
  fi
  for option in $(options_of "$@"); do
    checked=$((checked + 1))
    grep -qxF -e "$option" <<<"$words" || fault "completion of '$*' does not offer $option"
    [ "$with_pages" = 0 ] || grep -qE -e "(^|, *)$option( |\$)" <<<"$page" || fault "$name.1 lacks $option"
  done
}

check
commands=$(commands_of)
for command in $commands; do
  checked=$((checked + 1))
  grep -qxF "$command" <<<"$(offered "")" || fault "completion does not offer $command"
  check "$command"
done
for command in diff check; do
  grep -qxF "$command" <<<"$(offered rows "")" || fault "completion does not offer rows $command"
  check rows "$command"
done
[ "$(offered build --builder "" | tr '\n' ' ')" = "balanced fast best " ] || fault "values of --builder"
[ "$(offered build model.glb --builder f)" = fast ] || fault "--builder f"
[ -z "$(offered build -o "")" ] || fault "-o takes a file, not a word of ours"
[ "$(offered trace --rays sha)" = shadow ] || fault "--rays sha"
[ "$(offered bu)" = build ] || fault "bu"

echo "$checked subcommands and options, $faults faults"
[ "$faults" = 0 ] && [ "$checked" -gt 150 ]
