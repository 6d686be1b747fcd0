#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The licences stay what LICENSE says: every source names the licence of its folder in its first
# lines; weftd and weft, which are Apache-2.0, include no header of CGAL that is under the GPL, by
# the header's own SPDX line, and are made of nothing in bench/; weft, and so every client, includes
# and links nothing of the engine or CGAL at all.
#
#   tests/licences.sh     after the release build
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/release
wrong=0

complain() {
  echo "$1" >&2
  wrong=1
}

while read -r file; do
  case $file in
    bench/* | tests/bench/*) licence=GPL-3.0-or-later ;;
    *) licence=Apache-2.0 ;;
  esac
  head -n 3 "$file" | grep -qE "SPDX-License-Identifier: $licence( \*/| -->)?\$" ||
    complain "$file: its first lines do not say SPDX-License-Identifier: $licence"
done < <(git ls-files --cached --others --exclude-standard -- \
  '*.h' '*.cpp' '*.proto' '*.sh' '*.py' '*.mjs' '*.go' '*CMakeLists.txt' .ci/run \
  'console/*.ts' 'console/*.tsx' 'console/*.js' 'console/*.css' 'console/*.html' 'tests/console/*.js')

# Everything that a program is linked from, then every header that its objects were compiled with.
parts_of() {
  local inputs objects headers
  inputs=$(ninja -C $build -t inputs "$1" | sed "s|^$PWD/||")
  grep -qx "$2/.*\.cpp" <<<"$inputs" || {
    echo "ninja does not tell what $1 is built from" >&2
    return 1
  }
  mapfile -t objects < <(grep '\.o$' <<<"$inputs")
  headers=$(ninja -C $build -t deps "${objects[@]}" | sed -n 's|^    ||p' | sed "s|^$PWD/||")
  grep -q "$3" <<<"$headers" || {
    echo "ninja does not tell which headers $1 was compiled with" >&2
    return 1
  }
  printf '%s\n' "$inputs" "$headers" | sort -u
}
of_weft=$(parts_of weft client /CLI/)
of_weftd=$(parts_of weftd server /CGAL/)

while read -r file; do
  complain "weft depends on $file"
done < <(grep -E '^(engine|server|bench)/|CGAL' <<<"$of_weft")

while read -r file; do
  complain "weftd depends on $file, which is under the GPL"
done < <(grep -E '^bench/' <<<"$of_weftd")

while read -r file; do
  line=$(grep -m 1 SPDX-License-Identifier: "$file" || true)
  case $line in
    *LGPL-3.0-or-later* | *BSL-1.0*) ;;
    *) complain "weftd includes $file, which says ${line:-nothing of its licence}" ;;
  esac
done < <(grep '/CGAL/' <<<"$of_weftd")

exit $wrong
