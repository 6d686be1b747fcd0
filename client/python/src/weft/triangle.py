# SPDX-License-Identifier: Apache-2.0
"""Triangle's program, with weft's meshes: `triangle-weft -pq30a0.1 box` or `python -m weft.triangle`.

    triangle-weft [-SWITCHES...] NAME

NAME is that of files, with or without one of the suffixes .poly (p), .node, .ele (r) and .area (ra), which
stand for the switches beside them. `box.poly` gives `box.1.node`, `box.1.ele` and `box.1.poly`. Exits with 1 if
there is no mesh, with 2 for switches that are wrong.
"""

from __future__ import annotations

import pathlib
import sys
from collections.abc import Sequence

from . import _triangle_files as files
from ._switches import parse
from ._triangulate import triangulate
from ._warning import keeping_warnings
from .errors import SwitchError, WeftError

_NAME = "triangle-weft"
_SUFFIXES = {".node": "", ".poly": "p", ".ele": "r", ".area": "ra"}


def main(arguments: Sequence[str] | None = None) -> int:
    """The exit code. `arguments`: those of this process if None."""
    words = sys.argv[1:] if arguments is None else list(arguments)
    opts = "".join(word[1:] for word in words if word.startswith("-"))
    names = [word for word in words if not word.startswith("-")]
    if "h" in opts or not words:
        print(__doc__)
        return 0 if words else 2
    try:
        if len(names) != 1:
            raise SwitchError("NAME", f"{len(names)} names of files, expected one")
        with keeping_warnings() as warned:
            _run(pathlib.Path(names[0]), opts)
    except SwitchError as error:
        print(f"{_NAME}: {error}", file=sys.stderr)
        return 2
    except (WeftError, OSError) as error:
        print(f"{_NAME}: {error}", file=sys.stderr)
        return 1
    for sentence in warned:
        print(f"{_NAME}: WARNING: {sentence}", file=sys.stderr)
    return 0


def _run(base: pathlib.Path, opts: str) -> None:
    if base.suffix in _SUFFIXES:
        opts += _SUFFIXES[base.suffix]
        base = base.with_suffix("")
    switches = parse(opts)
    if switches.refine and switches.no_iteration:
        raise SwitchError("I", "the mesh that r refines would be written over")
    given, first = files.read(base, switches)
    mesh = triangulate(given, opts)
    written = files.write(base if switches.no_iteration else files.next_base(base), mesh, switches, first,
                          given=files.beside(base, ".node").exists())
    if not switches.quiet:
        for path in written:
            print(f"Writing {path}.")
        print(f"Mesh vertices: {len(mesh['vertices'])}\nMesh triangles: {len(mesh['triangles'])}")


if __name__ == "__main__":
    sys.exit(main())
