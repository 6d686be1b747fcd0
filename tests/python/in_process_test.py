# SPDX-License-Identifier: Apache-2.0
"""weft.mesh, which meshes in this process, beside Client.mesh of a real server."""

import ctypes
import dataclasses
import gc
import os
import pathlib
import re
import shutil
import subprocess
import sys
import threading
import warnings

import numpy as np
import pytest
import weft
from conftest import KEY, KEY_SIZE, MODELS
from weft import _library

SOURCE = pathlib.Path(os.environ["WEFT_SOURCE"])
SQUARE = weft.Domain(points=[[0, 0], [8, 0], [8, 8], [0, 8], [2, 4], [6, 4]],
                     segments=[[0, 1], [1, 2], [2, 3], [3, 0], [4, 5]], markers=[1, 1, 1, 1, 7],
                     marker_names={7: "wall"})
SAMPLES = [MODELS / name for name in ("cylinder.poly", "key.poly", "pipe.poly", "us-east-coast.geojson")] + [
    SOURCE / "tests/domain_files" / name
    for name in ("features.geojson", "fractions.poly", "fortran.poly")]
DEPTHS = weft.raster([[1.0, 2.0], [4.0, np.nan]], origin=(0, 0), spacing=(8, 8))
AREAS = {"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"region": region, "max_edge": edge}, "geometry": {
        "type": "Polygon", "coordinates": [[[x, 0], [x + 2, 0], [x + 2, 2], [x, 2], [x, 0]]]}}
    for region, edge, x in ((1, 0.5, 0), (2, 0.2, 1))]}


def expect_same(client, *arguments, **options):
    """The mesh of both."""
    with warnings.catch_warnings(record=True) as here:
        warnings.simplefilter("always")
        mesh = weft.mesh(*arguments, **options)
    with warnings.catch_warnings(record=True) as there:
        warnings.simplefilter("always")
        served = client.mesh(*arguments, **options)
    assert [str(w.message) for w in here] == [str(w.message) for w in there]
    assert mesh.digest == served.digest
    for field in dataclasses.fields(weft.Mesh):
        ours, theirs = getattr(mesh, field.name), getattr(served, field.name)
        if isinstance(theirs, np.ndarray):
            assert ours.dtype == theirs.dtype and np.array_equal(ours, theirs), field.name
        elif field.name != "summary":
            assert ours == theirs, field.name
    of_the_run = {"timings", "threads", "cached", "peak_engine_bytes", "exact_predicates"}
    for field in dataclasses.fields(weft.Summary):
        ours, theirs = getattr(mesh.summary, field.name), getattr(served.summary, field.name)
        if field.name not in of_the_run:
            assert np.array_equal(ours, theirs), (field.name, ours, theirs)
    return mesh


def test_a_simplified_domain_has_the_mesh_that_a_server_makes(client):
    made = expect_same(client, KEY, edge=12, simplify=0.5, min_angle=15).summary.simplification
    assert made.points > 0 and made.farthest > 0
    assert weft.mesh(KEY, edge=12, min_angle=15).summary.simplification is None


def test_the_places_of_cut_channels_are_in_the_coordinates_of_the_domain(client):
    coast = weft.Domain.read(MODELS / "us-east-coast.geojson")
    made = expect_same(client, coast, edge=40_000, lonlat=True, simplify=0.5, min_edge=5_000).summary.simplification
    west, south, east, north = coast.box()
    assert len(made.cuts) == made.channels > 5
    assert all(west < x < east and south < y < north for x, y in made.cuts)


@pytest.mark.parametrize("path", SAMPLES, ids=lambda path: path.name)
def test_samples_have_the_mesh_that_a_server_makes(client, path):
    box = weft.Domain.read(path).box()
    expect_same(client, path, edge=max(box[2] - box[0], box[3] - box[1]) / 50)
    expect_same(client, path, min_angle=30)


@pytest.mark.parametrize("options", [
    {"size": KEY_SIZE},
    {"size": lambda x, y: 0.1 + 0.01 * x},
    {"size": weft.Raster([[1, 2], [3, 1]], (0, 0), (46, 46))},
    {"edge": 2, "placement": "circumcentre", "optimise": 3, "min_edge": 0.1},
    {"size": 1, "max_triangles": 200},
    {"edge": "0.5 + 0.1*coast", "fields": {"coast": weft.distance()}, "gradation": 0.2},
    {"edge": "1 + w/9", "fields": {"w": weft.width()}, "cells_across": 4, "points_per_circle": 20, "gradation": 0.3,
     "gradation_within": True},
    {"size": 1e9, "fields": {"p": weft.distance(points=[[1, 2]])}},
    {"edge": 0.4, "quadtree": True, "threads": 2},
], ids=str)
def test_options_are_those_of_a_server(client, options):
    expect_same(client, KEY, **options)


