# SPDX-License-Identifier: Apache-2.0
"""Files of all formats that the command line knows, which tells them itself: a new one is tested here
as soon as it is there."""

import copy
import json
import os
import pickle
import re
import subprocess

import meshio
import numpy as np
import pytest
import shapely.geometry
import weft
from conftest import KEY, KEY_SIZE
from weft import _library

ARRAYS = ("points", "triangles", "regions", "edges", "edge_markers")


def extensions(source, target, after):
    """Those that the command line lists after some words of an error."""
    said = subprocess.run([os.environ["WEFT_BINARY"], "convert", source, target],
                          capture_output=True, text=True).stderr
    return re.search(re.escape(after) + r": ([^;\n]*)", said)[1].split(", ")


WRITTEN = extensions("x.vtu", "x.nonsense", "a mesh that is written")
READ = extensions("x.nonsense", "x.vtu", "a mesh that is read as one")
DOMAINS = extensions("x.nonsense", "x.vtu", "that of a domain")


@pytest.fixture(scope="module")
def mesh(client):
    domain = weft.Domain.read(KEY)
    return client.mesh(weft.Domain(domain.points, domain.segments, np.arange(len(domain.segments)) % 5,
                                   domain.holes, [weft.Region(16, 35, id=3)]), size=KEY_SIZE)


@pytest.fixture
def without_weft(monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")


def same_triangles(one, other):
    """Whatever the order of the vertices and of the corners of a triangle."""
    def rows(mesh):
        corners = mesh.points[mesh.triangles]
        return np.unique(np.take_along_axis(
            corners, np.lexsort((corners[..., 1], corners[..., 0]))[..., None], 1).reshape(-1, 6), axis=0)
    return np.array_equal(rows(one), rows(other))


def depth_of(mesh):
    return 10 + 3 * mesh.points[:, 0] + mesh.points[:, 1]


def test_the_command_line_tells_its_formats():
    assert {".vtu", ".stl", ".14"} <= set(WRITTEN)
    assert {".msh", ".ele"} <= set(READ)
    assert {".poly", ".csv"} <= set(DOMAINS)


@pytest.mark.parametrize("suffix", WRITTEN)
def test_a_file_is_the_one_that_the_command_line_writes(mesh, run_weft, tmp_path, suffix):
    mesh.write(tmp_path / "source.npz")
    for name in ("python", "weft"):
        (tmp_path / name).mkdir()
    mesh.write(tmp_path / "python" / f"mesh{suffix}")
    run_weft("convert", tmp_path / "source.npz", tmp_path / "weft" / f"mesh{suffix}")
    def files(folder):
        return {path.relative_to(folder) for path in folder.rglob("*") if path.is_file()}
    wrote = files(tmp_path / "weft")
    assert wrote == files(tmp_path / "python")
    for name in wrote:
        ours, theirs = (tmp_path / folder / name for folder in ("python", "weft"))
        if suffix == ".npz":  # another zip archive of the same arrays
            ours, theirs = np.load(ours), np.load(theirs)
            assert set(ours.files) == set(theirs.files)
            assert all(np.array_equal(ours[array], theirs[array]) for array in ours.files)
        else:
            assert ours.read_bytes() == theirs.read_bytes()


@pytest.mark.parametrize("suffix", READ)
def test_a_mesh_is_what_the_command_line_reads(mesh, run_weft, tmp_path, suffix):
    mesh.write(tmp_path / ("mesh.node" if suffix == ".ele" else f"mesh{suffix}"))
    read = weft.Mesh.read(tmp_path / f"mesh{suffix}")
    assert same_triangles(read, mesh)
    run_weft("convert", tmp_path / f"mesh{suffix}", tmp_path / "again.npz")
    arrays = np.load(tmp_path / "again.npz")
    for name in ARRAYS:
        assert np.array_equal(getattr(read, name), arrays[name]), name
        assert getattr(read, name).dtype == getattr(mesh, name).dtype, name
    assert read.summary.area == pytest.approx(mesh.summary.area)
    assert read.summary.min_angle_deg == pytest.approx(mesh.summary.min_angle_deg)
    assert (read.digest, len(read.edge_segments), len(read.input_points)) == ("", 0, 0)


SQUARE = shapely.geometry.Polygon([(0, 0), (4, 0), (4, 4), (0, 4)], [[(1, 1), (2, 1), (2, 2), (1, 2)]])


def write_shapefile(path):
    shapefile = pytest.importorskip("shapefile")
    with shapefile.Writer(str(path), shapeType=shapefile.POLYGON) as file:
        file.field("marker", "N")
        file.poly([list(SQUARE.exterior.coords)[::-1], list(SQUARE.interiors[0].coords)])
        file.record(5)


def write_csv(path):
    path.write_text("x,y\n0,0\n4,0\n4,4\n0,4\n\n1,1\n2,1\n2,2\n1,2\n")


def write_poly(path):
    path.write_text("8 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 1 1\n6 2 1\n7 2 2\n8 1 2\n8 0\n1 1 2\n2 2 3\n"
                    "3 3 4\n4 4 1\n5 5 6\n6 6 7\n7 7 8\n8 8 5\n1\n1 1.5 1.5\n")


def write_geojson(path):
    path.write_text(json.dumps(shapely.geometry.mapping(SQUARE)))


WRITE_DOMAIN = {".poly": write_poly, ".geojson": write_geojson, ".json": write_geojson,
                ".wkt": lambda path: path.write_text(SQUARE.wkt), ".shp": write_shapefile,
                ".csv": write_csv}


def write_by_gdal(path):
    gdal = pytest.importorskip("osgeo.gdal")
    write_geojson(path.with_name("source.geojson"))
    if gdal.VectorTranslate(str(path), str(path.with_name("source.geojson"))) is None:
        pytest.skip(f"this GDAL does not write {path.suffix}")


@pytest.mark.parametrize("suffix", DOMAINS)
def test_a_domain_is_read_of_every_format(client, tmp_path, suffix):
    WRITE_DOMAIN.get(suffix, write_by_gdal)(tmp_path / f"square{suffix}")
    assert client.mesh(tmp_path / f"square{suffix}").summary.area == pytest.approx(15)


@pytest.mark.parametrize("suffix", [".POLY", ".GeoJSON", ".WKT"])
def test_an_extension_may_be_in_capitals(client, tmp_path, suffix):
    WRITE_DOMAIN[suffix.lower()](tmp_path / f"square{suffix}")
    assert client.mesh(tmp_path / f"square{suffix}").summary.area == pytest.approx(15)


@pytest.mark.parametrize("suffix", READ)
def test_a_mesh_is_read_as_a_domain(client, mesh, tmp_path, suffix):
    mesh.write(tmp_path / ("mesh.node" if suffix == ".ele" else f"mesh{suffix}"))
    assert client.mesh(tmp_path / f"mesh{suffix}").summary.area == pytest.approx(mesh.summary.area)


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".npz", ".14"])
def test_values_go_there_and_back(mesh, tmp_path, suffix):
    depth = depth_of(mesh)
    mesh.write(tmp_path / f"mesh{suffix}", nodal={"depth": depth})
    read = weft.Mesh.read(tmp_path / f"mesh{suffix}")
    assert list(read.values) == ["depth"]
    assert np.array_equal(read.values["depth"], depth)
    assert "values depth" in repr(read)
    read.write(tmp_path / f"again{suffix}")  # those that it has
    assert np.array_equal(weft.Mesh.read(tmp_path / f"again{suffix}").values["depth"], depth)


