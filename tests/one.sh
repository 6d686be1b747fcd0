#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the program of one file of tests and runs the tests of that file.
#
#   tests/one.sh engine/size/raster [PRESET]     the tests of tests/engine/size/raster_test.cpp;
#                                                PRESET: release (the default), library, asan or tsan
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
(($# == 1 || $# == 2)) || {
  echo "usage: tests/one.sh engine/size/raster [release|library|asan|tsan]" >&2
  exit 2
}
file=${1#tests/}
file=tests/${file%_test.cpp}_test.cpp
preset=${2:-release}
[[ -f $file ]] || {
  echo "one.sh: there is no $file" >&2
  exit 2
}

[[ -f build/$preset/CMakeCache.txt ]] || cmake --preset "$preset"
program=$(python3 - "$file" <<'END'
import os, pathlib, re, sys
for lists in pathlib.Path("tests").rglob("CMakeLists.txt"):
    for program, sources in re.findall(r"add_executable\((\w+)([^)]*)\)", lists.read_text()):
        if any(os.path.normpath(lists.parent / source) == sys.argv[1] for source in sources.split()):
            print(program)
END
)
[[ $program ]] || {
  echo "one.sh: no program has $file" >&2
  exit 2
}
cmake --build --preset "$preset" --target "$program"

# Suites with parameters have a prefix and a suffix of their own.
filter=$(grep -oE '^ *(TYPED_)?TEST(_[FP])?\(\w+, *\w+' "$file" | sed -E 's/.*\((\w+), *(\w+)/\1.\2/' |
  awk '{ printf "%s:*/%s/*:", $0, $0 } END { if (!NR) print "*" }')
exec "build/$preset/$program" --gtest_brief=0 --gtest_filter="$filter"
