# SPDX-License-Identifier: Apache-2.0
import importlib

import meshio
import numpy as np
import pytest
import weft
from conftest import KEY, KEY_SIZE
from weft import _optional


@pytest.fixture(scope="module")
def mesh(client):
    return client.mesh(KEY, size=KEY_SIZE)


def test_arrays_have_the_documented_shapes_and_types(mesh):
    n, m, k = mesh.summary.vertices, mesh.summary.triangles, mesh.summary.edges
    for name, shape, dtype in (
            ("points", (n, 2), np.float64), ("triangles", (m, 3), np.int32),
            ("regions", (m,), np.int32), ("edges", (k, 2), np.int32),
            ("edge_markers", (k,), np.int32), ("edge_segments", (k,), np.int32)):
        array = getattr(mesh, name)
        assert (array.shape, array.dtype) == (shape, dtype), name
        assert array.flags.writeable, name
    assert mesh.input_points.shape[1] == 2


def test_input_points_are_where_the_domain_has_them(mesh):
    domain = weft.Domain.read(KEY)
    vertices, points = mesh.input_points.T
    assert np.array_equal(mesh.points[vertices], domain.points[points])


def test_quality_is_that_of_the_server(mesh):
    quality = mesh.quality()
    assert quality.min_angle == pytest.approx(mesh.summary.min_angle_deg, abs=1e-9)
    assert quality.max_angle == pytest.approx(mesh.summary.max_angle_deg, abs=1e-9)
    assert quality.area == pytest.approx(mesh.summary.area)
    assert (quality.areas > 0).all()
    ends = [1.1, 1.25, 1.5, 2, 3, 5, 10, 100]
    histogram = np.histogram(quality.aspects, [0, *ends, np.inf])[0]
    assert np.abs(histogram - mesh.summary.aspect_histogram).sum() <= 2


def test_quality_of_known_triangles():
    quality = weft.quality.quality_of(
        np.array([[0, 0], [1, 0], [0, 1], [0.5, np.sqrt(3) / 2]]), np.array([[0, 1, 2], [0, 1, 3]]))
    assert quality.areas == pytest.approx([0.5, np.sqrt(3) / 4])
    assert quality.min_angles == pytest.approx([45, 60])
    assert quality.max_angles == pytest.approx([90, 60])
    assert quality.aspects[1] == pytest.approx(1)


def test_the_boundary_is_closed_and_has_the_mesh_on_its_left(mesh):
    boundary = mesh.boundary()
    assert np.array_equal(np.sort(boundary[:, 0]), np.sort(boundary[:, 1]))
    (ax, ay), (bx, by) = mesh.points[boundary[:, 0]].T, mesh.points[boundary[:, 1]].T
    assert (ax * by - ay * bx).sum() / 2 == pytest.approx(mesh.summary.area)


def test_a_file_holds_before_the_independent_checker(mesh, run_weft, tmp_path):
    mesh.write(tmp_path / "key.vtu")
    said = run_weft("check", tmp_path / "key.vtu", "--domain", KEY, "--size", KEY_SIZE)
    assert "the mesh holds" in said
    assert [path.name for path in tmp_path.iterdir()] == ["key.vtu"]


@pytest.mark.parametrize("suffix", [".msh", ".vtk", ".obj", ".off", ".ply", ".stl"])
def test_formats_of_meshio_are_read_back(mesh, tmp_path, suffix):
    path = tmp_path / f"key{suffix}"
    mesh.write(path)
    read = meshio.read(path)
    corners = read.points[read.cells_dict["triangle"]][..., :2]  # .stl has no numbers
    assert np.allclose(corners, mesh.points[mesh.triangles], rtol=1e-6)


def test_gmsh_gets_regions_and_markers_as_physical_groups(client, tmp_path):
    square = weft.Domain([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)],
                         markers=[4, 5, 6, 7], regions=[weft.Region(0.5, 0.5, id=8)])
    client.mesh(square, size=0.1).write(tmp_path / "square.msh")
    groups = meshio.read(tmp_path / "square.msh").cell_data_dict["gmsh:physical"]
    assert set(groups["triangle"]) == {8}
    assert set(groups["line"]) == {4, 5, 6, 7}


def test_a_vtu_is_the_one_that_the_command_line_writes(mesh, run_weft, server, tmp_path):
    mesh.write(tmp_path / "python.vtu")
    run_weft("mesh", KEY, "--size", KEY_SIZE, "-o", tmp_path / "weft.vtu", "--quiet",
             "--server", server.target)
    assert (tmp_path / "python.vtu").read_bytes() == (tmp_path / "weft.vtu").read_bytes()


def test_meshio_gets_triangles_lines_regions_and_markers(mesh):
    given = mesh.to_meshio()
    assert np.array_equal(given.cells_dict["triangle"], mesh.triangles)
    assert np.array_equal(given.cells_dict["line"], mesh.edges)
    assert np.array_equal(given.cell_data_dict["region"]["triangle"], mesh.regions)
    assert np.array_equal(given.cell_data_dict["marker"]["line"], mesh.edge_markers)


def test_a_format_that_nobody_knows_is_refused_and_leaves_nothing(mesh, tmp_path):
    with pytest.raises(weft.MeshFileError, match="key.nonsense"):
        mesh.write(tmp_path / "key.nonsense")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("color", [None, "angle", "area", "region", "values"])
def test_a_plot_shows_the_whole_domain(mesh, color):
    axes = mesh.plot(np.arange(len(mesh.triangles)) if color == "values" else color)
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    assert left <= mesh.points[:, 0].min() and mesh.points[:, 0].max() <= right
    assert low <= mesh.points[:, 1].min() and mesh.points[:, 1].max() <= high


def test_a_color_that_is_none_is_refused(mesh):
    with pytest.raises(ValueError, match="'red'; there are angle, area, region"):
        mesh.plot("red")


def test_a_package_that_is_missing_is_named(monkeypatch):
    def absent(name):
        raise ImportError(f"No module named {name!r}")
    monkeypatch.setattr(importlib, "import_module", absent)
    with pytest.raises(weft.MissingPackage, match="python3-matplotlib"):
        _optional.need("matplotlib.pyplot", "Mesh.plot")
