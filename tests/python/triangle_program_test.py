# SPDX-License-Identifier: Apache-2.0
"""triangle-weft: Triangle's command line and files."""

import subprocess
import sys

import numpy as np
import pytest
import weft
from weft import _switches, _triangle_files

# From 1, with an attribute per vertex; a hole, and a region with a maximum area.
BOX = """\
8 2 1 1
1 0 0 10 5
2 4 0 20 5
3 4 4 30 5
4 0 4 40 5
5 1 1 0 0
6 2 1 0 0
7 2 2 0 0
8 1 2 0 0
8 1
1 1 2 2
2 2 3 3
3 3 4 3
4 4 1 3
5 5 6 7   # the hole
6 6 7 7
7 7 8 7
8 8 5 7
1
1 1.5 1.5
1
1 3 3 -2.5 0.1
"""


@pytest.fixture
def run(tmp_path):
    def call(*arguments, code=0):
        done = subprocess.run([sys.executable, "-m", "weft.triangle", *arguments], cwd=tmp_path,
                              capture_output=True, text=True)
        assert done.returncode == code, done.stdout + done.stderr
        return done.stdout + done.stderr
    return call


def numbers(path):
    return [[float(word) for word in line.split()] for line in path.read_text().splitlines()]


def test_a_mesh_holds_before_the_independent_checker(run, run_weft, tmp_path):
    (tmp_path / "box.poly").write_text(BOX)
    said = run("-pq30a0.2", "-aA", "box")
    mesh = weft.Mesh.read(tmp_path / "box.1.node")
    assert said == ("Writing box.1.node.\nWriting box.1.ele.\nWriting box.1.poly.\n"
                    f"Mesh vertices: {len(mesh.points)}\nMesh triangles: {len(mesh.triangles)}\n")
    assert "the mesh holds" in run_weft("check", tmp_path / "box.1.node", "--domain", tmp_path / "box.poly",
                                        "--size", "0.2", "--min-angle", 30)


def test_files_have_the_columns_of_triangle_and_the_numbers_of_the_input(run, tmp_path):
    for base, text in ((1, BOX), (0, from_zero(BOX))):
        (tmp_path / "box.poly").write_text(text)
        assert run("-pq30aAenQ", "box.poly") == ""
        node, ele, poly, edge, neigh = (numbers(tmp_path / f"box.1.{suffix}")
                                        for suffix in ("node", "ele", "poly", "edge", "neigh"))
        n, m = len(node) - 1, len(ele) - 1
        assert node[0] == [n, 2, 1, 1] and ele[0] == [m, 3, 1]
        assert edge[0] == [len(edge) - 1, 1] and neigh[0] == [m, 3]
        assert node[1:3] == [[base, 0, 0, 10, 5], [base + 1, 4, 0, 20, 5]]
        assert {row[4] for row in ele[1:]} == {-2.5}
        used = {vertex for row in ele[1:] for vertex in row[1:4]}
        assert used == set(range(base, base + n))
        assert all(row[k] == -1 or base <= row[k] < base + m for row in neigh[1:] for k in (1, 2, 3))
        segments = int(poly[1][0])
        assert poly[0] == [0, 2, 1, 1] and poly[1] == [segments, 1]
        assert poly[2 + segments:] == [[1], [base, 1.5, 1.5], [1], [base, 3, 3, -2.5, 0.1]]
        # Euler, with one hole
        assert n - (len(edge) - 1) + m == 0


def from_zero(text):
    """The same file, numbered from 0."""
    lines = [line.partition("#")[0].split() for line in text.splitlines()]
    for rows in (range(1, 9), range(10, 18), [19], [21]):
        for i in rows:
            lines[i][0] = str(int(lines[i][0]) - 1)
    for i in range(10, 18):
        lines[i][1:3] = [str(int(word) - 1) for word in lines[i][1:3]]
    return "\n".join(map(" ".join, lines))


