# SPDX-License-Identifier: Apache-2.0
"""The package as users install it, and as their type checkers see it."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import zipfile

import pytest
import weft

SOURCE = pathlib.Path(os.environ["WEFT_SOURCE"])
VERSION = re.search(r"^project\(weft VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text(), re.M)[1]


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
                        ignore=shutil.ignore_patterns("*.egg-info", "build", "*.binpb", "_version.py"))
    for file in ("CMakeLists.txt", "LICENSE", "NOTICE"):
        shutil.copyfile(SOURCE / file, tmp_path / "clone" / file)
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
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        scripts = archive.read(next(name for name in names if name.endswith("/entry_points.txt"))).decode()
    assert "triangle-weft = weft.triangle:main" in scripts
    assert {"weft/py.typed", "weft/protocol.binpb", f"weftmesh-{VERSION}.dist-info/LICENSE",
            f"weftmesh-{VERSION}.dist-info/NOTICE"} <= set(names)
    assert str(wheel) in import_from(wheel, tmp_path)


def test_its_version_is_that_of_the_clone(checkout, tmp_path):
    root = checkout.parents[1] / "CMakeLists.txt"
    root.write_text(root.read_text().replace(f"weft VERSION {VERSION}", "weft VERSION 7.8.9"))
    wheel = build_wheel(tmp_path, checkout)
    assert wheel.name == "weftmesh-7.8.9-py3-none-any.whl"
    printed = run(sys.executable, "-c", "import weft; print(weft.__version__)", cwd=tmp_path,
                  PYTHONPATH=str(wheel))
    assert printed.strip() == "7.8.9"


def test_the_package_and_the_programs_have_one_version():
    assert weft.__version__ == VERSION
    assert run(os.environ["WEFT_WEFTD"], "--version", cwd=SOURCE).split()[1] == VERSION


def test_a_source_distribution_needs_nothing_beside_it(checkout, tmp_path):
    run(sys.executable, "setup.py", "-q", "sdist", "-d", tmp_path, cwd=checkout)
    assert (tmp_path / f"weftmesh-{VERSION}.tar.gz").is_file()
    shutil.rmtree(checkout.parents[1])
    assert import_from(build_wheel(tmp_path, next(tmp_path.glob("*.tar.gz"))), tmp_path)


def test_types_are_strict(checkout):
    pytest.importorskip("mypy")
    run(sys.executable, "setup.py", "-q", "egg_info", cwd=checkout)  # writes the version
    run(sys.executable, "-m", "mypy", "--cache-dir", os.devnull, "src", cwd=checkout)