@pytest.mark.parametrize("options", [
    {"edge": 2, "edge_at": {"wall": 0.1}, "gradation": 0.5},
    {"edge": "coalesce(depth, 3)", "fields": {"depth": DEPTHS}},
    {"size": "0.1 + d", "fields": {"d": weft.distance(points=[[1, 1], [7, 7]], segments=[[0, 1]])}},
    {"snap": 0.5, "size": 3},
], ids=str)
def test_markers_and_fields_are_those_of_a_server(client, options):
    expect_same(client, SQUARE, **options)


def test_regions_areas_and_names_are_those_of_a_server(client):
    mesh = expect_same(client, AREAS)
    assert set(mesh.regions) == {1, 2}


def test_a_mesh_of_an_earlier_mesh_is_that_of_a_server(client):
    coarse = weft.mesh(SQUARE, edge=1)
    field = weft.on_mesh(coarse, 0.2 + 0.1 * coarse.points[:, 0])
    expect_same(client, SQUARE, edge="h", fields={"h": field})


def test_a_domain_in_longitude_and_latitude_is_that_of_a_server(client):
    expect_same(client, MODELS / "us-east-coast.geojson", edge=40_000, lonlat=True)


@pytest.mark.parametrize("domain, options", [
    (KEY, {"size": "x +"}), (KEY, {"size": "1/(y-y)"}), (KEY, {"size": 0}), (KEY, {"size": "-1"}),
    (KEY, {"min_angle": 37}), (KEY, {"optimise": 17}), (KEY, {"min_edge": -1}),
    (KEY, {"size": 1, "gradation": -1}), (KEY, {"edge_at": {99: 1}}), (KEY, {"edge_at": {1: 0}}),
    (KEY, {"size": "d", "fields": {"d": weft.distance(marker=77)}}),
    (KEY, {"size": "(x-20)^2"}), (KEY, {"max_seconds": 1e-9, "size": 1e-4, "no_cache": True}),
    (weft.Domain(points=[[0, 0], [1, 1], [2, 2]], segments=[[0, 1], [1, 2]]), {}),
    (weft.Domain(points=[[0, 0], [1, 0], [0, 1]], segments=[[0, 1], [1, 2], [2, 0]], holes=[[5, 5]]), {}),
], ids=str)
def test_errors_are_those_of_a_server(client, domain, options):
    with pytest.raises(weft.ServerError) as here:
        weft.mesh(domain, **options)
    with pytest.raises(weft.ServerError) as there:
        client.mesh(domain, **options)
    ours, theirs = here.value, there.value
    assert type(ours) is type(theirs)
    assert (ours.code, ours.reason, ours.violations) == (theirs.code, theirs.reason, theirs.violations)
    if ours.reason != "DEADLINE_EXCEEDED":  # a server says how long it worked
        assert ours.detail == theirs.detail


def test_what_no_server_is_asked_for_is_refused_the_same_way():
    with pytest.raises(TypeError, match="unknown option 'minangle'"):
        weft.mesh(KEY, minangle=3)
    with pytest.raises(ValueError, match="exclude each other"):
        weft.mesh(KEY, size=1, edge=1)


@pytest.mark.parametrize("options", [
    {"size": 1e-5}, {"size": "1e-5 + 0*d", "fields": {"d": weft.distance()}},  # seems to be a small mesh
], ids=str)
def test_progress_is_told_and_what_it_raises_ends_the_work(options):
    seen = []

    def stop(progress):
        seen.append(progress)
        raise KeyError("enough")
    with pytest.raises(KeyError, match="enough"):
        weft.mesh(KEY, **options, on_progress=stop)
    assert len(seen) == 1 and seen[0].stage in ("queued", "triangulate", "size", "refine")


def test_other_threads_go_on_meanwhile():
    """They make meshes of their own."""
    digests = []
    threads = [threading.Thread(target=lambda: digests.append(weft.mesh(KEY, KEY_SIZE).digest))
               for _ in range(4)]
    counted = 0
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        counted += 1
    assert len(set(digests)) == 1 and len(digests) == 4 and counted > 0


def resident():
    return int(re.search(r"VmRSS:\s+(\d+) kB", pathlib.Path("/proc/self/status").read_text())[1]) * 1024


