# SPDX-License-Identifier: Apache-2.0
"""What of a mesh solvers take: groups by name, second order, meshio, scikit-fem. tests/python/solve.py solves
with FEniCSx, FreeFem++ and CalculiX."""

import sys
import types
import warnings

import numpy as np
import pytest
import weft


@pytest.fixture(scope="module")
def mesh(client):
    domain = weft.Domain(
        [(0, 0), (2, 0), (2, 1), (0, 1), (1, 0), (1, 1)], [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5)],
        markers=[2, 3, 2, -1, 0], regions=[weft.Region(0.5, 0.5, id=1), weft.Region(1.5, 0.5, id=7)],
        marker_names={-1: "inlet", 2: "wall", 9: "spare"}, region_names={1: "fluid"})
    return client.mesh(domain, size=0.01)


def test_boundaries_are_edges_by_name_or_number(mesh):
    assert list(mesh.boundaries) == ["inlet", 0, "wall", 3, "spare"] and len(mesh.boundaries) == 5
    for key, other, (axis, at) in (("inlet", -1, (0, 0)), (3, 3, (0, 2)), (0, 0, (0, 1))):
        edges = mesh.boundaries[key]
        assert np.array_equal(edges, mesh.boundaries[other]) and edges.dtype == np.int32
        ends = mesh.points[edges]
        assert (ends[..., axis] == at).all()
        assert np.abs(ends[:, 0, 1] - ends[:, 1, 1]).sum() == pytest.approx(1)
    assert mesh.boundaries["spare"].shape == (0, 2)
    assert mesh.boundaries.number("wall") == 2
    assert sum(map(len, mesh.boundaries.values())) == len(mesh.edges)


def test_subdomains_are_triangles_by_name_or_number(mesh):
    assert list(mesh.subdomains) == ["fluid", 7]
    for key, left in (("fluid", True), (1, True), (7, False)):
        triangles = mesh.subdomains[key]
        centroids = mesh.points[mesh.triangles[triangles]].mean(axis=1)
        assert ((centroids[:, 0] < 1) == left).all()
    assert len(mesh.subdomains["fluid"]) + len(mesh.subdomains[7]) == len(mesh.triangles)


def test_a_group_that_is_not_there_is_named_with_those_that_are(mesh):
    for groups, key in ((mesh.boundaries, "inlett"), (mesh.boundaries, 8), (mesh.subdomains, "wall")):
        with pytest.raises(KeyError, match=f"there is no (marker|region) {key!r}; there are '"):
            groups[key]
        assert key not in groups
    assert mesh.boundaries.get("inlett") is None


def test_second_order_is_that_of_files(mesh, tmp_path, run_weft):
    import meshio
    points, triangles = mesh.second_order()
    assert triangles.shape == (len(mesh.triangles), 6) and triangles.dtype == np.int32
    mesh.write(tmp_path / "mesh.msh", order=2)
    read = meshio.read(tmp_path / "mesh.msh")
    nodes = np.concatenate([cells.data for cells in read.cells if cells.type == "triangle6"])
    by_region = np.concatenate([triangles[numbers] for numbers in mesh.subdomains.values()])
    assert np.array_equal(read.points[nodes][..., :2], points[by_region])
    assert len(points) == len(read.points)


def test_meshio_has_the_names_with_their_numbers_and_dimensions(mesh):
    data = {name: values.tolist() for name, values in mesh.to_meshio().field_data.items()}
    assert data == {"inlet": [-1, 1], "wall": [2, 1], "spare": [9, 1], "fluid": [1, 2]}


def test_a_name_that_a_marker_and_a_region_share_is_the_regions(client):
    square = weft.Domain([(0, 0), (1, 0), (1, 1)], [(0, 1), (1, 2), (2, 0)], markers=[4, 4, 4],
                         regions=[weft.Region(0.7, 0.3, id=5)], marker_names={4: "rock"}, region_names={5: "rock"})
    with pytest.warns(weft.WeftWarning, match="the marker 4 has no name: 'rock' is that of a region"):
        assert client.mesh(square).to_meshio().field_data["rock"].tolist() == [5, 2]


