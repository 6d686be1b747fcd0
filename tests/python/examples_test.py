# SPDX-License-Identifier: Apache-2.0
"""The examples run as they stand."""

import os
import pathlib
import re
import subprocess
import sys

import matplotlib.image
import numpy as np

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


def test_what_the_readme_shows_is_what_it_prints():
    root = pathlib.Path(os.environ["WEFT_SOURCE"])
    code, printed = re.search(r"## From Python\n\n```python\n(.*?)```\n\n```\n(.*?)```",
                              (root / "README.md").read_text(), re.DOTALL).groups()
    done = subprocess.run([sys.executable, "-B", "-c", code], cwd=root, capture_output=True, text=True)
    assert done.stdout == printed, done.stderr