def test_ten_thousand_meshes_leave_no_memory_behind():
    """A leak of the arrays alone would be 40 kB for each."""
    domain = weft.Domain.read(KEY)

    def make(count):
        for _ in range(count):
            weft.mesh(domain, 20)
        gc.collect()
        return resident()
    before = make(1000)
    assert make(10_000) < before + 40e6


def printed_by_package_in(folder):
    """What is printed if the package there makes a mesh, with no help from the environment."""
    done = subprocess.run([sys.executable, "-B", "-c",
                           "import weft\n"
                           "try: print(len(weft.mesh(weft.Domain(points=[[0,0],[1,0],[0,1]],"
                           " segments=[[0,1],[1,2],[2,0]])).triangles))\n"
                           "except weft.MissingPackage as error: print(error)"],
                          capture_output=True, text=True, check=True,
                          env={"PATH": "/usr/bin:/bin", "PYTHONPATH": str(folder)})
    return done.stdout


def test_the_package_of_the_build_finds_its_library():
    assert int(printed_by_package_in(pathlib.Path(weft.__file__).parents[1])) >= 1


def test_without_a_library_it_says_what_to_do(tmp_path):
    shutil.copytree(pathlib.Path(weft.__file__).parent, tmp_path / "weft",
                    ignore=shutil.ignore_patterns("carried"))
    printed = printed_by_package_in(tmp_path)
    assert "libweft.so.0" in printed and "weft.local()" in printed, printed


def test_structures_are_those_of_the_header(tmp_path):
    names = {"weft_progress": _library.Progress, "weft_arrays": _library.Arrays}
    lines = ["#include <stdio.h>", "#include <weft/c.h>", "int main(void) {"]
    expected = []
    for name, kind in names.items():
        lines.append(f'printf("{name} %zu\\n", sizeof({name}));')
        expected.append(f"{name} {ctypes.sizeof(kind)}")
        for field, *_ in kind._fields_:
            lines.append(f'printf("{name}.{field} %zu\\n", offsetof({name}, {field}));')
            expected.append(f"{name}.{field} {getattr(kind, field).offset}")
    (tmp_path / "offsets.c").write_text("\n".join([*lines, "return 0; }"]))
    subprocess.run(["cc", "-I", SOURCE / "include", tmp_path / "offsets.c", "-o", tmp_path / "offsets"],
                   check=True)
    printed = subprocess.run([tmp_path / "offsets"], check=True, capture_output=True, text=True).stdout
    assert printed.splitlines() == expected


@pytest.mark.parametrize("spoil", [lambda m: m[:-1], lambda m: m[:len(m) // 2], lambda m: b"\xff" * 9, lambda m: b""],
                         ids=["one byte less", "half", "no message", "nothing"])
def test_bytes_that_are_no_request_are_an_error(spoil):
    """As a message that only serializes to them."""
    from weft import _requests
    message = _requests.mesh_request(SQUARE, 1, 20, {})

    class Spoilt:
        def SerializeToString(self):
            return spoil(message.SerializeToString())
    with pytest.raises(weft.InvalidRequest) as caught:
        _library.make(Spoilt(), None)
    assert caught.value.reason in ("MALFORMED_REQUEST", "BAD_OPTION")


FORK = """
import multiprocessing, weft

def triangles(size):
    square = weft.Domain(points=[(0, 0), (1, 0), (1, 1), (0, 1)], segments=[(0, 1), (1, 2), (2, 3), (3, 0)])
    return len(weft.mesh(square, size=size, threads=2).triangles)

if __name__ == "__main__":
    alone = triangles(5e-6)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        found = pool.map_async(triangles, [5e-6] * 4).get(250)
    print(alone > 100_000 and found == [alone] * 4)
"""


def test_processes_that_fork_makes_mesh_too():
    done = subprocess.run([sys.executable, "-c", FORK], capture_output=True, text=True, timeout=280)
    assert done.stdout == "True\n", done.stderr


def test_segments_outside_of_the_mesh_are_a_warning_with_a_server_and_without(client):
    domain = weft.Domain([(0, 0), (9, 0), (9, 9), (0, 9), (0, 0.001), (3, 3), (6, 3), (6, 6), (3, 6)],
                         [(0, 1), (1, 2), (2, 3), (3, 4), (5, 6), (6, 7), (7, 8), (8, 5)])
    for make in (weft.mesh, client.mesh):
        with pytest.warns(weft.WeftWarning) as warned:
            mesh = make(domain, size=1)
        assert [str(warning.message) for warning in warned] == [
            "4 segments lie outside of what is meshed, the first is segments[0]"]
        assert mesh.summary.outside == weft.OutsideSegments(4, 0, 0.0, 0.0)
        assert make(domain, size=1, snap=0.002).summary.outside is None
