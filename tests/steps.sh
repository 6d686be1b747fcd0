# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# What run.sh and deep.sh share: steps with their seconds, and what is said of them at the end. Sourced
# in the root of the tree; the logs of steps go to $logs.

report=() # a line for each step
broken=() # the names of those that failed
rm -rf "${logs:?}"
mkdir -p "$logs"

export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=suppressions=$PWD/tests/tsan.supp
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0

# How often the compiler's cache had what was asked of it, and how often it was asked.
cache_counts() {
  ccache --print-stats 2>/dev/null |
    awk '/^(direct|preprocessed)_cache_hit/ { hits += $2 } /^cache_miss/ { misses += $2 }
         END { print hits + 0, hits + misses }'
}

# step NAME COMMAND...
step() {
  local name=$1 start=$EPOCHREALTIME outcome=ok status=0 hits asked hits_before asked_before
  shift
  read -r hits_before asked_before < <(cache_counts)
  printf '\n==> %s\n' "$name"
  "$@" </dev/null 2>&1 | tee "$logs/$name.log" || { status=$? outcome=FAILED broken+=("$name"); }
  read -r hits asked < <(cache_counts)
  ((asked > asked_before)) &&
    outcome+=", $((hits - hits_before)) of $((asked - asked_before)) units from the cache"
  report+=("$(awk -v a="$start" -v b="$EPOCHREALTIME" -v name="$name" -v outcome="$outcome" \
    'BEGIN { printf "%-34s %7.1f s  %s", name, b - a, outcome }')")
  echo "==> ${report[-1]}"
  return $status
}

# needed NAME COMMAND...: a step without which the rest makes no sense
needed() {
  step "$@" || finish
}

# Prints the table, the ends of the steps that failed, what failed in ctest and its closing lines.
finish() {
  printf '\n--- steps ---\n'
  printf '%s\n' "${report[@]}"
  printf '%-34s %7.1f s\n' all "$SECONDS"
  local name log
  for name in "${broken[@]}"; do
    printf '\n--- %s, which failed ---\n' "$name"
    grep -A 8 ': Failure$' "$logs/$name.log" | head -n 60
    tail -n 60 "$logs/$name.log"
  done
  for log in "$logs"/tests*.log; do
    [[ -e $log ]] || continue
    printf '\n--- %s ---\n' "$(basename "$log" .log)"
    sed -n '/% tests passed/,$p' "$log"
  done
  ((${#broken[@]} == 0))
  exit
}

# run_ctest PRESET ARGUMENT...
run_ctest() {
  local preset=$1
  shift
  ctest --preset "$preset" -j "$(nproc)" --no-tests=error --no-label-summary "$@"
}

# build PRESET ARGUMENT...: configures, and builds as `cmake --build` takes it
build() {
  local preset=$1
  shift
  cmake --preset "$preset" -DWEFT_WERROR=ON && cmake --build --preset "$preset" "$@"
}
