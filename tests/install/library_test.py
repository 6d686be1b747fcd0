# SPDX-License-Identifier: Apache-2.0
"""The installed library: programs are built against it with CMake and with pkg-config, its headers name
nothing but themselves, the standard library and tl::expected, and it configures without gRPC."""
import os
import pathlib
import re
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["WEFT_BUILD"])
CMAKE = os.environ["CMAKE"]
EXAMPLE = ROOT / "examples/library"
CLEAN = {k: v for k, v in os.environ.items() if not k.startswith("WEFT_")}


def run(*words, **options):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True,
                          **{"env": CLEAN} | options)
    assert done.returncode == 0, f"{words}: {done.stdout}{done.stderr}"
    return done.stdout


def cached(name):
    """A variable of the build's cache."""
    return re.search(rf"^{name}:\w+=(.*)$", (BUILD / "CMakeCache.txt").read_text(), re.M)[1]


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    folder = tmp_path_factory.mktemp("library")
    for component in ("library", "libweft0"):
        run(CMAKE, "--install", BUILD, "--prefix", folder, "--component", component)
    return folder


@pytest.fixture(scope="module")
def printed(prefix, tmp_path_factory):
    """What the example prints when it is built with CMake."""
    build = tmp_path_factory.mktemp("example")
    run(CMAKE, "-S", EXAMPLE, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}",
        f"-DCMAKE_CXX_COMPILER={cached('CMAKE_CXX_COMPILER')}")
    run(CMAKE, "--build", build)
    return run(build / "mesh")


def test_the_example_is_built_with_cmake_and_makes_the_mesh_of_the_document(printed):
    assert printed in (ROOT / "docs/library.md").read_text()


def test_the_example_is_built_with_pkg_config_wherever_the_files_are(prefix, printed, tmp_path):
    moved = prefix.rename(tmp_path / "moved")
    try:
        folder, = moved.rglob("pkgconfig")
        flags = run("pkg-config", "--cflags", "--libs", "weftxx",
                    env=CLEAN | {"PKG_CONFIG_PATH": str(folder)}).split()
        run("g++", "-std=c++20", "-Wall", "-Wextra", "-Werror", EXAMPLE / "mesh.cpp", *flags,
            "-o", tmp_path / "mesh")
        assert run(tmp_path / "mesh") == printed
    finally:
        moved.rename(prefix)


def test_the_c_interface_is_found_by_pkg_config(prefix, tmp_path):
    folder, = prefix.rglob("pkgconfig")
    flags = run("pkg-config", "--cflags", "--libs", "weft",
                env=CLEAN | {"PKG_CONFIG_PATH": str(folder)}).split()
    run("gcc", "-std=c11", ROOT / "tests/engine/c/interface.c", *flags, "-lm", "-o", tmp_path / "c")
    run(tmp_path / "c", env=CLEAN | {"LD_LIBRARY_PATH": str(folder.parent)})


def test_the_headers_are_few_and_name_nothing_else(prefix):
    headers = sorted((prefix / "include/weft").iterdir())
    texts = [header.read_text() for header in headers]
    names = {name for text in texts for name in re.findall(r"#include [<\"]([^>\"]+)", text)}
    assert {name for name in names if "/" in name} == (
        {f"weft/{header.name}" for header in headers} - {"weft/weft.h", "weft/c.h"}
        | {"tl/expected.hpp"})
    assert all(re.fullmatch("[a-z_]+(.h)?", name) for name in names if "/" not in name)
    assert len(headers) <= 8
    lines = {header.name: len(text.splitlines()) for header, text in zip(headers, texts)}
    assert lines.pop("c.h") <= 220 and sum(lines.values()) <= 815


def configured_without(packages, folder):
    """The targets of the library's build, on a machine without these packages."""
    absent = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in packages]
    run(CMAKE, "-G", "Ninja", "-S", ROOT, "-B", folder, "-DWEFT_PARTS=library", *absent)
    cache = (folder / "CMakeCache.txt").read_text().lower()
    assert not [name for name in ("grpc", "cairo", "weft_postgres") if name in cache]
    targets = (folder / "build.ninja").read_text()
    assert "-lweft_" not in targets  # of a part that is not built
    return targets


# As CMake finds them; those that pkg-config finds, such as gRPC, are looked for in the cache.
OF_THE_PROGRAMS = ("Protobuf", "PostgreSQL", "SQLite3", "fmt", "spdlog", "CLI11", "prometheus-cpp", "pugixml",
                   "yaml-cpp")


def test_the_library_configures_without_what_only_the_programs_need(tmp_path):
    assert "build weft_c:" in configured_without([*OF_THE_PROGRAMS, "GTest"], tmp_path)


def test_the_tests_of_the_engine_and_the_judge_need_the_library_alone(tmp_path):
    targets = configured_without(OF_THE_PROGRAMS, tmp_path)
    for program in ("size_test", "domain_test", "refine_test", "parallel_test", "c_test", "checker_test"):
        assert f"build {program}:" in targets, program


def test_other_parts_are_refused_by_their_names(tmp_path):
    done = subprocess.run([CMAKE, "-S", ROOT, "-B", tmp_path, "-DWEFT_PARTS=engine"],
                          capture_output=True, text=True, env=CLEAN)
    assert done.returncode != 0
    assert "it must be all, library, server or client" in " ".join(done.stderr.split())
