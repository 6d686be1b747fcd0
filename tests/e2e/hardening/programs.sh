#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Reads programs and static libraries, and fails if one of them lacks a protection:
#   - a program is position independent, its relocations are bound and read-only before it runs, and
#     its stack is not executable;
#   - every function of a library that may be jumped to begins with endbr64, or bti on arm64, and unless it
#     is the engine, whose loops they slow down, it has canaries on its stacks;
#   - the libraries have checked copies, wherever they call functions of C that copy.
#
#   tests/e2e/hardening/programs.sh FILE...
set -euo pipefail
faults=0
copies=

# want FILE WHAT COMMAND...: `grep -q` on what readelf or nm prints
want() {
  local file=$1 what=$2
  shift 2
  "$@" && return
  echo "$file: $what"
  faults=$((faults + 1))
}
has() { grep -qE "$1" <<<"$2"; }
lacks() { ! has "$@"; }

for file in "$@"; do
  if [[ $file == *.a ]]; then
    symbols=$(nm "$file" 2>/dev/null)
    objects=$(readelf -h "$file" 2>/dev/null | grep -c '^ELF Header')
    marked=$(readelf -n "$file" 2>/dev/null | grep -cE 'x86 feature: IBT, SHSTK|AArch64 feature: BTI, PAC' || true)
    want "$file" "only $marked of its $objects objects are marked for CET, or BTI and PAC" [ "$marked" = "$objects" ]
    copies+=$symbols$'\n'
    [[ $file == *libweft_engine.a ]] && continue
    want "$file" "no stack has a canary" has ' U __stack_chk_fail$' "$symbols"
  else
    headers=$(readelf -hlWd "$file")
    want "$file" "not position independent" has 'Type: +DYN .*Position-Independent' "$headers"
    want "$file" "no read-only relocations" has 'GNU_RELRO' "$headers"
    want "$file" "relocations are bound while it runs" has 'FLAGS_1.*NOW' "$headers"
    want "$file" "its stack is executable" lacks 'GNU_STACK.*RWE' "$headers"
    want "$file" "the stack's rights are not stated" has 'GNU_STACK' "$headers"
  fi
done
want "all libraries" "no copy is checked" has ' U __[a-z]+_chk$' "$copies"
echo "$# files read, $faults protections missing"
exit $((faults != 0))