@pytest.mark.parametrize("by, told", [("weft", "the format does not carry these names: marker -1 'inlet'"),
                                      ("meshio", "names of markers and regions are not written")])
def test_medit_files_are_plane_and_have_markers_and_regions_as_references(mesh, tmp_path, monkeypatch, by, told):
    if by == "meshio":
        monkeypatch.setenv("PATH", "")
    with pytest.warns(weft.WeftWarning, match=told):
        mesh.write(tmp_path / "mesh.mesh")
    words = (tmp_path / "mesh.mesh").read_text().split()
    assert words[words.index("Dimension") + 1] == "2"
    for section, cells, references in (("Triangles", mesh.triangles, mesh.regions),
                                       ("Edges", mesh.edges, mesh.edge_markers)):
        first = words.index(section) + 1
        count, width = int(words[first]), cells.shape[1] + 1
        rows = np.array(words[first + 1:first + 1 + count * width], int).reshape(count, width)
        assert np.array_equal(rows, np.column_stack([cells + 1, references]))


def test_netgen_and_mfem_have_names(mesh, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for suffix in (".vol", ".mfem"):
            mesh.write(tmp_path / f"mesh{suffix}")
    netgen = (tmp_path / "mesh.vol").read_text()
    assert "bcnames\n5\n1 inlet\n2 marker_0\n3 wall\n4 marker_3\n5 spare\n" in netgen
    assert "materials\n2\n1 fluid\n2 region_7\n" in netgen
    sets = (tmp_path / "mesh.mfem").read_text().split("bdr_attribute_sets\n")[1]
    assert sets.startswith('2\n"inlet"\n1\n1\n"wall"\n1\n2\n')


class MeshTri:
    """What of skfem.MeshTri `to_skfem` uses, by its definition (scikit-fem 8, skfem/mesh): `p` (2, n) and `t` (3, m),
    both contiguous, the corners of each triangle in ascending order; `facets` (2, f), the lower vertex first,
    each edge once, in an order of its own; with_boundaries and with_subdomains take index arrays by name."""

    def __init__(self, p, t):
        assert p.flags.c_contiguous and t.flags.c_contiguous and p.shape[0] == 2 and t.shape[0] == 3
        assert t.dtype.kind == "i"
        self.p, self.t = p, np.sort(t, axis=0)
        pairs = np.hstack([self.t[[0, 1]], self.t[[1, 2]], self.t[[0, 2]]])
        self.facets = np.unique(pairs[::-1], axis=1)[::-1]  # by the higher vertex, then by the lower
        self.boundaries = self.subdomains = None

    def with_boundaries(self, boundaries):
        self.boundaries = boundaries
        return self

    def with_subdomains(self, subdomains):
        self.subdomains = subdomains
        return self


def test_scikit_fem_has_named_boundaries_and_subdomains(mesh, monkeypatch):
    monkeypatch.setitem(sys.modules, "skfem", types.SimpleNamespace(MeshTri=MeshTri))
    made = mesh.to_skfem()
    assert np.array_equal(made.p.T, mesh.points)
    assert np.array_equal(made.t.T, np.sort(mesh.triangles, axis=1))
    assert set(made.boundaries) == {"inlet", "wall", "marker 3", "spare"}
    for name, key in (("inlet", "inlet"), ("wall", "wall"), ("marker 3", 3), ("spare", "spare")):
        assert np.array_equal(made.facets[:, made.boundaries[name]].T, np.sort(mesh.boundaries[key], axis=1))
    assert set(made.subdomains) == {"fluid", "region 7"}
    assert np.array_equal(made.subdomains["region 7"], mesh.subdomains[7])


def test_solvers_that_are_missing_are_named(mesh, monkeypatch):
    for module, call, package in (("skfem", mesh.to_skfem, "scikit-fem"), ("dolfinx.mesh", mesh.to_dolfinx, "dolfinx")):
        monkeypatch.setitem(sys.modules, module, None)
        with pytest.raises(weft.MissingPackage, match=f"needs {package}"):
            call()
