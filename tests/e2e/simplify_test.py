# SPDX-License-Identifier: Apache-2.0
"""`weft mesh --simplify` on a coast, from its file to the checker's verdict."""
from __future__ import annotations

import json
import os
import pathlib
import subprocess

MODELS = pathlib.Path(__file__).parents[1] / "models"
WEFT = os.environ["WEFT_BINARY"]
COAST = [MODELS / "us-east-coast.geojson", "--to-metres", "--edge", 20_000, "--min-angle", 25]
SIMPLIFIED = [*COAST, "--simplify", 0.5, "--min-edge", 5_000]


def weft(folder: pathlib.Path, *words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([WEFT, *map(str, words)], capture_output=True, text=True, cwd=folder)


def mesh(folder: pathlib.Path, output: str, *words: object) -> dict:
    ended = weft(folder, "mesh", *words, "-o", output, "--json")
    assert ended.returncode == 0, ended.stderr
    return json.loads(ended.stdout)


def test_a_coast_is_simplified_to_its_size(tmp_path: pathlib.Path) -> None:
    before = mesh(tmp_path, "before.vtu", *COAST)
    after = mesh(tmp_path, "after.vtu", *SIMPLIFIED)
    made = after["simplification"]
    assert before["simplification"] is None
    assert made["points"] > 6_000 and made["islands"] > 50 and made["channels"] > 20
    assert 0 < made["farthest"] <= 10_000
    assert abs(after["area"] - before["area"] - made["area"]) < 1e-9 * before["area"]
    assert after["triangles"] < 0.6 * before["triangles"]
    assert mesh(tmp_path, "again.vtu", *SIMPLIFIED)["digest"] == after["digest"]


def test_the_checker_judges_it_by_the_file(tmp_path: pathlib.Path) -> None:
    made = mesh(tmp_path, "after.vtu", *SIMPLIFIED)
    check = ["check", "after.vtu", "--domain", *COAST, "--max-unrefined", made["unrefined"]["edge_floor"]]
    right = weft(tmp_path, *check, "--simplify", 0.5)
    assert right.returncode == 0, right.stdout
    assert "the domain is simplified no farther than asked: holds" in right.stdout
    assert weft(tmp_path, *check).returncode != 0
    too_strict = weft(tmp_path, *check, "--simplify", 0.2)
    assert too_strict.returncode != 0
    assert "are allowed" in too_strict.stdout


def test_a_size_is_needed(tmp_path: pathlib.Path) -> None:
    ended = weft(tmp_path, "mesh", MODELS / "key.poly", "-o", "key.vtu", "--simplify", 0.5)
    assert ended.returncode == 67
    assert "--simplify" in ended.stderr and "has no size" in ended.stderr
