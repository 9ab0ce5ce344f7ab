#!/usr/bin/env bash
# Installs a build to a folder of its own and uses it as a stranger would: through CMake, through pkg-config, and each
# header alone. The README shows the first of the programs and links the others.
#   check.sh BUILD_FOLDER CXX_COMPILER
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$1
compiler=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

cmake --install "$build" --prefix "$scratch/installed" >"$scratch/log"
# Moved afterwards: nothing in it may depend on where it was installed.
mv "$scratch/installed" "$scratch/moved"
prefix=$scratch/moved
"$prefix/bin/gnomon" --version
[ -s "$prefix/share/bash-completion/completions/gnomon" ]
! command -v help2man >/dev/null || [ -s "$prefix/share/man/man1/gnomon-build.1" ]

echo "== through CMake"
cmake -S "$here" -B "$scratch/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_PREFIX_PATH="$prefix" >"$scratch/log" || { cat "$scratch/log"; exit 1; }
cmake --build "$scratch/build" >"$scratch/log" || { cat "$scratch/log"; exit 1; }
cd "$scratch"  # keep_tree leaves its trees where it runs
for program in main areas own_buffers million_rays own_heuristic keep_tree read_bvh2; do
  echo "-- $program"
  "build/$program"
done

echo "== through pkg-config"
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name gnomon.pc)")
export PKG_CONFIG_PATH
read -ra compile_flags <<<"$(pkg-config --cflags gnomon)"
read -ra link_flags <<<"$(pkg-config --libs gnomon)"
for program in main areas; do
  "$compiler" -std=c++20 "${compile_flags[@]}" "$here/$program.cpp" "${link_flags[@]}" -o "$scratch/$program"
  "$scratch/$program"
done

echo "== every header, and alone where no source of ours begins with it, with a user's strict warnings"
cd "$prefix/include"
accepts() { "$compiler" -std=c++20 -fsyntax-only -Wall -Wextra -Werror "${compile_flags[@]}" -x c++ -; }
find gnomon -name '*.h' | sort >"$scratch/headers"
sed 's/.*/#include "&"/' "$scratch/headers" | accepts
while read -r header; do
  source=$here/../../host/${header#gnomon/}
  source=${source%.h}.cpp
  [ -f "$source" ] && [ "$(grep -m1 '^#include' "$source")" = "#include \"$header\"" ] || accepts <<<"#include \"$header\""
done <"$scratch/headers"
wc -l <"$scratch/headers"

echo "== the README shows this program"
sed -n '/<!-- example begin -->/,/<!-- example end -->/p' "$here/../../README.md" | sed '/^<!--/d; /^```/d; /^$/d' >"$scratch/shown"
sed '/^$/d' "$here/main.cpp" | diff - "$scratch/shown"
