# SPDX-License-Identifier: Apache-2.0
"""Triangle's command-line switches (https://www.cs.cmu.edu/~quake/triangle.switch.html): one letter each,
some followed by a number. Unlike Triangle, which skips what it does not know, an unknown or malformed
switch is an error."""

from __future__ import annotations

import dataclasses
import re

from .errors import SwitchError

MOST_ANGLE = 36.0  # degrees; of Quality.min_angle_deg

_FLAGS = {
    "p": "poly", "r": "refine", "A": "attributes", "c": "convex", "e": "edges", "n": "neighbors",
    "j": "jettison", "Y": "keep_segments", "B": "no_markers",
    "O": "no_holes", "z": "from_zero", "P": "no_poly", "N": "no_node", "E": "no_ele",
    "I": "no_iteration", "Q": "quiet",
}
# What cannot change the mesh: arithmetic is exact, the algorithm is weft's, each mesh is checked.
_WITHOUT_EFFECT = "XVCiFl"
_REFUSED = {
    "D": "triangulations are constrained Delaunay, not conforming Delaunay",
    "L": "triangulations are constrained Delaunay, not conforming Delaunay",
    "s": "segments are constrained, not forced by splitting",
    "u": "there is no test of one's own; a region's maximum area, or weft.Client.mesh with a size, "
         "grades the mesh",
    "v": "no Voronoi diagram is made; weft writes Voronoi cells as .disv",
    "w": "weighted Delaunay triangulations are not made",
    "W": "weighted Delaunay triangulations are not made",
    "g": "no .off file is written; weft writes .off",
}
# An exponent needs a digit, so that the e of "a0.1e" stays the switch.
_NUMBER = re.compile(r"(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_COUNT = re.compile(r"\d*", re.ASCII)


@dataclasses.dataclass(frozen=True)
class Switches:
    """What the letters say; see Triangle's documentation for each."""

    poly: bool = False
    refine: bool = False
    min_angle: float | None = None
    """Degrees; None without q."""
    max_area: float | None = None
    """None without a number after a."""
    own_areas: bool = False
    """a without a number: the areas of regions, or of triangles that are refined."""
    attributes: bool = False
    convex: bool = False
    edges: bool = False
    neighbors: bool = False
    jettison: bool = False
    second_order: bool = False
    keep_segments: bool = False
    most_steiner: int | None = None
    """None without S."""
    no_markers: bool = False
    no_holes: bool = False
    from_zero: bool = False
    no_poly: bool = False
    no_node: bool = False
    no_ele: bool = False
    no_iteration: bool = False
    quiet: bool = False

    @property
    def bounded(self) -> bool:
        """Whether points are added for the sake of the triangles."""
        return self.min_angle is not None or self.max_area is not None or self.own_areas


def parse(text: str) -> Switches:
    """Of a text such as "pq30a0.1" or "-pqa". Raises SwitchError, which names the switch."""
    found: dict[str, bool | float | int] = {}
    at = 0
    while at < len(text):
        letter = text[at]
        at += 1
        if letter in _FLAGS:
            found[_FLAGS[letter]] = True
        elif letter in "qa":
            number = _NUMBER.match(text, at)
            if number:
                at = number.end()
                _take_bound(found, letter, number[0])
            elif letter == "q":
                found["min_angle"] = 20.0
            else:
                found["own_areas"] = True
        elif letter == "S":
            count = _COUNT.match(text, at)
            assert count
            at = count.end()
            found["most_steiner"] = int(count[0] or 0)
        elif letter == "o":
            if text[at:at + 1] != "2":
                raise SwitchError("o", "the order after o is 2, or there is no o")
            at += 1
            found["second_order"] = True
        elif letter in _REFUSED:
            raise SwitchError(letter, _REFUSED[letter])
        elif letter not in _WITHOUT_EFFECT and (letter != "-" or at > 1):
            raise SwitchError(letter, f"unknown, number {at} of {text!r}")
    switches = Switches(**found)  # type: ignore[arg-type]
    _check(switches)
    return switches


def _take_bound(found: dict[str, bool | float | int], letter: str, number: str) -> None:
    value = float(number)
    if letter == "q":
        if value > MOST_ANGLE:
            raise SwitchError("q" + number, f"the minimum angle is from 0 to {MOST_ANGLE:g} degrees")
        found["min_angle"] = value
    else:
        if not 0 < value < float("inf"):
            raise SwitchError("a" + number, "the maximum area is above 0, and finite")
        found["max_area"] = value


def _check(switches: Switches) -> None:
    if switches.refine and switches.convex:
        raise SwitchError("c", "a mesh that r refines keeps its boundary")
