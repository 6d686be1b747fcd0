#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The two licences stay apart (see LICENSE): every source names the licence of its folder in its
# first lines, and weft, which is Apache-2.0, neither links nor includes anything under the GPL.
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
    tests/client/* | tests/checker/* | tests/python/*) licence=Apache-2.0 ;;
    engine/* | server/* | bench/* | tests/*) licence=GPL-3.0-or-later ;;
    *) licence=Apache-2.0 ;;
  esac
  head -n 3 "$file" | grep -qE "SPDX-License-Identifier: $licence\$" ||
    complain "$file: its first lines do not say SPDX-License-Identifier: $licence"
done < <(git ls-files --cached --others --exclude-standard -- \
  '*.h' '*.cpp' '*.proto' '*.sh' '*.py' .ci/run)

# Everything that weft is linked from, then every header that its objects were compiled with.
inputs=$(ninja -C $build -t inputs weft | sed "s|^$PWD/||")
grep -qx 'client/.*\.cpp' <<<"$inputs" || complain "ninja does not tell what weft is built from"
mapfile -t objects < <(grep '\.o$' <<<"$inputs")
headers=$(ninja -C $build -t deps "${objects[@]}" | sed -n 's|^    ||p' | sed "s|^$PWD/||")
grep -q '/CLI/' <<<"$headers" || complain "ninja does not tell which headers weft was compiled with"
while read -r file; do
  complain "weft depends on $file, which is under the GPL"
done < <(printf '%s\n' "$inputs" "$headers" | grep -E '^(engine|server|bench)/|/CGAL/|CGAL' | sort -u)

exit $wrong
