#!/usr/bin/env bash
# Makes the manual, a page for the program and one for each subcommand, and the bash completion, from what the program
# says of itself.
#   manual.sh GNOMON VERSION FOLDER     to FOLDER/man1/*.1 where help2man is installed, and FOLDER/completions/gnomon
set -euo pipefail
gnomon=$1
version=$2
out=$3
mkdir -p "$out/completions" "$out/man1"
"$gnomon" completion bash >"$out/completions/gnomon"
command -v help2man >/dev/null || exit 0

# page NAME WHAT [SUBCOMMAND...]
page() {
  local name=$1 what=$2
  shift 2
  # Indented blocks, which are examples, stand line by line.
  help2man --no-info --no-discard-stderr --version-string="gnomon $version" --name="$what" "$gnomon $*" |
    sed "s/^\.TH GNOMON /.TH ${name^^} /; s/^gnomon \\\\- /$name \\\\- /" |
    sed 's/^\.IP$/.IP\n.nf/; s/^\.\(PP\|SH\|SS\)/.fi\n&/' >"$out/man1/$name.1"
}
page gnomon "bounding volume hierarchies for the rays a scene will see, on any OpenCL device"
while IFS=$'\t' read -r words what; do
  read -ra words <<<"$words"
  name=gnomon
  for word in "${words[@]}"; do name+=-$word; done
  page "$name" "$what" "${words[@]}"
done < <("$gnomon" completion commands)
