# SPDX-License-Identifier: Apache-2.0
"""Every key that --json prints is in docs/command-line.md."""
import json
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODELS = ROOT / "tests/models"
PAGE = (ROOT / "docs/command-line.md").read_text()
KEY = MODELS / "key.poly"
COAST = MODELS / "us-east-coast.geojson"

OVERLAPPING = {"type": "MultiPolygon", "coordinates": [
    [[[x, 0], [x + 2, 0], [x + 2, 2], [x, 2], [x, 0]]] for x in (0, 1)]}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("keys")
    (folder / "two.geojson").write_text(json.dumps(OVERLAPPING))
    for words in (["mesh", KEY, "-o", "key.vtu", "--size", "0.5"],
                  ["mesh", COAST, "-o", "coast.14", "--lonlat", "--edge", "50000", "--nodal", "depth=20"]):
        subprocess.run([os.environ["WEFT_BINARY"], *words, "-q"], cwd=folder, check=True)
    return folder


def keys(value, path=""):
    """The path of each key, and the key."""
    children = value.items() if isinstance(value, dict) else ()
    for key, child in children:
        yield path + key, key
        yield from keys(child, f"{path}{key}.")
    for child in value if isinstance(value, list) else ():
        yield from keys(child, f"{path}[].")


@pytest.mark.parametrize("words", [
    ["mesh", KEY, "-o", "a.vtu", "--size", "0.5"],
    ["mesh", "two.geojson", "-o", "b.vtu"],
    ["mesh", COAST, "-o", "c.14", "--lonlat", "--edge", "20000", "--simplify", "1", "--snap", "100"],
    ["mesh", KEY, "-o", "d.vtu", "--size", "min(1, 1e-30 + 0.1*((x-20)^2 + (y-46)^2))", "--allow-unrefined"],
    ["size", COAST, "--lonlat", "--edge", "1e7"],
    ["info", "key.vtu", "--quality", "--size", "0.5"],
    ["check", "key.vtu", "--domain", KEY, "--size", "0.5"],
    ["check", "key.vtu", "--domain", KEY, "--size", "0.1"],
    ["check", "coast.14", "--for", "adcirc", "--lonlat"],
    ["lint", COAST],
    ["lint", "two.geojson"],
], ids=lambda words: " ".join(map(str, words[:1] + words[2:4])))
def test_every_key_is_documented(folder, words):
    done = subprocess.run([os.environ["WEFT_BINARY"], *words, "--json"], cwd=folder, capture_output=True, text=True)
    printed = json.loads(done.stdout)
    assert sorted({path for path, key in keys(printed) if f"`{key}`" not in PAGE}) == []
