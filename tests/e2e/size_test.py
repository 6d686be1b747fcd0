# SPDX-License-Identifier: Apache-2.0
"""`weft size`: what a size asks for, before there is a mesh."""
from __future__ import annotations

import json
import os
import pathlib
import re
import subprocess

import pytest

MODELS = pathlib.Path(__file__).parents[1] / "models"
WEFT = os.environ["WEFT_BINARY"]
KEY = MODELS / "key.poly"
COAST = MODELS / "us-east-coast.geojson"


def weft(folder: pathlib.Path, *words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([WEFT, *map(str, words)], capture_output=True, text=True, cwd=folder)


def told(folder: pathlib.Path, *words: object) -> dict:
    ended = weft(folder, "size", *words, "--json")
    assert ended.returncode == 0, ended.stderr
    return json.loads(ended.stdout)


def test_it_tells_the_lengths_and_the_triangles_of_the_mesh(tmp_path: pathlib.Path) -> None:
    bounds = ["--edge", "0.5 + 0.05*x"]
    size = told(tmp_path, KEY, *bounds, "-o", "edges.asc", "--cells", 64)
    mesh = json.loads(weft(tmp_path, "mesh", KEY, *bounds, "-o", "key.vtu", "--json").stdout)
    assert 0.75 < size["expected_triangles"] / mesh["triangles"] < 1.25
    assert 0.5 < size["least_edge"] < size["median_edge"] < size["largest_edge"] < 5

    header, values = {}, []
    for line in (tmp_path / "edges.asc").read_text().splitlines():
        if line[0].isalpha():
            header[line.split()[0]] = float(line.split()[1])
        else:
            values.append([float(value) for value in line.split()])
    assert (len(values[0]), len(values)) == (64, header["nrows"])
    xs = [header["xllcenter"] + column * header["cellsize"] for column in range(64)]
    inside = 0
    for row in values:
        for x, value in zip(xs, row):
            assert value == -9999 or value == pytest.approx(0.5 + 0.05 * x, rel=1e-12)
            inside += value != -9999
    assert inside == size["cells"]
    assert inside * header["cellsize"] ** 2 == pytest.approx(mesh["area"], rel=0.05)


def test_degrees_are_asked_for_in_metres(tmp_path: pathlib.Path) -> None:
    size = told(tmp_path, COAST, "--lonlat", "--edge", 20_000)
    assert size["least_edge"] == pytest.approx(20_000)
    assert "tmerc" in size["projection"]["name"]


def test_the_text_says_it_in_a_line(tmp_path: pathlib.Path) -> None:
    assert re.fullmatch(r"edges of 0\.5; about [\d,]+ triangles\n", weft(tmp_path, "size", KEY, "--edge", "0.5").stdout)
    assert re.fullmatch(r"edges of 0\.4\d+ to 0\.\d+, in half of the area up to [\d.]+; about [\d,]+ triangles\n",
                        weft(tmp_path, "size", KEY, "--edge", "0.1 + 0.01*y").stdout)
    assert re.fullmatch(r"no bound at any cell; about \d+ triangles\n", weft(tmp_path, "size", KEY).stdout)


@pytest.mark.parametrize(("words", "code", "said"), [
    (["--edge", "2*foo"], 67, "unknown name 'foo'"),
    (["--edge", "x-30"], 67, "must be positive and finite"),
    (["--edge", "1", "-o", "edges.tif"], 2, "edges.tif: the grid is written to .asc"),
    (["--edge", "1", "-o", "missing/edges.asc"], 5, "missing"),
    (["--edge", "1", "--cells", "513"], 2, "--cells"),
])
def test_what_is_no_size_is_refused(tmp_path: pathlib.Path, words: list[str], code: int, said: str) -> None:
    ended = weft(tmp_path, "size", KEY, *words)
    assert (ended.returncode, ended.stdout) == (code, "")
    assert said in ended.stderr
    assert list(tmp_path.iterdir()) == []


def test_each_warning_comes_once(tmp_path: pathlib.Path) -> None:
    """Of a line outside, which the domain's reader sees, and of a size with no effect, which the engine does."""
    domain = {"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [
            [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]]}},
        {"type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coordinates": [[5, 5], [6, 6]]}},
    ]}
    (tmp_path / "line.geojson").write_text(json.dumps(domain))
    words = ["size", "line.geojson", "--edge", "1e7"]
    text = weft(tmp_path, *words)
    warnings = re.findall(r"WARNING: (.*)", text.stdout + text.stderr)
    assert len(warnings) == len(set(warnings)) == 2
    assert sorted(told(tmp_path, *words[1:])["warnings"]) == sorted(warnings)


def test_a_size_that_grows_from_a_place_is_none_there(tmp_path: pathlib.Path) -> None:
    bounds = ["--edge", "0.2*sqrt(hypot(x-1, y-1))"]
    (tmp_path / "square.poly").write_text("4 2 0 0\n1 0 0\n2 2 0\n3 2 2\n4 0 2\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n")
    size = told(tmp_path, "square.poly", *bounds, "--cells", 3)
    mesh = json.loads(weft(tmp_path, "mesh", "square.poly", *bounds, "-o", "square.vtu", "--json").stdout)
    assert size["least_edge"] == 0 and size["cells"] == 9
    assert mesh["triangles"] > 0
