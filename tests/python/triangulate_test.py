# SPDX-License-Identifier: Apache-2.0
"""weft.triangulate: what Triangle's documentation says of each switch, and of the dict that comes back."""

import concurrent.futures
import pathlib
import subprocess
import sys
import textwrap
import types

import numpy as np
import pytest
import shapely.geometry
import weft
from floor_plans import floor_plan, write_poly
from weft import _hull, _shared, _triangulate

SQUARE = {"vertices": [(0, 0), (4, 0), (4, 4), (0, 4)], "segments": [(0, 1), (1, 2), (2, 3), (3, 0)]}
PLANS = [*range(60), 178, 297, 378]
"""All of 500 hold, with q20 and with q30. In the last three, walls that meet at 0.1 degrees and less are bent,
because faces between others vanish."""


@pytest.fixture
def judge(run_weft, tmp_path):
    """Holds a mesh to its domain and its bounds before the independent checker."""
    def check(found, given, *bounds, min_angle=0):
        used, triangles = np.unique(found["triangles"][:, :3], return_inverse=True)
        points = found["vertices"][used]
        triangles = triangles.reshape(-1, 3).astype(np.int32)
        segments = np.searchsorted(used, found["segments"]).astype(np.int32)
        assert np.isin(found["segments"], used).all()
        regions = found.get("triangle_attributes", np.zeros((len(triangles), 1)))[:, 0].astype(np.int32)
        weft.Mesh(points, triangles, regions, segments, found["segment_markers"][:, 0], np.zeros(0, np.int32),
                  np.zeros((0, 2), np.int32), weft.results.summary_of(points, triangles, 0)
                  ).write(tmp_path / "mesh.npz")
        write_poly(tmp_path / "domain.poly", given)
        said = run_weft("check", tmp_path / "mesh.npz", "--domain", tmp_path / "domain.poly",
                        "--min-angle", min_angle, *bounds)
        assert "the mesh holds" in said
    return check


def marked(given):
    """The domain as its mesh has it: segments without a marker have 1 on the boundary."""
    return {**given, "segment_markers": given.get("segment_markers", np.ones(len(given["segments"]), int))}


def areas_of(found):
    return weft.quality.quality_of(found["vertices"], found["triangles"][:, :3]).areas


def angles_of(found):
    return weft.quality.quality_of(found["vertices"], found["triangles"][:, :3]).min_angles


def test_keys_shapes_and_types_are_those_of_the_package_triangle():
    given = {**SQUARE, "regions": [(1, 1, 7.5, 0.05)], "holes": np.zeros((0, 2))}
    found = weft.triangulate(given, "pqAaen")
    n, m = len(found["vertices"]), len(found["triangles"])
    k, e = len(found["segments"]), len(found["edges"])
    assert {key: (array.shape, array.dtype.name) for key, array in found.items()} == {
        "vertices": ((n, 2), "float64"), "vertex_markers": ((n, 1), "int32"),
        "triangles": ((m, 3), "int32"), "triangle_attributes": ((m, 1), "float64"),
        "segments": ((k, 2), "int32"), "segment_markers": ((k, 1), "int32"),
        "edges": ((e, 2), "int32"), "edge_markers": ((e, 1), "int32"),
        "neighbors": ((m, 3), "int32"), "regions": ((1, 4), "float64")}
    assert n - e + m == 1  # Euler
    assert (found["triangle_attributes"] == 7.5).all()
    assert areas_of(found).max() <= 0.05


def test_a_mesh_holds_before_the_independent_checker(judge):
    for switches, bounds, angle in (("p", (), 0), ("pq", (), 20), ("pq33a0.1", ("--size", "0.1"), 33),
                                    ("pa0.1", ("--size", "0.1"), 0), ("pqa0.1o2", ("--size", "0.1"), 20)):
        judge(weft.triangulate(SQUARE, switches), marked(SQUARE), *bounds, min_angle=angle)


def test_without_q_and_a_no_point_is_added():
    points = {"vertices": np.random.default_rng(3).random((200, 2)).round(2)}
    for switches in ("", "c", "cS0"):
        assert np.array_equal(weft.triangulate(points, switches)["vertices"], points["vertices"])
    assert len(weft.triangulate(SQUARE, "p")["triangles"]) == 2


def test_points_alone_give_their_delaunay_triangulation(judge):
    points = np.random.default_rng(5).random((300, 2))
    found = weft.triangulate({"vertices": points}, "c")
    assert np.array_equal(found["vertices"], points)
    assert areas_of(found).sum() == pytest.approx(shapely.geometry.MultiPoint(points).convex_hull.area)
    judge(found, marked({"vertices": points, "segments": found["segments"]}))
    assert not violations(found)
    assert "segments" not in weft.triangulate({"vertices": points}, "")