def test_values_follow_their_vertices_to_new_numbers(mesh, tmp_path):
    mesh.write(tmp_path / "mesh.npz", nodal={"depth": depth_of(mesh), "manning": 0.02}, renumber="rcm")
    read = weft.Mesh.read(tmp_path / "mesh.npz")
    assert not np.array_equal(read.points, mesh.points)
    assert np.array_equal(read.values["depth"], depth_of(read))
    assert (read.values["manning"] == 0.02).all()


def test_values_are_taken_from_a_raster_where_it_has_some(mesh, tmp_path):
    (tmp_path / "bed.asc").write_text("ncols 2\nnrows 2\nxllcorner -100\nyllcorner -100\ncellsize 200\n"
                                      "7 7\n7 7\n")
    mesh.write(tmp_path / "mesh.14", nodal={"depth": tmp_path / "bed.asc"})
    assert (weft.Mesh.read(tmp_path / "mesh.14").values["depth"] == 7).all()


def test_order_2_has_the_nodes_of_the_sides(mesh, tmp_path):
    mesh.write(tmp_path / "mesh.vtu", 2)
    cells = meshio.read(tmp_path / "mesh.vtu").cells_dict
    assert cells["triangle6"].shape == (len(mesh.triangles), 6)


def test_parts_are_of_about_the_same_size(mesh, tmp_path):
    mesh.write(tmp_path / "mesh.npz", parts=3)
    counts = np.bincount(np.load(tmp_path / "mesh.npz")["parts"])
    assert len(counts) == 3 and counts.min() > 0.9 * counts.max()


