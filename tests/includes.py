#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks which rooms include which: prints each include that a rule below forbids, and fails then.

    tests/includes.py [FOLDER]     FOLDER is the root of the sources; default: the one this lies in

Rules, on the quoted includes of all .h and .cpp files outside `tests` and `bench`:
  - engine/ includes nothing of server/, client/ or checker/.
  - A room of LAYERS includes of its component only itself and those before it: engine/base/ nothing
    else of engine/, client/base/ nothing else of client/.
  - server/ includes of engine/ only engine/engine.h and what it includes.
  - client/ includes nothing of server/ or engine/; of checker/ only what it judges files with.
  - checker/ includes nothing of the three.
"""
import pathlib
import re
import sys

LAYERS = {"engine": ["engine/base", "engine/domain", "engine/size", "engine/refine", "engine/output",
                     "engine/schedule"],
          "client": ["client/base", "client/formats", "client/geo", "client/call"],
          "server": ["server/store"]}
ENGINE_FACE = ["engine/engine.h"]
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def includes_of(root: pathlib.Path) -> dict[str, list[str]]:
    """The quoted includes of each source, by its path from the root."""
    found = {}
    for top in ("engine", "server", "client", "checker"):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                found[path.relative_to(root).as_posix()] = INCLUDE.findall(path.read_text())
    return found


def closure(includes: dict[str, list[str]], starts: list[str]) -> set[str]:
    reached, left = set(), list(starts)
    while left:
        path = left.pop()
        if path not in reached:
            reached.add(path)
            left += includes.get(path, [])
    return reached


def room(path: str) -> str:
    return "/".join(path.split("/")[:2]) if path.count("/") > 1 else path.split("/")[0]


def forbidden(source: str, target: str, face: set[str]) -> str | None:
    """Why `source` may not include `target`; None if it may."""
    top, target_top = source.split("/")[0], target.split("/")[0]
    if target_top not in ("engine", "server", "client", "checker"):
        return None
    allowed = {"engine": {"engine"}, "server": {"server", "engine"},
               "client": {"client", "checker"}, "checker": {"checker"}}[top]
    if target_top not in allowed:
        return f"{top}/ includes nothing of {target_top}/"
    if top == "server" and target_top == "engine" and target not in face:
        return "server/ includes of engine/ only its face"
    layers = LAYERS.get(top, [])
    if top == target_top and room(source) in layers:
        if room(target) not in layers[:layers.index(room(source)) + 1]:
            return f"{room(source)}/ lies below {room(target)}/"
    return None


def main() -> int:
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    includes = includes_of(root)
    face = closure(includes, ENGINE_FACE)
    faults = 0
    for source, targets in includes.items():
        for target in targets:
            if why := forbidden(source, target, face):
                faults += 1
                print(f"{source}: {target}: {why}")
    print(f"{len(includes)} sources, {faults} forbidden includes")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