def test_segments_are_ignored_without_p():
    cut = {"vertices": [*SQUARE["vertices"], (1, 1), (2, 1.5)], "segments": [(0, 2)]}
    assert len(weft.triangulate(cut, "c")["vertices"]) == 6
    assert areas_of(weft.triangulate(cut, "")).sum() == pytest.approx(16)


def test_the_convex_hull_fills_concavities_with_c_and_not_without():
    notch = {"vertices": [(0, 0), (4, 0), (2, 1), (4, 4), (0, 4)],
             "segments": [(0, 1), (1, 2), (2, 3), (3, 4), (4, 0)]}
    assert areas_of(weft.triangulate(notch, "p")).sum() == pytest.approx(12)
    found = weft.triangulate(notch, "pc")
    assert areas_of(found).sum() == pytest.approx(16)
    assert len(found["segments"]) == 6


def test_the_hull_is_exact():
    line = [(i * 0.1, i * 0.3) for i in range(20)]  # rounded, so not quite on a line
    points = np.array([*line, (5., 0.), (5., 0.)])
    corners = points[_hull.convex_hull(points)]
    ring = shapely.geometry.Polygon(corners)
    assert ring.is_valid and ring.exterior.is_ccw
    turns = [(b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
             for a, b, c in zip(corners, np.roll(corners, -1, 0), np.roll(corners, -2, 0))]
    assert min(turns) > 0
    least = 2.0**-53  # Kettner et al., "Classroom examples of robustness problems", 2008
    for i, j in np.ndindex(32, 32):
        place = 0.5 + i * least, 0.5 + j * least
        assert _hull._turns_left(place, (12., 12.), (24., 24.)) == (i < j)
    with pytest.raises(weft.DomainError, match="the 3 points lie on a line"):
        weft.triangulate({"vertices": [(0, 0), (1, 1), (2, 2)]})


def test_vertices_of_the_input_come_first_and_unused_ones_go_with_j():
    given = {"vertices": [*SQUARE["vertices"], (1, 1), (1, 1), (9, 9)], "segments": SQUARE["segments"]}
    found = weft.triangulate(given, "pqa0.5")
    assert np.array_equal(found["vertices"][:7], given["vertices"])
    assert set(range(len(found["vertices"]))) - set(found["triangles"].ravel()) == {5, 6}
    fewer = weft.triangulate(given, "pqa0.5j")
    assert len(fewer["vertices"]) == len(found["vertices"]) - 2
    assert set(fewer["triangles"].ravel()) == set(range(len(fewer["vertices"])))
    assert np.array_equal(fewer["vertices"][fewer["triangles"]], found["vertices"][found["triangles"]])


def test_markers_are_those_of_the_input_then_of_segments_then_1_on_the_boundary():
    given = {"vertices": [*SQUARE["vertices"], (2, 1), (2, 3)], "segments": [*SQUARE["segments"], (4, 5)],
             "segment_markers": [5, 6, 0, 7, 0], "vertex_markers": [0, 0, 0, 0, 9, 0]}
    found = weft.triangulate(given, "pqa0.2e")
    markers, (x, y) = found["vertex_markers"][:, 0], found["vertices"].T
    assert markers[:6].tolist() == [5, 5, 6, 7, 9, 0]
    new = np.arange(len(x)) >= 6
    for side, marker in ((y == 0, 5), (x == 4, 6), (y == 4, 1), (x == 0, 7)):
        assert set(markers[new & side]) == {marker}
    inside = (x > 0) & (x < 4) & (y > 0) & (y < 4) & new
    assert set(markers[inside]) == {0}
    ends = found["vertices"][found["segments"]]
    on_door = (ends[..., 0] == 2).all(axis=1)
    assert on_door.any() and set(found["segment_markers"][on_door, 0]) == {0}
    of_edges = {tuple(sorted(edge)): marker
                for edge, (marker,) in zip(found["edges"].tolist(), found["edge_markers"].tolist())}
    for pair, (marker,) in zip(found["segments"].tolist(), found["segment_markers"].tolist()):
        assert of_edges[tuple(sorted(pair))] == marker
    assert sum(marker != 0 for marker in of_edges.values()) == np.count_nonzero(found["segment_markers"])


def test_B_leaves_markers_out():
    assert not {key for key in weft.triangulate(SQUARE, "pqeB") if key.endswith("markers")}


def test_neighbors_are_across_the_side_opposite_each_corner():
    found = weft.triangulate(SQUARE, "pqa0.3n")
    triangles, neighbors = found["triangles"].tolist(), found["neighbors"].tolist()
    outer = 0
    for t, (corners, across) in enumerate(zip(triangles, neighbors)):
        for k, other in enumerate(across):
            side = {*corners} - {corners[k]}
            if other < 0:
                outer += 1
            else:
                assert side < {*triangles[other]} and t in neighbors[other]
    assert outer == len(found["segments"])


def test_six_nodes_are_the_corners_and_the_middles_opposite_each():
    found = weft.triangulate({**SQUARE, "segment_markers": [5, 6, 7, 8]}, "pqa0.3o2")
    places = found["vertices"][found["triangles"]]
    assert np.allclose(places[:, 3:], (places[:, [1, 2, 0]] + places[:, [2, 0, 1]]) / 2, rtol=0, atol=1e-15)
    assert len(found["vertices"]) == found["triangles"].max() + 1
    middle_of_bottom = (found["vertices"][:, 1] == 0) & (np.arange(len(found["vertices"])) >= 4)
    assert set(found["vertex_markers"][middle_of_bottom, 0]) == {5}


def test_attributes_of_vertices_are_linear_between_them():
    given = {"vertices": [*SQUARE["vertices"], (1, 2)], "segments": [*SQUARE["segments"], (0, 2), (1, 3)],
             "regions": [(2, 0.5, 1, 0.05)]}
    plane = lambda points: np.column_stack([3 * points[:, 0] - points[:, 1], points[:, 1]])
    found = weft.triangulate({**given, "vertex_attributes": plane(np.array(given["vertices"], float))}, "pqa")
    assert len(found["vertices"]) > 50
    assert np.allclose(found["vertex_attributes"], plane(found["vertices"]), rtol=0, atol=1e-12)


def test_regions_bound_areas_with_a_alone_and_mark_triangles_with_A_alone():
    given = {"vertices": [*SQUARE["vertices"], (2, 0), (2, 4)], "segments": [*SQUARE["segments"], (4, 5)],
             "regions": [(1, 1, -3, 0.02), (3, 1, 0.25, -1)]}
    both = weft.triangulate(given, "pqAaa0.5")
    left = both["vertices"][both["triangles"]].mean(axis=1)[:, 0] < 2
    assert areas_of(both)[left].max() <= 0.02 < areas_of(both)[~left].max() <= 0.5
    assert set(both["triangle_attributes"][left, 0]) == {-3} and set(both["triangle_attributes"][~left, 0]) == {0.25}
    assert "triangle_attributes" not in weft.triangulate(given, "pqa")
    assert areas_of(weft.triangulate(given, "pqA")).min() > 0.02
    unseeded = weft.triangulate({**given, "regions": [(1, 1, 4, 0)]}, "pA")
    assert set(unseeded["triangle_attributes"][:, 0]) == {4, 0}


def test_holes_are_carved_and_kept_with_O(judge):
    inner = [(1, 1), (2, 1), (2, 2), (1, 2)]
    given = {"vertices": [*SQUARE["vertices"], *inner], "holes": [(1.5, 1.5)],
             "segments": [*SQUARE["segments"], (4, 5), (5, 6), (6, 7), (7, 4)]}
    found = weft.triangulate(given, "pqa0.2")
    assert areas_of(found).sum() == pytest.approx(15)
    judge(found, marked(given), "--size", "0.2", min_angle=20)
    assert set(found["vertex_markers"][4:8, 0]) == {1}
    assert areas_of(weft.triangulate(given, "pqO")).sum() == pytest.approx(16)


def violations(found):
    """Triangles whose circumdisk holds a vertex, by all pairs."""
    a, b, c = (found["vertices"][found["triangles"][:, k]] for k in range(3))
    u, v = b - a, c - a
    twice = 2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    uu, vv = (u**2).sum(1), (v**2).sum(1)
    centre = a + np.column_stack([v[:, 1] * uu - u[:, 1] * vv, u[:, 0] * vv - v[:, 0] * uu]) / twice[:, None]
    radius = np.hypot(*(centre - a).T)
    used = found["vertices"][np.unique(found["triangles"])]
    nearest = np.array([np.hypot(*(used - at).T).min() for at in centre])
    return int((nearest < radius * (1 - 1e-9)).sum())


@pytest.mark.parametrize("most, counts, best", [(6, [7, 9, 10], 10), (6, [7, 12], 7), (6, [12], 4), (10, [14], 14)])
def test_of_meshes_with_more_and_more_room_the_best_within_S_is_taken(monkeypatch, most, counts, best):
    def mesh(points):
        missed = types.SimpleNamespace(budget=1)
        return types.SimpleNamespace(points=range(points), triangles=range(2),
                                     summary=types.SimpleNamespace(unrefined=missed))
    monkeypatch.setattr(_triangulate, "_triangulation", lambda domain: mesh(4))
    made, bounds = iter(counts), []
    with pytest.warns(weft.WeftWarning, match="too few"):
        found = _triangulate._limited(
            None, lambda max_triangles: bounds.append(max_triangles) or mesh(next(made)), most)
    assert len(found.points) == best
    assert bounds == sorted(set(bounds)) and len(bounds) == len(counts)


@pytest.mark.parametrize("most", [0, 1, 7, 50, 1000])
def test_S_bounds_the_steiner_points_and_says_if_they_are_too_few(judge, most):
    if most < 1000:
        with pytest.warns(weft.WeftWarning, match=f"S{most}: {most} new points are too few"):
            found = weft.triangulate(SQUARE, f"pqa0.1S{most}")
        assert 0.9 * most - 1 <= len(found["vertices"]) - 4 <= most
    else:
        found = weft.triangulate(SQUARE, f"pqa0.1S{most}")
        judge(found, marked(SQUARE), "--size", "0.1", min_angle=20)


def test_a_mesh_is_refined_where_its_areas_say_so(judge):
    ring = {"vertices": [(0, 0), (4, 0), (4.1, 4), (0, 4.2), (1, 1), (2.1, 1), (2, 2.2), (1, 2)],
            "segments": [*SQUARE["segments"], (4, 5), (5, 6), (6, 7), (7, 4)],
            "segment_markers": [2, 3, 4, 5, 6, 6, 6, 6], "holes": [(1.5, 1.5)]}
    coarse = weft.triangulate(ring, "pq")
    same = weft.triangulate(coarse, "r")
    assert sorted(map(sorted, same["triangles"].tolist())) == sorted(map(sorted, coarse["triangles"].tolist()))
    areas = np.where(coarse["vertices"][coarse["triangles"]].mean(axis=1)[:, 0] < 2, 0.01, -1)
    fine = weft.triangulate({**coarse, "triangle_max_area": areas}, "rpqa")
    assert np.array_equal(fine["vertices"][:len(coarse["vertices"])], coarse["vertices"])
    assert areas_of(fine).sum() == pytest.approx(areas_of(coarse).sum())
    within = containing(coarse, fine["vertices"][fine["triangles"]].mean(axis=1))
    assert (areas_of(fine)[areas[within] > 0] <= 0.01).all() and areas_of(fine).max() > 0.05
    judge(fine, ring, min_angle=20)


@pytest.mark.parametrize("switches", ["pqYa0.01", "pq30YYa0.01"])
def test_Y_puts_no_point_on_segments(judge, switches):
    plan = {**SQUARE, "vertices": [*SQUARE["vertices"], (1, 1), (3, 2)], "segments": [*SQUARE["segments"], (4, 5)],
            "segment_markers": [1, 1, 1, 1, 2]}
    made = weft.triangulate(plan, switches)
    assert len(made["segments"]) == 5 and len(made["vertices"]) > 90
    judge(made, plan, "--keep", "all", "--max-unrefined", 200)


def containing(mesh, points):
    """The triangle that each point is in, or is nearest to being in."""
    a, b, c = (mesh["vertices"][mesh["triangles"][:, k]] for k in range(3))
    sides = [((q - p)[:, 0] * (points[:, None] - p)[..., 1] - (q - p)[:, 1] * (points[:, None] - p)[..., 0])
             for p, q in ((a, b), (b, c), (c, a))]
    return np.min(sides, axis=0).argmax(axis=1)


def test_attributes_of_a_mesh_that_is_refined_stay_where_they_were():
    given = {"vertices": [*SQUARE["vertices"], (2, 0), (2, 4)], "segments": [*SQUARE["segments"], (4, 5)]}
    coarse = weft.triangulate(given, "pqa2")
    right = (coarse["vertices"][coarse["triangles"]].mean(axis=1)[:, 0] > 2)
    fine = weft.triangulate({**coarse, "triangle_attributes": np.column_stack([right, 3 * right])}, "rqa0.05")
    right = (fine["vertices"][fine["triangles"]].mean(axis=1)[:, 0] > 2)
    assert np.array_equal(fine["triangle_attributes"], np.column_stack([right, 3 * right]))


@pytest.mark.parametrize("switches, message", [
    ("pqx", "'x': unknown, number 3 of 'pqx'"), ("pq-", "'-': unknown"), ("q\N{ARABIC-INDIC DIGIT TWO}", "unknown"),
    ("q40", "'q40': .* from 0 to 36"), ("a0", "'a0': .* above 0"), ("a1e999", "'a1e999'"), ("o3", "'o': the order"),
    ("pqD", "'D': .* constrained"), ("L", "'L'"), ("rc", "'c'"), ("pu", "'u'"), ("v", "'v'"),
    ("w", "'w'"), ("W", "'W'"), ("s", "'s'"), ("g", "'g'")])
def test_a_switch_that_cannot_be_honoured_is_named(switches, message):
    with pytest.raises(weft.SwitchError, match=message) as caught:
        weft.triangulate(SQUARE, switches)
    assert isinstance(caught.value, ValueError) and caught.value.switch in switches


def test_numbers_end_where_triangles_do_or_have_an_exponent():
    parse = weft._switches.parse
    assert parse("-pq30.5a1e-3e") == parse("pq30.5ea.001")
    assert parse("a0.1e").edges and parse("qa").own_areas and parse("q").min_angle == 20
    assert parse("pz" + weft._switches._WITHOUT_EFFECT) == parse("pz")


@pytest.mark.parametrize("change, message", [
    ({"verts": []}, "the key 'verts' is unknown; there are vertices"),
    ({"vertices": [(0, 0), (1, 0)]}, "vertices: 2, expected 3"),
    ({"vertices": [(0, 0), (1, 0), (1, float("nan"))]}, r"vertices\[2\] is not finite"),
    ({"segments": [(0, 9)]}, r"segments\[0\] names point 9 of 4"),
    ({"segments": [(0, 1.5)]}, "segments: not integers"),
    ({"segment_markers": [1]}, "segment_markers: 1 for 4 segments"),
    ({"regions": [(1, 1, 1)]}, r"regions: an array \(1, 3\), expected \(n, 4\)")])
def test_arrays_that_make_no_sense_are_named(change, message):
    with pytest.raises(weft.DomainError, match=message):
        weft.triangulate({**SQUARE, **change}, "pq")


@pytest.mark.parametrize("triangles, message", [
    ([], "none to refine"), ([(0, 1, 9)], r"triangles\[0\] names vertex 9 of 4"),
    ([(0, 1)], r"an array \(1, 2\)"), ([(0, 1, 2), (0, 1, 3), (0, 1, 2)], "more than two have the edge 0, 1")])
def test_triangles_that_are_no_mesh_are_named(triangles, message):
    with pytest.raises(weft.DomainError, match=message):
        weft.triangulate({**SQUARE, "triangles": triangles}, "r")


def test_a_seed_outside_is_named():
    with pytest.raises(weft.InvalidRequest, match=r"domain.holes\[0\]"):
        weft.triangulate({**SQUARE, "holes": [(9, 9)]}, "p")


@pytest.mark.parametrize("seed", PLANS)
def test_floor_plans_hold(judge, seed):
    plan = floor_plan(seed)
    angle = (20, 30)[seed % 2]
    found = weft.triangulate(plan, f"pq{angle}Aaa0.8")
    judge(found, plan, "--size", "0.8", min_angle=angle)
    assert set(found["segment_markers"][:, 0]) == {1, 2}


def test_calls_of_many_threads_need_no_server_if_there_is_the_library(monkeypatch):
    monkeypatch.setattr(_shared, "LocalServer", None)
    with concurrent.futures.ThreadPoolExecutor(8) as threads:
        meshes = list(threads.map(lambda _: weft.triangulate(SQUARE, "pqa0.01"), range(24)))
    for mesh in meshes:
        assert all((mesh[key] == meshes[0][key]).all() for key in mesh)


def test_one_server_serves_all_calls_and_ends_with_the_process(tmp_path):
    program = textwrap.dedent("""
        import threading, weft
        from weft import _library, _shared
        _library._NAME = "no library"
        square = {"vertices": [(0, 0), (1, 0), (1, 1), (0, 1)]}
        many = [threading.Thread(target=weft.triangulate, args=(square, "qa0.01")) for _ in range(8)]
        weft.triangulate(square, "q")
        ((_, first),) = _shared._started.values()
        [one.start() for one in many], [one.join() for one in many]
        ((_, client),) = _shared._started.values()
        assert client is first
        print(client.target)
        """)
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    folder = pathlib.Path(done.stdout.strip().removeprefix("unix:")).parent
    assert folder.name.startswith("weft-") and not folder.exists()  # it goes when the server has ended
