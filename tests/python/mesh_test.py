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


@pytest.mark.parametrize("color", [None, "angle", "size", "area", "region", "values"])
def test_a_plot_shows_the_whole_domain(mesh, color):
    axes = mesh.plot(np.arange(len(mesh.triangles)) if color == "values" else color)
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    assert left <= mesh.points[:, 0].min() and mesh.points[:, 0].max() <= right
    assert low <= mesh.points[:, 1].min() and mesh.points[:, 1].max() <= high


def test_a_color_that_is_none_is_refused(mesh):
    with pytest.raises(ValueError, match="'red'; there are angle, size, area, region"):
        mesh.plot("red")


def test_a_package_that_is_missing_is_named(monkeypatch):
    def absent(name):
        raise ImportError(f"No module named {name!r}")
    monkeypatch.setattr(importlib, "import_module", absent)
    with pytest.raises(weft.MissingPackage, match="python3-matplotlib"):
        _optional.need("matplotlib.pyplot", "Mesh.plot")


def grid_mesh(columns, rows):
    """Of two triangles per unit square."""
    x, y = np.meshgrid(np.arange(columns + 1.), np.arange(rows + 1.))
    a = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    b, c, d = a + 1, a + columns + 2, a + columns + 1
    triangles = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])]).astype(np.int32)
    points = np.column_stack([x.ravel(), y.ravel()])
    none = np.zeros(0, np.int32)
    return weft.Mesh(points, triangles, np.zeros(len(triangles), np.int32), none.reshape(0, 2), none, none,
                     none.reshape(0, 2), weft.results.summary_of(points, triangles, 0))


def test_a_million_triangles_are_drawn_as_their_means_per_pixel():
    mesh = grid_mesh(1000, 500)
    assert len(mesh.triangles) == 1_000_000
    upper = np.arange(1_000_000) >= 500_000  # of the two in a square, which is a pixel
    column = mesh.points[mesh.triangles].min(axis=1)[:, 0]
    axes = mesh.plot(column + np.where(upper, 0.5, 0))
    picture, = axes.images
    values = picture.get_array()
    assert values.shape == (500, 1000)
    assert np.allclose(values, np.arange(1000) + 0.25, atol=0.1)
    assert not axes.collections[0].get_paths()  # no triangle on its own


def test_pixels_beside_the_mesh_are_empty_and_large_triangles_fill_theirs():
    points = np.array([[0, 0], [4, 0], [4, 4], [0, 4]], float)
    corners = points[[[0, 1, 2], [0, 2, 3]]]
    image = weft._pixels.image(corners, np.array([1., 3]), (0, 0, 8, 4), 80, True)
    assert image.shape == (40, 80)
    assert np.isnan(image[:, 40:]).all() and not np.isnan(image[:, :40]).any()
    assert image[5, 30] == pytest.approx(1) and image[30, 5] == pytest.approx(3)
    assert image[20, 20] == pytest.approx(2, abs=0.3)  # half of each


def test_few_triangles_of_a_large_mesh_are_drawn_one_by_one_in_their_box():
    axes = grid_mesh(300, 300).plot("size", box=(10, 10, 20, 15), segments=False)
    assert not axes.images
    assert axes.get_xlim() == (10, 20) and axes.get_ylim() == (10, 15)
    assert 100 <= len(axes.collections[0].get_array()) <= 200


def test_sizes_have_a_logarithmic_scale(mesh):
    drawn = mesh.plot("size").collections[0]
    assert type(drawn.norm).__name__ == "LogNorm"
    assert np.exp(np.log(drawn.get_array()).mean()) == pytest.approx(
        np.sqrt(np.exp(np.log(mesh.quality().areas).mean()) * 4 / np.sqrt(3)))


def test_a_notebook_gets_a_picture(mesh, monkeypatch):
    assert mesh._repr_png_().startswith(b"\x89PNG")
    monkeypatch.setattr(weft._mesh, "need", lambda *_: (_ for _ in ()).throw(weft.MissingPackage("no")))
    assert mesh._repr_png_() is None


def test_files_of_triangle_are_none_of_meshio(mesh, tmp_path):
    mesh.write(tmp_path / "mesh.node")
    before = (tmp_path / "mesh.ele").read_text()
    with pytest.raises(weft.MeshFileError, match="the extension '.ele' is not that of"):
        mesh.write(tmp_path / "mesh.ele")
    assert (tmp_path / "mesh.ele").read_text() == before