def test_a_mesh_is_read_again_and_refined_by_its_areas(run, run_weft, tmp_path):
    (tmp_path / "box.poly").write_text(BOX)
    run("-pqA", "box")
    coarse = weft.Mesh.read(tmp_path / "box.1.node")
    areas = [f"{i} {0.05 if i % 2 else -1}" for i in range(1, len(coarse.triangles) + 1)]
    (tmp_path / "box.1.area").write_text("\n".join([str(len(coarse.triangles)), *areas]))
    run("-rpqaa0.1", "box.1")
    fine = weft.Mesh.read(tmp_path / "box.2.ele")
    assert len(fine.triangles) > 2 * len(coarse.triangles)
    assert np.array_equal(fine.points[:len(coarse.points)], coarse.points)
    assert {row[4] for row in numbers(tmp_path / "box.2.ele")[1:]} == {-2.5}
    assert "the mesh holds" in run_weft("check", tmp_path / "box.2.node", "--domain", tmp_path / "box.poly")


def test_points_alone_are_a_node_file(run, tmp_path):
    (tmp_path / "cloud.node").write_text("4 2 0 0\n7 0 0\n8 1 0\n9 1 1\n10 0 1\n")
    run("-c", "cloud.node")
    assert len(numbers(tmp_path / "cloud.1.ele")) == 3
    assert numbers(tmp_path / "cloud.1.node")[1] == [1, 0, 0, 1]
    assert len(numbers(tmp_path / "cloud.1.poly")) == 2 + 4 + 1


def test_files_are_left_out_with_N_E_P_and_B_drops_markers(run, tmp_path):
    (tmp_path / "box.poly").write_text(BOX)
    run("-pqNEPnQ", "box")
    assert {path.name for path in tmp_path.iterdir()} == {"box.poly", "box.1.neigh"}
    run("-pqBe", "box")
    assert numbers(tmp_path / "box.1.node")[0][3] == 0 and numbers(tmp_path / "box.1.edge")[0][1] == 0
    assert numbers(tmp_path / "box.1.poly")[1][1] == 0


def test_without_iteration_numbers_no_input_is_written_over(run, tmp_path):
    (tmp_path / "box.poly").write_text(BOX)
    run("-pqI", "box")
    assert (tmp_path / "box.poly").read_text() == BOX
    assert {path.name for path in tmp_path.iterdir()} == {"box.poly", "box.node", "box.ele"}
    before = (tmp_path / "box.node").read_text()
    run("-qIa1", "box.node")
    assert (tmp_path / "box.node").read_text() == before


def test_what_is_wrong_is_named_with_its_file(run, tmp_path):
    (tmp_path / "box.poly").write_text(BOX.replace("8 8 5 7", "8 8 55 7"))
    assert "box.poly: segments: segment 8 of the file names the point 55" in run("-p", "box", code=1)
    assert "none.node" in run("none", code=1)
    assert "the switch 'x': unknown" in run("-px", "box", code=2)
    assert "0 names of files" in run("-p", code=2)
    assert "'I'" in run("-rI", "box", code=2)
    assert "triangle-weft [-SWITCHES...] NAME" in run(code=2)
    assert "triangle-weft [-SWITCHES...] NAME" in run("-h")


def test_a_warning_is_said(run, tmp_path):
    (tmp_path / "box.poly").write_text(BOX)
    assert "triangle-weft: WARNING: S2: 2 new points are too few" in run("-pqa0.01S2", "box")


def test_the_next_mesh_has_the_next_number(tmp_path):
    for name, following in (("box", "box.1"), ("box.1", "box.2"), ("box.9", "box.10"), ("v1.2.x", "v1.2.x.1")):
        assert _triangle_files.next_base(tmp_path / name) == tmp_path / following


def test_markers_and_attributes_may_be_missing(tmp_path):
    (tmp_path / "a.node").write_text("3 2\n0 0 0\n1 1 0\n2 0 1\n")
    found, first = _triangle_files.read(tmp_path / "a", _switches.parse(""))
    assert set(found) == {"vertices"} and first == 0
