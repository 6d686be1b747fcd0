# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# What run.sh and deep.sh share: steps with their seconds and the cores that they used, and what is said
# of them at the end. Sourced in the root of the tree; the logs of steps go to $logs.

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

# Sets work to the seconds of processor time that what has ended so far took.
read_work() {
  times >"$logs/times"
  work=$(awk -F '[ms ]+' 'NR == 2 { print 60 * $1 + $2 + 60 * $3 + $4 }' "$logs/times")
}

# step NAME COMMAND...
step() {
  local name=$1 start=$EPOCHREALTIME outcome=ok status=0 hits asked hits_before asked_before
  local work work_before
  shift
  read_work
  work_before=$work
  read -r hits_before asked_before < <(cache_counts)
  printf '\n==> %s\n' "$name"
  "$@" </dev/null 2>&1 | tee "$logs/$name.log" || { status=$? outcome=FAILED broken+=("$name"); }
  read -r hits asked < <(cache_counts)
  ((asked > asked_before)) &&
    outcome+=", $((hits - hits_before)) of $((asked - asked_before)) units from the cache"
  read_work
  report+=("$(awk -v a="$start" -v b="$EPOCHREALTIME" -v before="$work_before" -v after="$work" \
    -v name="$name" -v outcome="$outcome" \
    'BEGIN { printf "%-34s %7.1f s  %3.1f cores  %s", name, b - a, (after - before) / (b - a), outcome }')")
  echo "==> ${report[-1]}"
  return $status
}

# needed NAME COMMAND...: a step without which the rest makes no sense
needed() {
  step "$@" || finish
}

# buf, and what judges manifests; pages of the documents run them.
install_linters() (
  cd deploy || exit
  [[ node_modules/.package-lock.json -nt package-lock.json ]] ||
    npm ci --ignore-scripts --no-audit --no-fund
)

# failed_tests LOG: of each test that failed, ctest's line and the last 30 that the test printed.
failed_tests() {
  awk '/^ *(Start +[0-9]+:|[0-9]+\/[0-9]+ Test +#)/ || /% tests passed/ {
         for (i = n > 30 ? n - 29 : 1; i <= n; ++i) print line[i]
         n = 0
         failed = /\*\*\*/
         if (failed) print
         next
       }
       failed { line[++n] = $0 }' "$1"
}

# Prints the table, ctest's closing lines, and what the steps that failed printed at their ends.
finish() {
  printf '\n--- steps ---\n'
  printf '%s\n' "${report[@]}"
  printf '%-34s %7.1f s\n' all "$SECONDS"
  local name log
  for log in "$logs"/tests*.log; do
    [[ -e $log ]] || continue
    printf '\n--- %s ---\n' "$(basename "$log" .log)"
    sed -n '/% tests passed/,$p' "$log"
  done
  for name in "${broken[@]}"; do
    printf '\n--- %s, which failed ---\n' "$name"
    if [[ $name == tests* ]] && grep -q '% tests passed' "$logs/$name.log"; then
      failed_tests "$logs/$name.log"
    else
      tail -n 60 "$logs/$name.log"
    fi
  done
  ((${#broken[@]} == 0))
  exit
}

# run_ctest PRESET ARGUMENT...: two tests more than cores at a time, because many wait for servers.
run_ctest() {
  local preset=$1
  shift
  ctest --preset "$preset" -j "$(($(nproc) + 2))" --no-tests=error --no-label-summary "$@"
}

# build PRESET ARGUMENT...: configures, and builds as `cmake --build` takes it
build() {
  local preset=$1
  shift
  cmake --preset "$preset" -DWEFT_WERROR=ON && cmake --build --preset "$preset" "$@"
}
