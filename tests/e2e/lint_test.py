# SPDX-License-Identifier: Apache-2.0
"""`weft lint` and `weft mesh --lint`: what they print, write and draw, and how they end; pixels are read by
Pillow, the layer by shapely."""
from __future__ import annotations

import json
import os
import pathlib
import re
import subprocess
import time

import PIL.Image
import pytest
import shapely.geometry

MODELS = pathlib.Path(__file__).parents[1] / "models"
WEFT = os.environ["WEFT_BINARY"]

YARD = """9 2 0 0
1 0 0
2 40 0
3 40 40
4 0 40
5 0 0.01
6 5 5
7 10 10
8 10 5
9 5 10
8 0
1 1 2
2 2 3
3 3 4
4 4 5
5 6 7
6 7 8
7 8 9
8 9 6
1
1 50 20
"""
SAID = """gap at (0, 0): a gap of 0.01 between the end of the segment at line 12 and that of the segment at \
line 15; --snap 0.011 closes it
crossing at (7.5, 7.5): the segment at line 16 crosses the segment at line 18; weft makes a vertex there; move \
one if it is not meant
seed-outside at (50, 20): the hole seed at line 21 is in no face that segments enclose; move the seed into its \
face, or leave it out
3 faults in yard.poly: 1 gap, 1 crossing, 1 seed-outside
"""


def weft(folder: pathlib.Path, *words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([WEFT, *map(str, words)], capture_output=True, text=True, cwd=folder)


def test_degrees_that_cannot_be_are_refused(tmp_path):
    (tmp_path / "far.wkt").write_text("POLYGON((500000 4000000, 500100 4000000, 500100 4000100, 500000 4000000))")
    refused = weft(tmp_path, "lint", "far.wkt", "--lonlat")
    assert refused.returncode == 4
    assert refused.stderr == ("weft: far.wkt: line 1, geometry 0, ring 0[0]: the latitude 4e+06 is not between -90 "
                              "and 90 degrees\n")
    assert weft(tmp_path, "lint", "far.wkt").returncode == 0


@pytest.fixture
def yard(tmp_path: pathlib.Path) -> pathlib.Path:
    (tmp_path / "yard.poly").write_text(YARD)
    return tmp_path


def test_text_has_a_line_for_each_fault(yard: pathlib.Path) -> None:
    done = weft(yard, "lint", "yard.poly")
    assert (done.returncode, done.stdout, done.stderr) == (3, SAID, "")


def test_a_domain_without_faults_ends_with_0(tmp_path: pathlib.Path) -> None:
    for model, *more in (("key.poly",), ("pipe.poly",), ("us-east-coast.geojson", "--lonlat")):
        done = weft(tmp_path, "lint", MODELS / model, *more)
        assert (done.returncode, done.stdout) == (0, f"no faults in {MODELS / model}\n")


def test_ignored_faults_are_none(yard: pathlib.Path) -> None:
    done = weft(yard, "lint", "yard.poly", "--ignore", "gap", "--ignore", "crossing", "--ignore",
                "seed-outside")
    assert (done.returncode, done.stdout) == (0, "no faults in yard.poly\n")
    done = weft(yard, "lint", "yard.poly", "--ignore", "gaps")
    assert done.returncode == 2
    assert "'gaps' is not a kind of fault: open-end, gap, " in done.stderr


def test_a_snap_leaves_out_what_it_mends(yard: pathlib.Path) -> None:
    done = weft(yard, "lint", "yard.poly", "--snap", "0.011", "--ignore", "seed-outside")
    assert done.stdout.endswith("\n1 fault in yard.poly: 1 crossing\n")
    assert weft(yard, "lint", "yard.poly", "--snap", "-1").returncode == 2


def test_json_is_one_object(yard: pathlib.Path) -> None:
    done = weft(yard, "lint", "yard.poly", "--json")
    assert done.returncode == 3
    told = json.loads(done.stdout)
    assert told["counts"] == {"gap": 1, "crossing": 1, "seed-outside": 1}
    assert [f["kind"] for f in told["findings"]] == ["gap", "crossing", "seed-outside"]
    assert told["findings"][0]["measure"] == 0.01
    assert told["findings"][1]["at"] == [7.5, 7.5]


def test_layer_is_read_as_geometry(yard: pathlib.Path) -> None:
    assert weft(yard, "lint", "yard.poly", "-o", "faults.geojson").stdout == SAID
    features = json.loads((yard / "faults.geojson").read_text())["features"]
    shapes = [shapely.geometry.shape(f["geometry"]) for f in features]
    assert [s.wkt for s in shapes] == ["LINESTRING (0 0, 0 0.01)", "POINT (7.5 7.5)", "POINT (50 20)"]
    assert features[0]["properties"]["remedy"] == "--snap 0.011 closes it"


def test_picture_marks_the_faults(yard: pathlib.Path) -> None:
    def colored(*flags: object) -> int:
        weft(yard, "lint", "yard.poly", "--draw", "a.png", "--draw-size", 600, "--no-legend", *flags)
        picture = PIL.Image.open(yard / "a.png").convert("RGB")
        return sum(max(p) - min(p) > 100 for p in picture.getdata())

    marked = colored()
    assert marked > 100
    assert colored("--ignore", "gap") < marked
    assert colored("--ignore", "gap", "--ignore", "crossing", "--ignore", "seed-outside") == 0


def test_drawings_have_a_legend_of_kinds(yard: pathlib.Path) -> None:
    assert weft(yard, "lint", "yard.poly", "--draw", "a.svg", "--draw", "a.pdf").returncode == 3
    text = subprocess.run(["pdftotext", "a.pdf", "-"], cwd=yard, capture_output=True, text=True,
                          check=True).stdout
    for kind in ("1 gap", "2 crossing", "3 seed-outside"):
        assert kind in text
    assert "triangle" not in text
    assert (yard / "a.svg").read_text().startswith("<?xml")


def test_files_that_cannot_be_written_are_refused(yard: pathlib.Path) -> None:
    for flags in (["-o", "a.shp"], ["--draw", "a.gif"], ["-o", "none/a.geojson"]):
        done = weft(yard, "lint", "yard.poly", *flags)
        assert done.returncode in (2, 5)
        assert flags[1] in done.stderr
    (yard / "a.geojson").write_bytes((MODELS / "us-east-coast.geojson").read_bytes())
    assert "would replace the input" in weft(yard, "lint", "a.geojson", "-o", "a.geojson").stderr
    assert weft(yard, "lint", "none.poly").returncode == 4


def test_mesh_tells_of_faults_and_goes_on(yard: pathlib.Path) -> None:
    inside = YARD.replace("1 50 20", "1 6 5.2")
    (yard / "yard.poly").write_text(inside)
    told = weft(yard, "lint", "yard.poly", "--snap", "0.011").stdout
    assert "crossing" in told
    done = weft(yard, "mesh", "yard.poly", "-o", "a.vtu", "--snap", "0.011", "--lint", "--quiet")
    assert (done.returncode, done.stderr) == (0, told)
    assert (yard / "a.vtu").exists()
    assert weft(yard, "mesh", "yard.poly", "--lint", "--detach").returncode == 2


def test_a_large_coast_takes_a_second_or_two(tmp_path: pathlib.Path) -> None:
    """Of 100,000 points."""
    ring = []
    for i in range(100_000):
        depth = (0.5 if i % 2 else 0.4) * (1 + 0.1 * ((i * 7919) % 101) / 101)
        ring.append([i / 1000, depth])
    ring += [[100, 50], [0, 50], ring[0]]
    feature = {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [ring]}}
    (tmp_path / "coast.geojson").write_text(json.dumps(feature))
    start = time.monotonic()
    done = weft(tmp_path, "lint", "coast.geojson", "--json")
    assert done.returncode in (0, 3)
    assert time.monotonic() - start < 20  # about 1 s on a machine that does nothing else
    assert re.match(r'\{"file":"coast.geojson","faults":', done.stdout)


