# SPDX-License-Identifier: Apache-2.0
"""The examples run as they stand."""

import os
import pathlib
import re
import subprocess
import sys

import matplotlib.image
import numpy as np
import pytest

EXAMPLES = pathlib.Path(os.environ["WEFT_SOURCE"]) / "client/python/examples"


def run(name, *arguments):
    done = subprocess.run([sys.executable, "-B", EXAMPLES / name, *arguments], capture_output=True,
                          text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_coast_is_meshed_and_drawn(tmp_path):
    said = run("us_east_coast.py", tmp_path / "coast.png")
    assert re.match(r"[\d,]+ triangles, angles", said), said
    picture = matplotlib.image.imread(tmp_path / "coast.png")[..., :3]
    drawn = (picture < 0.99).any(axis=2)
    assert picture.shape[:2] == (900, 1650)
    halves = np.split(drawn, [picture.shape[1] // 2], axis=1)
    assert all(half.mean() > 0.04 for half in halves)


def test_poisson_converges_with_order_two():
    said = run("poisson.py")
    assert said.count("triangles") == 4, said


def test_meshes_that_follow_their_error_reach_the_optimal_order_at_a_singular_corner():
    said = run("adaptive.py", "20000")
    orders = [float(order) for order in re.findall(r"order +([\d.]+)", said)]
    assert len(orders) == 5 and orders[-1] == pytest.approx(0.5, abs=0.05), said


def test_a_lattice_lowers_the_errors_of_poisson_and_of_advection():
    rows = [line.split() for line in run("placement.py").splitlines()[1:]]
    assert [row[0] for row in rows] == ["poisson"] * 4 + ["advection"] * 4 + ["graded"] * 4
    for row in rows[3::4]:
        assert float(row[-2]) < 0.8 and float(row[-1]) < 0.95, row


def test_the_drag_of_a_cylinder_is_that_of_the_benchmark(tmp_path):
    angle = np.linspace(0, 2 * np.pi, 96, endpoint=False)
    ring = np.column_stack([0.2 + 0.05 * np.cos(angle), 0.2 + 0.05 * np.sin(angle)])
    corners = [(0, 0, 3), (2.2, 0, 2), (2.2, 0.41, 3), (0, 0.41, 1), *((x, y, 4) for x, y in ring)]
    after = [1, 2, 3, 0, *range(5, 100), 4]
    poly = ["100 2 0 0", *(f"{i} {x} {y}" for i, (x, y, _) in enumerate(corners)),
            "100 1", *(f"{i} {i} {after[i]} {marker}" for i, (_, _, marker) in enumerate(corners)),
            "1", "0 0.2 0.2"]
    (tmp_path / "channel.poly").write_text("\n".join(poly))
    said = run("cylinder_flow.py", tmp_path / "channel.poly", tmp_path / "flow.png")
    assert re.search(r"drag 5\.5[678]", said), said
    assert (tmp_path / "flow.png").stat().st_size > 10_000
