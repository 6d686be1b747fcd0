# SPDX-License-Identifier: Apache-2.0
"""Polygons as people have them, overlapping and rounded, against what shapely makes of them: a town whose
buildings overlap here and there, and a mosaic whose tiles meet at T-junctions."""
from __future__ import annotations

import json
import os
import pathlib
import subprocess

import numpy as np
import shapely.affinity
import shapely.geometry
import shapely.ops

WEFT = os.environ["WEFT_BINARY"]


def geojson(path: pathlib.Path, polygons: list, properties: list[dict]) -> pathlib.Path:
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": given, "geometry": shapely.geometry.mapping(polygon)}
        for polygon, given in zip(polygons, properties)]}))
    return path


def mesh(domain: pathlib.Path, *flags: object) -> tuple[dict, dict[int, float]]:
    """The report, and the area of each region."""
    file = domain.with_suffix(".npz")
    done = subprocess.run([WEFT, "mesh", domain, "-o", file, "--json", "--quiet", *map(str, flags)],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    checked = subprocess.run([WEFT, "check", file, "--domain", domain, *map(str, flags)],
                             capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout
    with np.load(file) as arrays:
        a, b, c = np.moveaxis(arrays["points"][:, :2][arrays["triangles"]], 1, 0)
        regions = arrays["regions"]
    areas = ((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])) / 2
    return json.loads(done.stdout), {int(r): float(areas[regions == r].sum()) for r in np.unique(regions)}


def rounded(polygon):
    return shapely.geometry.Polygon(np.round(polygon.exterior.coords, 7))


def test_a_town_of_buildings_that_overlap_has_the_area_of_their_union(tmp_path):
    random = np.random.default_rng(5)
    buildings = []
    for at in random.uniform(0, 1200, (2000, 2)):
        w, h = random.uniform(8, 60, 2)
        box = shapely.affinity.rotate(shapely.geometry.box(*at, *(at + (w, h))), random.uniform(0, 90))
        buildings.append(rounded(box))
    town = geojson(tmp_path / "town.geojson", buildings, [{"region": 1}] * len(buildings))
    report, regions = mesh(town)
    union = shapely.ops.unary_union(buildings).area
    assert abs(report["area"] - union) <= 1e-9 * union
    assert set(regions) == {1}
    assert report["overlap"]["united"] and report["overlap"]["areas"] > 1000
    shared = sum(building.area for building in buildings) - union
    assert 0 < report["overlap"]["area"] <= shared


def tiles(random: np.random.Generator, box: tuple[float, ...], count: int) -> list[tuple[float, ...]]:
    """A rectangle, cut in two again and again, so that corners lie on the sides of others."""
    if count == 1:
        return [box]
    x0, y0, x1, y1 = box
    first = count // 2
    part = np.clip(first / count + random.uniform(-0.1, 0.1), 0.2, 0.8)
    if x1 - x0 > y1 - y0:
        x = x0 + part * (x1 - x0)
        halves = (x0, y0, x, y1), (x, y0, x1, y1)
    else:
        y = y0 + part * (y1 - y0)
        halves = (x0, y0, x1, y), (x0, y, x1, y1)
    return tiles(random, halves[0], first) + tiles(random, halves[1], count - first)


def test_a_mosaic_of_grains_has_each_grain_as_a_region(tmp_path):
    random = np.random.default_rng(7)
    grains = [rounded(shapely.affinity.rotate(shapely.geometry.box(*tile), 0.3, origin=(0, 0), use_radians=True))
              for tile in tiles(random, (0.0, 0.0, 1000.0, 1000.0), 2000)]
    mosaic = geojson(tmp_path / "mosaic.geojson", grains, [{"region": i + 1} for i in range(len(grains))])
    # Corners are up to 1e-7 off the sides that they lie on.
    report, regions = mesh(mosaic, "--snap", 1e-6)
    assert abs(report["area"] - 1e6) <= 1e-9 * 1e6
    assert set(regions) == set(range(1, len(grains) + 1))
    for i, grain in enumerate(grains):
        assert abs(regions[i + 1] - grain.area) <= 1e-6 * grain.length