# A square that does not close, around another.
GAP = "9 2\n1 0 0\n2 9 0\n3 9 9\n4 0 9\n5 0 0.001\n6 3 3\n7 6 3\n8 6 6\n9 3 6\n8\n" \
      "1 1 2\n2 2 3\n3 3 4\n4 4 5\n5 6 7\n6 7 8\n7 8 9\n8 9 6\n0\n"


def test_lines_that_do_not_close_are_a_warning_and_with_strict_an_error(tmp_path):
    (tmp_path / "gap.poly").write_text(GAP)
    told = "4 segments lie outside of what is meshed, the first at (0, 0); weft lint shows where lines do not close"
    mesh = ["mesh", "gap.poly", "--size", 1, "-o", "gap.vtu"]
    done = weft(tmp_path, *mesh)
    assert done.returncode == 0 and f"WARNING: {told}\n" in done.stdout
    report = json.loads(weft(tmp_path, *mesh, "--json").stdout)
    assert report["warnings"] == [told]
    assert report["outside"] == {"segments": 4, "first": 0, "at": [0, 0]}
    (tmp_path / "gap.vtu").unlink()
    strict = weft(tmp_path, *mesh, "--strict")
    assert strict.returncode == 4
    assert strict.stderr.endswith(f"gap.poly: refused, because of --strict\n  {told}\n")
    assert [path.name for path in tmp_path.iterdir()] == ["gap.poly"]
    closed = json.loads(weft(tmp_path, *mesh, "--json", "--strict", "--snap", 0.002).stdout)
    assert "warnings" not in closed and closed["outside"] is None and closed["area"] == pytest.approx(81, abs=0.01)
