#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Meshes what a manifest lists, in a pipeline: `weft batch` where weft is installed, or else in its
# container. Leaves a report (JUnit XML) and a page with pictures (Markdown) for the pipeline to
# show, and fails if a mesh fails.
#
#   mesh.sh MANIFEST [FLAG OF weft batch]...
#   mesh.sh meshes.yaml --locked --require min-angle=20
#
# WEFT_REPORTS   folder of weft-junit.xml and weft-summary.md; default: weft-reports
# WEFT_SERVER    a server to use, with WEFT_TOKEN where it wants one; default: one that is started
# WEFT_IMAGE     if weft is not installed, an image of the Dockerfile's target `weft`; default: weft
set -euo pipefail

if (($# == 0)); then
  sed -n '3,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0" >&2
  exit 2
fi
reports=${WEFT_REPORTS:-weft-reports}
mkdir -p "$reports"

weft=(weft)
if ! command -v weft >/dev/null; then
  container=$(command -v docker || command -v podman) || {
    echo "mesh.sh: neither weft nor docker nor podman is installed" >&2
    exit 127
  }
  # As the user who runs the pipeline, on its files. The image weft has both programs: without
  # WEFT_SERVER, weft starts a server of its own inside.
  weft=("$container" run --rm --user "$(id -u):$(id -g)" --volume "$PWD:$PWD" --workdir "$PWD"
    --env WEFT_SERVER --env WEFT_TOKEN --entrypoint weft "${WEFT_IMAGE:-weft}")
fi

status=0
"${weft[@]}" batch "$@" --junit "$reports/weft-junit.xml" --summary "$reports/weft-summary.md" ||
  status=$?
# GitHub shows this page with the run.
if [[ -n ${GITHUB_STEP_SUMMARY-} && -s $reports/weft-summary.md ]]; then
  cat "$reports/weft-summary.md" >>"$GITHUB_STEP_SUMMARY"
fi
exit $status
