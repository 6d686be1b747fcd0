# SPDX-License-Identifier: Apache-2.0
"""The storm surge of docs/tutorials, by one command from a raster that is made here: what the mesh
made of its size, against an evaluation by brute force."""
from __future__ import annotations

import json
import os
import pathlib
import subprocess
import sys
from collections.abc import Callable

import numpy as np
import pyproj

TESTS = pathlib.Path(__file__).parents[1]
sys.path.insert(0, str(TESTS / "support"))
import brute_force_size as brute_force  # noqa: E402

WEFT = os.environ["WEFT_BINARY"]
WEST, SOUTH, EAST, NORTH = -82, 24, -62, 46
OPEN, LAND = 1, 2
STEP = 0.125  # of the raster, in degrees
GROWTH = 0.15
EDGE = "min(clamp(2000 + 0.15*coast, 2000, 60000), 12.42*3600*sqrt(9.81*max(depth, 5))/100)"


def coast_rings() -> list[list[tuple[float, float, int]]]:
    """Longitude and latitude of each corner, and the marker of the segment to the next."""
    with open(TESTS / "models/us-east-coast.geojson") as file:
        rings = json.load(file)["geometry"]["coordinates"]
    sides = ((0, EAST), (1, SOUTH), (0, WEST), (1, NORTH))
    return [[(*a, OPEN if any(a[k] == b[k] == side for k, side in sides) else LAND)
             for a, b in zip(ring, ring[1:])] for ring in rings]


def depths() -> tuple[np.ndarray, tuple[float, float]]:
    """A shelf off a line from Florida to Nova Scotia, the deep sea beyond, and a ridge in it."""
    origin = (WEST - 4 * STEP, SOUTH - 4 * STEP)
    lon, lat = np.meshgrid(origin[0] + STEP * np.arange(169), origin[1] + STEP * np.arange(185))
    off = (lon + 79.5) - 0.9 * (lat - 26)
    deep = 12 + 4000 / (1 + np.exp(-(off - 1.5) / 0.4))
    return deep * (1 - 0.9 * np.exp(-((lon + 66) ** 2 + (lat - 30) ** 2) / 4)), origin


class Surge:
    """The mesh, in the metres of its projection, and the size that was asked for."""

    def __init__(self, folder: pathlib.Path, *flags: str):
        rings = coast_rings()
        with open(folder / "coast.csv", "w") as file:
            print("ring,x,y,marker", file=file)
            for number, ring in enumerate(rings):
                for corner in ring:
                    print(number, *corner, sep=",", file=file)
        self.depth, self.origin = depths()
        with open(folder / "depth.asc", "w") as file:
            rows, columns = self.depth.shape
            print(f"ncols {columns}", f"nrows {rows}", f"xllcenter {self.origin[0]}",
                  f"yllcenter {self.origin[1]}", f"cellsize {STEP}", sep="\n", file=file)
            np.savetxt(file, self.depth[::-1])
        done = subprocess.run(
            [WEFT, "mesh", "coast.csv", "-o", "surge.npz", "--to-metres", "--json", "--edge", EDGE,
             "--field", f"coast=distance:marker={LAND}", "--field", "depth=depth.asc", *flags],
            cwd=folder, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        self.projection = pyproj.Transformer.from_crs(
            "EPSG:4326", json.loads(done.stdout)["projection"]["name"], always_xy=True)
        with np.load(folder / "surge.npz") as arrays:
            self.points = arrays["points"][:, :2]
            self.corners = self.points[arrays["triangles"]]
        land = np.array([(*a[:2], *b[:2]) for ring in rings
                         for a, b in zip(ring, [*ring[1:], ring[0]]) if a[2] == LAND])
        self.a = np.array(self.projection.transform(*land[:, :2].T)).T
        self.b = np.array(self.projection.transform(*land[:, 2:].T)).T

    def by_coast(self, points: np.ndarray) -> np.ndarray:
        """The first argument of EDGE at points (n, 2) in metres. It grows by 0.15 at most."""
        return np.clip(2000 + 0.15 * brute_force.distance(points, self.a, self.b), 2000, 60000)

    def by_depth(self, points: np.ndarray) -> np.ndarray:
        """The second one."""
        lonlat = np.array(self.projection.transform(*points.T, direction="INVERSE")).T
        depth = brute_force.bilinear(lonlat, self.depth, self.origin, STEP)
        return 12.42 * 3600 * np.sqrt(9.81 * np.maximum(depth, 5)) / 100

    def size(self, points: np.ndarray) -> np.ndarray:
        return np.minimum(self.by_coast(points), self.by_depth(points))

    def limited_size(self, points: np.ndarray) -> np.ndarray:
        """The same if it may grow by GROWTH, from any vertex or middle of a triangle."""
        sources = np.concatenate([self.points, self.corners.mean(axis=1)])
        limit = brute_force.limited(points, sources, self.by_depth(sources), GROWTH)
        return np.minimum.reduce([self.by_coast(points), self.by_depth(points), limit])


def largest_over_size(surge: Surge, size: Callable[[np.ndarray], np.ndarray],
                      patches: list[np.ndarray]) -> list[float]:
    """Of each patch of the mesh, the largest triangle over the size: were the size too large there,
    a triangle would be above it, were it too small, all would be below."""
    centroids = surge.corners.mean(axis=1)
    rows = np.concatenate(patches)
    reached = brute_force.edges_allowed(surge.corners[rows]) / size(centroids[rows])
    return [part.max() for part in
            np.split(reached, np.cumsum([len(patch) for patch in patches])[:-1])]


def test_triangles_are_as_large_as_the_size_allows_everywhere(tmp_path: pathlib.Path):
    surge = Surge(tmp_path)
    assert len(surge.corners) > 50_000
    patches = brute_force.patches(surge.corners.mean(axis=1), 256)
    largest = largest_over_size(surge, surge.size, patches[::len(patches) // 100])
    least, most = np.percentile(largest, [1, 99])
    assert 0.9 < least < most < 1.05
    # The raster is sampled anew in the plane, which is the only thing that is not exact here.
    assert max(largest) < 1.02


def test_sizes_grow_as_slowly_as_the_gradation_says(tmp_path: pathlib.Path):
    surge = Surge(tmp_path, "--gradation", str(GROWTH))
    centroids = surge.corners.mean(axis=1)
    patches = brute_force.patches(centroids, 256)
    one_of_each = centroids[[patch[0] for patch in patches]]
    limited = surge.limited_size(one_of_each) / surge.size(one_of_each)
    lowered = [patch for patch, share in zip(patches, limited) if share < 0.9]
    assert len(lowered) >= 5
    largest = largest_over_size(surge, surge.limited_size, lowered)
    assert 0.95 < min(largest) < max(largest) < 1.01
