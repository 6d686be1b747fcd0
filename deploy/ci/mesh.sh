#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Meshes what a manifest lists, in a pipeline: `weft batch` where weft is installed, or else from a
# wheel, or else in a container. Leaves a report (JUnit XML) and a page with pictures (Markdown) for the pipeline to
# show, and fails if a mesh fails.
#
#   mesh.sh MANIFEST [FLAG OF weft batch]...
#   mesh.sh meshes.yaml --locked --require min-angle=20
#
# WEFT_REPORTS   folder of weft-junit.xml and weft-summary.md; default: weft-reports
# WEFT_SERVER    a server to use, with WEFT_TOKEN where it wants one; default: one that is started
# WEFT_WHEEL     if weft is not installed, the file of the wheel that carries it; needs python3
# WEFT_IMAGE     if there is no wheel either, an image of the Dockerfile's target `weft`, and docker or podman
set -euo pipefail

if (($# == 0)); then
  sed -n '3,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0" >&2
  exit 2
fi
reports=${WEFT_REPORTS:-weft-reports}
mkdir -p "$reports"

weft=(weft)
if command -v weft >/dev/null; then
  :
elif [[ -n ${WEFT_WHEEL-} ]]; then
  unpacked=$(mktemp -d)
  trap 'rm -rf "$unpacked"' EXIT
  python3 -m zipfile -e "$WEFT_WHEEL" "$unpacked"
  chmod +x "$unpacked"/weft/carried/bin/*
  weft=("$unpacked/weft/carried/bin/weft")
elif [[ -z ${WEFT_IMAGE-} ]]; then
  echo "mesh.sh: weft is not installed, and neither WEFT_WHEEL nor WEFT_IMAGE is set" >&2
  exit 127
else
  container=$(command -v docker || command -v podman) || {
    echo "mesh.sh: neither weft nor docker nor podman is installed" >&2
    exit 127
  }
  # As the user who runs the pipeline, on its files. The image weft has both programs: without
  # WEFT_SERVER, weft starts a server of its own inside.
  weft=("$container" run --rm --user "$(id -u):$(id -g)" --volume "$PWD:$PWD" --workdir "$PWD"
    --env WEFT_SERVER --env WEFT_TOKEN --entrypoint weft "$WEFT_IMAGE")
fi

status=0
"${weft[@]}" batch "$@" --junit "$reports/weft-junit.xml" --summary "$reports/weft-summary.md" ||
  status=$?
# GitHub shows this page with the run.
if [[ -n ${GITHUB_STEP_SUMMARY-} && -s $reports/weft-summary.md ]]; then
  cat "$reports/weft-summary.md" >>"$GITHUB_STEP_SUMMARY"
fi
exit $status
