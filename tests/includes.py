#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks which rooms include which: prints each include that a rule below forbids, and fails then.

    tests/includes.py [FOLDER]     FOLDER is the root of the sources; default: the one this lies in

Rules, on the quoted includes, and those of TBB, of all .h and .cpp files outside `tests`, `bench` and `examples`:
  - include/weft/, the library's face, is FACE, and includes nothing else.
  - engine/ includes nothing of server/, client/ or checker/; wire/ and files/ engine/c/ alone does.
  - wire/ includes the face and itself alone; BY_MESSAGES, which client/ sees, too, also files/.
  - A room includes of its component only itself and those before it in LAYERS: engine/base/ nothing else
    of engine/. A name with .* is that of files of the component's own folder, which are rooms of their own.
    Every source of the five is in a room.
  - server/ includes nothing of engine/: it sees the library's face alone. Of files/ it sees all.
  - files/ includes of the others loader/ and, for what it judges domains with, checker/.
  - client/ includes nothing of server/, engine/ or the face; of checker/ only what it judges files with.
  - checker/ includes nothing of the five.
  - loader/ includes nothing of the others; server/, files/ and client/ include it.
  - TBB is included by engine/base/arena.cpp alone.
And no two headers define a class or an enumeration of one name in one namespace: a program that has both
would take one's constructors for the other's, and no linker says so.
"""
import pathlib
import re
import sys

LAYERS = {
    "engine": ["base", "domain", "size", "refine", "parallel", "emit", "layers", "leaf_run.*", "mesh_run.*",
               "refinement.*", "gradation_mesh.*", "engine.*", "estimate.*", "options.*", "run.*", "weft.*", "c"],
    "server": ["version.*", "stop_events.*", "store", "wire", "run", "observe", "net", "admission",
               "services", "front", "callbacks", "console", "http", "jobs", "mesh", "server_options.*", "server_info.*",
               "server.*", "options.*", "main.*"],
    "files": ["base", "bytes", "formats", "geo", "lint", "message"],
    "client": ["base", "call", "drawing", "report", "batch", "lint", "commands", "cli", "main.*"],
    "checker": ["domain.*", "mesh.*", "text.*", "report.*", "geometry", "edges", "domain", "size", "mesh",
                "check.*", "models", "lint"]}
FACE = {f"weft/{name}.h" for name in ("c", "error", "geometry", "mesh", "pslg", "run", "size", "weft")}
BY_MESSAGES = tuple(f"wire/{name}.h" for name in ("chunk_view", "domain_field", "marker_options", "named_options"))
KNOWS_TBB = "engine/base/arena.cpp"
TYPE = re.compile(r"^namespace ([\w:]+) \{$|^(?:class|struct|enum class|enum) (\w+)[^;(]*\{", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s+(?:"([^"]+)"|<(tbb/[^>]+)>)', re.MULTILINE)


def includes_of(root: pathlib.Path) -> dict[str, list[str]]:
    """The quoted includes of each source, and those of TBB, by its path from the root, or from include/."""
    found = {}
    for top in ("include", "engine", "server", "client", "checker", "files", "loader", "wire"):
        base = root / top if top == "include" else root
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                found[path.relative_to(base).as_posix()] = [
                    quoted or tbb for quoted, tbb in INCLUDE.findall(path.read_text())]
    return found


def room(path: str) -> str:
    """As in LAYERS."""
    parts = path.split("/")
    return parts[1] if len(parts) > 2 else parts[1].split(".")[0] + ".*"


def forbidden(source: str, target: str) -> str | None:
    """Why `source` may not include `target`; None if it may."""
    top, target_top = source.split("/")[0], target.split("/")[0]
    if target_top == "tbb":
        return None if source == KNOWS_TBB else f"only {KNOWS_TBB} includes TBB"
    if top == "weft":
        return None if target in FACE else "the library's face includes nothing else"
    if target in FACE:
        return None if top in ("engine", "server", "wire") else f"{top}/ includes nothing of the library"
    if target_top not in ("engine", "server", "client", "checker", "files", "loader", "wire"):
        return None
    if target_top in ("wire", "files") and (top, room(source)) == ("engine", "c"):
        return None
    if top == "client" and target in BY_MESSAGES:
        return None
    if target_top == "files" and source.replace(".cpp", ".h") in BY_MESSAGES:
        return None
    allowed = {"engine": {"engine"}, "server": {"server", "files", "loader", "wire"}, "wire": {"wire"},
               "client": {"client", "files", "checker", "loader"},
               "files": {"files", "checker", "loader"}, "checker": {"checker"}, "loader": {"loader"}}[top]
    if target_top not in allowed:
        return f"{top}/ includes nothing of {target_top}/"
    if top == target_top and top in LAYERS:
        layers = LAYERS[top]
        below, above = room(source), room(target)
        if {below, above} <= set(layers) and layers.index(above) > layers.index(below):
            return f"{top}/{below} lies below {top}/{above}"
    return None


def defined_twice(root: pathlib.Path, sources: list[str]) -> list[str]:
    """The types that two headers define, such as `weft::Failure: a.h, b.h`."""
    headers: dict[str, set[str]] = {}
    for source in sources:
        if not source.endswith(".h"):
            continue
        path = root / ("include" if source.startswith("weft/") else "") / source
        namespace = ""
        for opened, name in TYPE.findall(path.read_text()):
            namespace = opened or namespace
            if name:
                headers.setdefault(f"{namespace}::{name}", set()).add(source)
    return [f"{name}: {', '.join(sorted(found))}" for name, found in headers.items() if len(found) > 1]


def main() -> int:
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    includes = includes_of(root)
    faults = 0
    for unknown in sorted({path for path in includes if path.startswith("weft/")} - FACE):
        faults += 1
        print(f"include/{unknown}: is not of the face")
    for source in includes:
        if (top := source.split("/")[0]) in LAYERS and room(source) not in LAYERS[top]:
            faults += 1
            print(f"{source}: {room(source)} is no room of {top}/")
    for source, targets in includes.items():
        for target in targets:
            if why := forbidden(source, target):
                faults += 1
                print(f"{source}: {target}: {why}")
    for twice in defined_twice(root, list(includes)):
        faults += 1
        print(f"{twice}: one name for two types")
    print(f"{len(includes)} sources, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
