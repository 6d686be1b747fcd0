# SPDX-License-Identifier: Apache-2.0
"""Sides that are given, from files to files: `weft remesh` leaves what is outside as it was, `weft stitch` joins
what was meshed apart, and the checker judges both."""
from __future__ import annotations

import json
import os
import pathlib
import subprocess

import numpy as np
import pytest

MODELS = pathlib.Path(__file__).parents[1] / "models"
WEFT = os.environ["WEFT_BINARY"]
KEY = MODELS / "key.poly"


def weft(folder: pathlib.Path, *words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([WEFT, *map(str, words)], capture_output=True, text=True, cwd=folder)


def run(folder: pathlib.Path, *words: object) -> str:
    ended = weft(folder, *words)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return ended.stdout


def polygon(folder: pathlib.Path, *corners: tuple[float, float]) -> str:
    (folder / "within.geojson").write_text(json.dumps({"type": "Polygon", "coordinates": [[*corners, corners[0]]]}))
    return "within.geojson"


@pytest.fixture
def old(tmp_path: pathlib.Path) -> dict[str, np.ndarray]:
    """A mesh of the key, in old.npz, with a value at each vertex."""
    run(tmp_path, "mesh", KEY, "-o", "old.npz", "--size", 0.5, "--nodal", "depth=7", "--quiet")
    return dict(np.load(tmp_path / "old.npz"))


def half_of(folder: pathlib.Path, mesh: dict[str, np.ndarray]) -> str:
    low, high = mesh["points"].min(axis=0) - 1, mesh["points"].max(axis=0) + 1
    middle = (low[0] + high[0]) / 2
    return polygon(folder, (low[0], low[1]), (middle, low[1]), (middle, high[1]), (low[0], high[1]))


@pytest.mark.parametrize("size", [0.05, 5])
def test_what_is_outside_of_a_patch_stays(tmp_path: pathlib.Path, old: dict[str, np.ndarray], size: float) -> None:
    said = json.loads(run(tmp_path, "remesh", "old.npz", "--within", half_of(tmp_path, old), "--size", size,
                          "-o", "new.npz", "--json"))
    new = dict(np.load(tmp_path / "new.npz"))
    middle = (old["points"][:, 0].min() + old["points"][:, 0].max()) / 2
    outside = (old["points"][old["triangles"]][:, :, 0] >= middle).any(axis=1)
    assert said["patch"]["triangles_before"] == (~outside).sum()
    assert said["mesh"]["triangles"] == len(new["triangles"])
    kept = old["points"][old["triangles"][outside]]
    assert np.array_equal(new["points"][new["triangles"]][:outside.sum()], kept)
    if len(new["points"]) >= len(old["points"]):
        assert np.array_equal(new["triangles"][:outside.sum()], old["triangles"][outside])
    assert np.allclose(new["depth"], 7, rtol=1e-12, atol=0) and len(new["depth"]) == len(new["points"])
    more = size < 0.5
    assert (len(new["triangles"]) > len(old["triangles"])) == more
    judged = weft(tmp_path, "check", "new.npz", "--domain", KEY, "--max-unrefined", 100_000)
    faults = [line for line in judged.stdout.splitlines() if ": fails" in line]
    assert all("Delaunay" in fault for fault in faults), judged.stdout


def test_a_patch_is_the_same_again(tmp_path: pathlib.Path, old: dict[str, np.ndarray]) -> None:
    for name, threads in (("a.npz", 1), ("b.npz", 2)):
        run(tmp_path, "remesh", "old.npz", "--within", half_of(tmp_path, old), "--size", 0.05, "--threads", threads,
            "-o", name, "--quiet")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_a_grid_in_degrees_is_meshed_anew_in_metres(tmp_path: pathlib.Path) -> None:
    coast = MODELS / "us-east-coast.geojson"
    run(tmp_path, "mesh", coast, "--lonlat", "--edge", 40_000, "--simplify", 1, "--nodal", "depth=10", "-o", "old.14",
        "--quiet")
    bight = polygon(tmp_path, (-75, 39), (-72, 39), (-72, 41.5), (-75, 41.5))
    said = json.loads(run(tmp_path, "remesh", "old.14", "--within", bight, "--lonlat", "--edge", 8_000, "-o", "new.14",
                          "-o", "new.npz", "--json"))
    assert said["triangles"] > 5 * said["patch"]["triangles_before"]
    run(tmp_path, "convert", "old.14", "old.npz", "--quiet")
    old, new = (np.load(tmp_path / name)["points"] for name in ("old.npz", "new.npz"))
    outside = (old < (-75, 39)).any(axis=1) | (old > (-72, 41.5)).any(axis=1)
    assert outside.sum() > 100 and np.array_equal(new[:len(old)][outside], old[outside])
    assert (new > (-83, 23)).all() and (new < (-61, 47)).all()


def test_a_part_that_touches_nothing_is_meshed_anew(tmp_path: pathlib.Path) -> None:
    squares = [[[x, 0], [x + 1, 0], [x + 1, 1], [x, 1], [x, 0]] for x in (0, 2)]
    (tmp_path / "two.geojson").write_text(json.dumps({"type": "MultiPolygon", "coordinates": [[s] for s in squares]}))
    run(tmp_path, "mesh", "two.geojson", "-o", "two.npz", "--size", 0.1, "--quiet")
    around = polygon(tmp_path, (1.5, -1), (4, -1), (4, 2), (1.5, 2))
    run(tmp_path, "remesh", "two.npz", "--within", around, "--size", 0.001, "-o", "new.npz", "--quiet")
    run(tmp_path, "check", "new.npz", "--domain", "two.geojson", "--size", 0.1)


def test_a_polygon_around_nothing_is_an_error(tmp_path: pathlib.Path, old: dict[str, np.ndarray]) -> None:
    far = polygon(tmp_path, (1e6, 1e6), (2e6, 1e6), (2e6, 2e6))
    ended = weft(tmp_path, "remesh", "old.npz", "--within", far, "-o", "new.npz")
    assert ended.returncode == 2 and "no triangle is within the polygon" in ended.stderr
    assert not (tmp_path / "new.npz").exists()


def square(folder: pathlib.Path, name: str, x: float, keep: bool) -> str:
    """A square of side 1 whose sides have five segments each, at this place."""
    along = [i / 5 for i in range(5)]
    corners = ([(x + t, 0) for t in along] + [(x + 1, t) for t in along] + [(x + 1 - t, 1) for t in along]
               + [(x, 1 - t) for t in along])
    lines = [f"{len(corners)} 2 0 0", *(f"{i} {p!r} {q!r}" for i, (p, q) in enumerate(corners)), f"{len(corners)} 0",
             *(f"{i} {i} {(i + 1) % len(corners)}" for i in range(len(corners))), "0"]
    (folder / f"{name}.poly").write_text("\n".join(lines) + "\n")
    run(folder, "mesh", f"{name}.poly", "-o", f"{name}.vtu", "--edge", 0.05, *(["--keep", "all"] if keep else []),
        "--quiet")
    return f"{name}.vtu"


def test_meshes_are_joined_where_their_sides_were_kept(tmp_path: pathlib.Path) -> None:
    parts = [square(tmp_path, f"part{i}", i, keep=True) for i in range(3)]
    said = json.loads(run(tmp_path, "stitch", *parts, "-o", "all.npz", "--json"))
    assert said["common_vertices"] == 12 and said["common_edges"] == 10
    mesh = dict(np.load(tmp_path / "all.npz"))
    assert len(np.unique(mesh["points"], axis=0)) == len(mesh["points"])
    corners = mesh["points"][mesh["triangles"]]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    assert (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).sum() / 2 == pytest.approx(3, abs=1e-12)


def test_meshes_that_do_not_meet_are_refused(tmp_path: pathlib.Path) -> None:
    kept, split = square(tmp_path, "kept", 0, keep=True), square(tmp_path, "split", 1, keep=False)
    ended = weft(tmp_path, "stitch", kept, split, "-o", "all.vtu")
    assert ended.returncode == 4 and "lies on an edge of kept.vtu" in ended.stderr
    assert not (tmp_path / "all.vtu").exists()
    assert "overlap" in weft(tmp_path, "stitch", kept, kept, "-o", "all.vtu").stderr
    assert weft(tmp_path, "stitch", kept, "-o", "all.vtu").returncode == 2


CELL = """\
4 2 0 0
1 0 0
2 4 0
3 4 2
4 0 2
4 1
1 1 2 1
2 2 3 2
3 3 4 3
4 4 1 4
0
"""


def test_gmsh_has_the_nodes_of_periodic_sides_in_pairs(tmp_path: pathlib.Path) -> None:
    import gmsh  # Debian's

    (tmp_path / "cell.poly").write_text(CELL)
    run(tmp_path, "mesh", "cell.poly", "--edge", "0.1 + 0.1*x", "--periodic", "4:2,1:3", "-o", "cell.msh", "-q")
    gmsh.initialize(["gmsh", "-v", "2"])
    try:
        gmsh.open(str(tmp_path / "cell.msh"))
        found = {}
        for _, curve in gmsh.model.getEntities(1):
            master, nodes, images, motion = gmsh.model.mesh.getPeriodicNodes(1, curve)
            if master != curve:
                at = [np.array([gmsh.model.mesh.getNode(node)[0][:2] for node in side]) for side in (images, nodes)]
                found[curve] = master, len(nodes), at[1] - at[0], np.reshape(motion, (4, 4))[:2, 3]
    finally:
        gmsh.finalize()
    assert {curve: master for curve, (master, *_) in found.items()} == {2: 4, 3: 1}
    for curve, shift in ((2, (4, 0)), (3, (0, 2))):
        _, count, steps, moved = found[curve]
        assert count > 10 and np.allclose(steps, shift, atol=1e-8) and np.allclose(moved, shift, atol=1e-8)


def test_the_pairs_are_in_the_older_version_of_gmshs_format(tmp_path: pathlib.Path) -> None:
    (tmp_path / "cell.poly").write_text(CELL)
    run(tmp_path, "mesh", "cell.poly", "--edge", "0.3", "--periodic", "4:2", "-o", "cell.msh", "--msh-version", "2.2", "-q")
    lines = (tmp_path / "cell.msh").read_text().splitlines()
    nodes = [line.split() for line in lines[lines.index("$Nodes") + 2:lines.index("$EndNodes")]]
    at = {int(tag): np.array([float(x), float(y)]) for tag, x, y, _ in nodes}
    count, sides, pairs, *listed = lines[lines.index("$Periodic") + 1:lines.index("$EndPeriodic")]
    assert (count, sides, int(pairs)) == ("1", "1 2 4", len(listed))
    assert len(listed) > 5
    for pair in listed:
        image, node = map(int, pair.split())
        assert np.allclose(at[image] - at[node], (4, 0), atol=1e-8)
    run(tmp_path, "mesh", "cell.poly", "--edge", "0.3", "-o", "plain.msh", "--msh-version", "2.2", "-q")
    assert "$Periodic" not in (tmp_path / "plain.msh").read_text()
