# SPDX-License-Identifier: Apache-2.0
"""Arcs from a file to a mesh that `weft check` has nothing against: a plate with round holes and a slot, whose
areas are known, and drawings that touch and cross."""
from __future__ import annotations

import json
import math
import os
import pathlib
import subprocess

import pytest

WEFT = os.environ["WEFT_BINARY"]


class Drawing:
    """A .poly file, built from lines and arcs."""

    def __init__(self) -> None:
        self.points: list[tuple[float, float]] = []
        self.segments: list[tuple[int, int, int]] = []
        self.bulges: dict[int, float] = {}
        self.holes: list[tuple[float, float]] = []

    def outline(self, corners: list[tuple[float, float, float]], marker: int) -> None:
        """Corners x, y and the bulge of the side that begins there."""
        first = len(self.points) + 1
        for i, (x, y, bulge) in enumerate(corners):
            self.points.append((x, y))
            self.segments.append((first + i, first + (i + 1) % len(corners), marker))
            if bulge:
                self.bulges[len(self.segments)] = bulge

    def circle(self, x: float, y: float, radius: float, marker: int, hole: bool = False) -> None:
        self.outline([(x + radius, y, 1), (x - radius, y, 1)], marker)
        if hole:
            self.holes.append((x, y))

    def write(self, path: pathlib.Path) -> pathlib.Path:
        lines = [f"{len(self.points)} 2 0 0"]
        lines += [f"{i + 1} {x!r} {y!r}" for i, (x, y) in enumerate(self.points)]
        lines += [f"{len(self.segments)} 1"]
        lines += [f"{i + 1} {a} {b} {marker}" for i, (a, b, marker) in enumerate(self.segments)]
        lines += [str(len(self.holes))] + [f"{i + 1} {x!r} {y!r}" for i, (x, y) in enumerate(self.holes)]
        lines += [f"# arc={segment}:{bulge!r}" for segment, bulge in self.bulges.items()]
        path.write_text("\n".join(lines) + "\n")
        return path


def mesh(domain: pathlib.Path, *flags: object) -> dict:
    """The report of a mesh that holds."""
    file = domain.with_suffix(".vtu")
    done = subprocess.run([WEFT, "mesh", domain, "-o", file, "--json", "--quiet", *map(str, flags)],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    checked = subprocess.run([WEFT, "check", file, "--domain", domain, *map(str, flags)],
                             capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout
    return json.loads(done.stdout)


def plate() -> Drawing:
    drawing = Drawing()
    drawing.outline([(0, 0, 0), (8, 0, 0), (8, 4, 0), (0, 4, 0)], 1)
    drawing.outline([(2, 1, 0), (4, 1, 1), (4, 3, 0), (2, 3, 1)], 2)  # a slot
    drawing.holes.append((3, 2))
    drawing.circle(6.5, 2, 0.75, 3, hole=True)
    return drawing


def test_the_area_comes_to_that_of_the_arcs(tmp_path):
    exact = 32 - (4 + math.pi) - math.pi * 0.75**2
    path = plate().write(tmp_path / "plate.poly")
    assert mesh(path)["triangles"] < 150
    off = [abs(mesh(path, "--edge", edge)["area"] - exact) for edge in (0.2, 0.1, 0.05)]
    assert off[0] < 0.03 and off[2] < off[0] / 12


@pytest.mark.parametrize("angle", [20, 30])
def test_circles_that_touch_and_cross_are_meshed(tmp_path, angle):
    drawing = Drawing()
    drawing.outline([(-4, -3, 0), (4, -3, 0), (4, 3, 0), (-4, 3, 0)], 1)
    drawing.circle(0, 0, 2, 2)
    drawing.circle(1, 0, 1, 3)  # touches from inside
    drawing.circle(-3, 0, 1, 4)  # and from outside, and the border
    drawing.circle(0, 1.5, 1, 5)  # crosses, and touches nothing
    mesh(drawing.write(tmp_path / "circles.poly"), "--min-angle", angle)


def test_sizes_at_markers_hold_on_arcs(tmp_path):
    report = mesh(plate().write(tmp_path / "plate.poly"), "--edge-at", "marker=3:0.05", "--gradation", "0.3")
    assert report["triangles"] > 1000


def test_what_cannot_be_is_refused(tmp_path):
    path = plate().write(tmp_path / "plate.poly")
    path.write_text(path.read_text() + "# arc=1:1e7\n")
    done = subprocess.run([WEFT, "mesh", path, "-o", tmp_path / "a.vtu"], capture_output=True, text=True)
    assert done.returncode != 0 and "the bulge is 10000000" in done.stderr
    done = subprocess.run([WEFT, "mesh", plate().write(path), "-o", tmp_path / "a.vtu", "--edge", "0.1",
                           "--simplify", "0.5"], capture_output=True, text=True)
    assert done.returncode != 0 and "has arcs" in done.stderr
    assert not (tmp_path / "a.vtu").exists()