def test_parts_come_back_and_stay(mesh, tmp_path):
    assert mesh.parts.shape == (0,)
    mesh.write(tmp_path / "mesh.npz", parts=3)
    divided = weft.Mesh.read(tmp_path / "mesh.npz")
    assert divided.parts.dtype == np.int32
    assert np.array_equal(divided.parts, np.load(tmp_path / "mesh.npz")["parts"])
    divided.write(tmp_path / "again.npz")
    assert np.array_equal(weft.Mesh.read(tmp_path / "again.npz").parts, divided.parts)
    divided.write(tmp_path / "two.npz", parts=2)
    assert set(weft.Mesh.read(tmp_path / "two.npz").parts) == {0, 1}
    for name in ("mesh.vtu", "mesh.nc"):
        divided.write(tmp_path / name)
        assert np.array_equal(weft.Mesh.read(tmp_path / name).parts, divided.parts)
    with pytest.warns(weft.WeftWarning, match="mesh.su2: the format does not carry the parts"):
        divided.write(tmp_path / "mesh.su2")


@pytest.mark.parametrize("parts, words", [([0, 1], "parts: 2 for"), ([0.5], "parts: float64")])
def test_parts_that_are_none_are_refused(mesh, tmp_path, parts, words):
    np.savez(tmp_path / "mesh.npz", points=mesh.points, triangles=mesh.triangles,
             parts=np.array(parts))
    with pytest.raises(weft.MeshFileError, match=words):
        weft.Mesh.read(tmp_path / "mesh.npz")


def test_options_of_a_format_are_those_of_the_command_line(mesh, tmp_path):
    mesh.write(tmp_path / "mesh.msh", msh_version="2.2")
    assert (tmp_path / "mesh.msh").read_bytes().startswith(b"$MeshFormat\n2.2 0 8")
    mesh.write(tmp_path / "land.14")
    mesh.write(tmp_path / "mesh.14", open_boundary=[2, 3])
    assert (tmp_path / "land.14").read_bytes() != (tmp_path / "mesh.14").read_bytes()
    with pytest.raises(weft.MeshFileError, match="second order"):
        mesh.write(tmp_path / "mesh.obj", order=2)


def test_an_open_boundary_is_a_number_of_any_type(mesh, tmp_path):
    mesh.write(tmp_path / "one.14", open_boundary=2)
    mesh.write(tmp_path / "two.14", open_boundary=np.int32(2))
    assert (tmp_path / "one.14").read_text() == (tmp_path / "two.14").read_text()


def test_an_open_boundary_is_what_is_deep(mesh, tmp_path):
    mesh.write(tmp_path / "all.14", nodal={"depth": 60}, open_boundary="deeper:50")
    assert "\n1 = Number of open boundaries\n" in (tmp_path / "all.14").read_text()
    with pytest.raises(weft.MeshFileError, match="needs the depths at the vertices"):
        mesh.write(tmp_path / "none.14", open_boundary=["deeper:50"])


def test_what_a_format_does_not_carry_is_warned_of_at_the_line_of_the_user(mesh, tmp_path):
    with pytest.warns(weft.WeftWarning, match="mesh.obj: .*not carry these values.*depth") as caught:
        mesh.write(tmp_path / "mesh.obj", nodal={"depth": depth_of(mesh)})
    assert caught[0].filename == __file__


@pytest.mark.parametrize("nodal, words", [
    ({"depth": [1, 2, 3]}, r"depth has the shape \(3,\), expected"),
    ({"depth": float("nan")}, "depth is nan at vertex 0"),
    ({"points": 1}, "points is an array of the mesh itself"),
])
def test_values_that_are_none_are_refused(mesh, tmp_path, nodal, words):
    with pytest.raises(ValueError, match=words):
        mesh.write(tmp_path / "mesh.vtu", nodal=nodal)
    assert not list(tmp_path.iterdir())


def test_a_raster_that_is_missing_is_named(mesh, tmp_path):
    with pytest.raises(weft.MeshFileError, match="no.tif"):
        mesh.write(tmp_path / "mesh.vtu", nodal={"depth": tmp_path / "no.tif"})


def test_without_the_program_an_error_says_that_it_is_needed(mesh, tmp_path, without_weft):
    with pytest.raises(weft.MeshFileError, match="needs the program weft"):
        weft.Mesh.read(tmp_path / "a.msh")
    with pytest.raises(weft.MeshFileError, match="needs the program weft"):
        mesh.write(tmp_path / "a.vtu", order=2)


