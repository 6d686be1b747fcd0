# SPDX-License-Identifier: Apache-2.0
"""The package as users install it, and as their type checkers see it."""

import os
import pathlib
import shutil
import subprocess
import sys

import pytest

SOURCE = pathlib.Path(os.environ["WEFT_SOURCE"])


def run(*command, cwd, **environment):
    done = subprocess.run(list(map(str, command)), cwd=cwd, capture_output=True, text=True,
                          env={**os.environ, **environment})
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture
def checkout(tmp_path):
    """What of a clone the package is built from."""
    for part in ("proto", "client/python"):
        shutil.copytree(SOURCE / part, tmp_path / "clone" / part,
                        ignore=shutil.ignore_patterns("*.egg-info", "build", "*.binpb"))
    return tmp_path / "clone" / "client" / "python"


def build_wheel(folder, source):
    run(sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-index", "--no-build-isolation",
        "-w", folder, source, cwd=folder)
    return next(folder.glob("*.whl"))


def import_from(wheel, folder):
    return run(sys.executable, "-c", "import weft; print(weft.__file__, weft.Client.mesh)",
               cwd=folder, PYTHONPATH=str(wheel))


def test_a_wheel_is_built_from_a_clone_without_a_network(checkout, tmp_path):
    wheel = build_wheel(tmp_path, checkout)
    names = run(sys.executable, "-m", "zipfile", "-l", wheel, cwd=tmp_path)
    assert "weft/py.typed" in names and "weft/protocol.binpb" in names
    assert str(wheel) in import_from(wheel, tmp_path)


def test_a_source_distribution_needs_nothing_beside_it(checkout, tmp_path):
    run(sys.executable, "setup.py", "-q", "sdist", "-d", tmp_path, cwd=checkout)
    shutil.rmtree(checkout.parents[1])
    assert import_from(build_wheel(tmp_path, next(tmp_path.glob("*.tar.gz"))), tmp_path)


def test_types_are_strict(checkout):
    pytest.importorskip("mypy")
    run(sys.executable, "-m", "mypy", "--cache-dir", os.devnull, "src", cwd=checkout)