def test_domains_are_read_by_the_library_or_the_program(mesh, tmp_path, without_weft, monkeypatch):
    (tmp_path / "a.wkt").write_text(SQUARE.wkt)
    assert len(weft.Domain.read(tmp_path / "a.wkt").points) == 8
    mesh.write(tmp_path / "mesh.vtu")
    assert len(weft.Domain.read(tmp_path / "mesh.vtu").segments)

    def missing():
        raise weft.MissingPackage("no library")
    monkeypatch.setattr(_library, "_library", missing)
    with pytest.raises(weft.DomainError, match="needs the program weft"):
        weft.Domain.read(tmp_path / "a.wkt")


def test_without_the_program_npz_vtu_and_formats_of_meshio_are_there(mesh, tmp_path, without_weft):
    for suffix in (".npz", ".vtu", ".vtk", ".obj"):
        mesh.write(tmp_path / f"mesh{suffix}")
        if suffix != ".npz":
            assert len(meshio.read(tmp_path / f"mesh{suffix}").points) == len(mesh.points)
    read = weft.Mesh.read(tmp_path / "mesh.npz")
    for name in ARRAYS:
        assert np.array_equal(getattr(read, name), getattr(mesh, name)), name


@pytest.mark.parametrize("arrays, words", [
    ({"points": np.zeros((3, 2))}, "holds no array 'triangles'"),
    ({"points": np.zeros((3, 2)), "triangles": [[0, 1, 3]]}, "triangles name vertices .* 3"),
    ({"points": np.zeros((3, 2)), "triangles": [[0, 1, -1]]}, "triangles name vertices"),
    ({"points": np.zeros((3, 4)), "triangles": [[0, 1, 2]]}, r"points: an array \(3, 4\)"),
    ({"points": np.full((3, 2), np.nan), "triangles": [[0, 1, 2]]}, "points are not finite"),
    ({"points": np.zeros((3, 2)), "triangles": [[0, 1, 2]], "regions": [1, 2]}, "regions: 2 for 1"),
    ({"points": np.zeros((3, 2)), "triangles": [[0, 1, 0.5]]}, "triangles: float64 does not fit"),
])
def test_an_archive_that_is_no_mesh_is_refused_by_name(tmp_path, arrays, words):
    np.savez(tmp_path / "bad.npz", **arrays)
    with pytest.raises(weft.MeshFileError, match=f"bad.npz: {words}"):
        weft.Mesh.read(tmp_path / "bad.npz")


def test_an_archive_of_records_is_refused_by_name(tmp_path):
    np.savez(tmp_path / "bad.npz", points=np.zeros((3, 2)), triangles=np.zeros((1, 3), "i4,f8"))
    with pytest.raises(weft.MeshFileError, match="bad.npz: triangles: .* does not fit int32"):
        weft.Mesh.read(tmp_path / "bad.npz")


@pytest.mark.parametrize("name", ["bad.npz", "bad.vtu", "bad.msh", "bad.nonsense"])
def test_a_file_that_is_no_mesh_is_refused_by_name(tmp_path, name):
    (tmp_path / name).write_bytes(b"nonsense")
    with pytest.raises(weft.MeshFileError, match=name):
        weft.Mesh.read(tmp_path / name)


@pytest.mark.parametrize("read", [weft.Mesh.read, weft.Domain.read])
@pytest.mark.parametrize("name", ["no.obj", "no.msh"])
def test_a_file_that_is_missing_is_an_os_error(tmp_path, read, name):
    with pytest.raises(FileNotFoundError):
        read(tmp_path / name)


def test_triangles_of_an_archive_are_turned_counter_clockwise(tmp_path):
    np.savez(tmp_path / "turned.npz", points=[[0., 0], [1, 0], [0, 1]], triangles=[[0, 2, 1]])
    assert weft.Mesh.read(tmp_path / "turned.npz").quality().area == 0.5


@pytest.mark.parametrize("twin", [copy.copy, copy.deepcopy,
                                  lambda mesh: pickle.loads(pickle.dumps(mesh))])
def test_a_copy_is_the_same_mesh(mesh, tmp_path, twin):
    other = twin(mesh)
    assert all(np.array_equal(getattr(other, name), getattr(mesh, name)) for name in ARRAYS)
    assert (other.digest, repr(other)) == (mesh.digest, repr(mesh))
