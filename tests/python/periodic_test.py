# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
import weft
from weft import _requests, results

SQUARE = weft.Domain([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)], [1, 2, 3, 4],
                     marker_names={1: "bottom", 2: "right", 3: "top", 4: "left"})


def mesh_of(points, triangles, sides, names=None):
    """`sides`: by marker, the vertices along each of its lines."""
    edges = [(edge, marker) for marker, lines in sides.items() for line in lines for edge in zip(line, line[1:])]
    points, triangles = np.array(points, float), np.array(triangles, np.int32).reshape(-1, 3)
    return weft.Mesh(points, triangles, np.zeros(len(triangles), np.int32),
                     np.array([edge for edge, _ in edges], np.int32), np.array([marker for _, marker in edges], np.int32),
                     np.zeros(0, np.int32), np.zeros((0, 2), np.int32),
                     results.summary_of(points, triangles, len(edges)), names or {})


def turned(degrees, points, about=(0, 0)):
    angle = np.radians(degrees)
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return (np.asarray(points, float) - about) @ rotation.T + about


def lines(*rows):
    """A mesh of nothing but lines, each with the marker of its place, from 1 on."""
    ends = np.cumsum([0, *map(len, rows)])
    return mesh_of(np.concatenate(rows), np.zeros((0, 3)),
                   {i + 1: [list(range(ends[i], ends[i + 1]))] for i in range(len(rows))})


def test_pairs_of_a_translation_go_along_the_first_side_from_its_lower_left_end(client):
    mesh = client.mesh(SQUARE, edge_at={"left": 0.07, "right": 0.07}, size=0.01)
    for a, b in (("left", "right"), (4, 2), ("right", "left")):
        pairs = mesh.periodic(a, b)
        assert pairs.dtype == np.int32 and len(pairs) >= 16
        first, second = mesh.points[pairs.T]
        assert np.abs(second - first - ((1, 0) if a != "right" else (-1, 0))).max() < 1e-9
        assert (np.diff(first[:, 1]) > 0).all() and first[0, 1] == 0 and first[-1, 1] == 1
        assert set(pairs[:, 0]) == set(mesh.boundaries[a].ravel())


def test_a_vertex_without_an_image_is_named(client):
    mesh = client.mesh(SQUARE, edge_at={"right": 0.5})
    with pytest.raises(ValueError, match=r"vertex \d+ at \(1, 0\.5\) of the side 'right' has no image on the side 'left'"):
        mesh.periodic("left", "right")


def test_a_vertex_of_the_first_side_is_named_first():
    mesh = lines([(0, 0), (0, 1), (0, 2), (0, 3)], [(4, 0), (4, 1.5), (4, 2), (4, 3)])
    with pytest.raises(ValueError, match=r"^vertex 1 at \(0, 1\) of the side 1 has no image on the side 2$"):
        mesh.periodic(1, 2)
    mesh.points[1, 1] = 1.5 + 1e-10
    assert mesh.periodic(1, 2).tolist() == [[0, 4], [1, 5], [2, 6], [3, 7]]


@pytest.mark.parametrize("degrees", [10, 90, 120, 359])
def test_a_rotation_takes_one_side_of_a_sector_to_the_other(degrees):
    side = [(1, 0), (1.5, 0.02), (1.75, 0), (3, 0)]
    mesh = lines(side, turned(degrees, side)[::-1])
    assert sorted(mesh.periodic(1, 2).tolist()) == [[0, 7], [1, 6], [2, 5], [3, 4]]
    assert mesh.periodic(2, 1)[:, ::-1].tolist() in ([[0, 7], [1, 6], [2, 5], [3, 4]], [[3, 4], [2, 5], [1, 6], [0, 7]])


# Vertices in no order, the line back and forth: the order is that of the line, not that of a coordinate.
def test_a_side_that_turns_back_is_followed():
    generator = np.random.default_rng(5)
    side = np.array([(0, 0), (1, 0), (1, 1), (-1, 1), (-1, 0.5), (-2, 0.5), (-2, 2), (0, 2)], float)
    numbers = generator.permutation(2 * len(side))
    points = np.empty((2 * len(side), 2))
    points[numbers] = np.concatenate([side, side + (7, 1e-11)])
    walks = numbers[:len(side)], numbers[len(side):]
    mesh = mesh_of(points, [], {1: [walks[0].tolist()], 2: [walks[1][::-1].tolist()]})
    assert mesh.periodic(1, 2).tolist() == np.column_stack(walks).tolist()
    assert mesh.periodic(2, 1).tolist() == np.column_stack(walks[::-1]).tolist()


# Both motions fit these straight sides; where the triangles are decides.
def test_the_inside_goes_to_the_outside():
    points = [(0, 0), (1, 0), (0, 1), (1, 1), (0, 2), (1, 2)]
    strip = [(0, 1, 3), (0, 3, 2), (2, 3, 5), (2, 5, 4)]
    opposite = mesh_of(points, strip, {1: [[0, 2, 4]], 2: [[1, 3, 5]]})
    assert opposite.periodic(1, 2).tolist() == [[0, 1], [2, 3], [4, 5]]
    points += [(2, 0), (2, 1), (2, 2), (3, 0), (3, 1), (3, 2)]
    two = strip + [(6, 9, 10), (6, 10, 7), (7, 10, 11), (7, 11, 8)]
    left_sides = mesh_of(points, two, {1: [[0, 2, 4]], 2: [[6, 7, 8]]})
    assert left_sides.periodic(1, 2).tolist() == [[0, 8], [2, 7], [4, 6]]


def test_sides_that_holes_cut_are_moved_by_their_corners():
    lower, upper = [(0.0, y) for y in (0, 0.25, 0.5)], [(0.0, y) for y in (2, 2.5, 3)]
    points = np.array([*upper, *lower])
    both = np.concatenate([points, (points + (5, 1))[::-1]])
    mesh = mesh_of(both, [], {1: [[0, 1, 2], [3, 4, 5]], 2: [[6, 7, 8], [9, 10, 11]]})
    assert mesh.periodic(1, 2).tolist() == [[3, 8], [4, 7], [5, 6], [0, 11], [1, 10], [2, 9]]
    spoilt = mesh_of(np.concatenate([points, turned(90, points)]), [], {1: [[0, 1, 2], [3, 4, 5]],
                                                                       2: [[6, 7, 8], [9, 10, 11]]})
    with pytest.raises(ValueError, match="has no image on the side 2"):
        spoilt.periodic(1, 2)


def test_a_side_is_an_open_line_of_its_own_length():
    ring = [(0, 0), (1, 0), (0, 1)]
    mesh = mesh_of([*ring, (3, 0), (4, 0), (5, 0), (4, 1), (8, 0), (8, 3)], [],
                   {1: [[0, 1, 2, 0]], 2: [[3, 4, 5], [4, 6]], 3: [[7, 8]], 4: [[3, 4, 5]]}, {9: "none"})
    for a, b, message in ((1, 3, "the side 1 is no line: edges of it are a closed one"),
                          (3, 2, r"the side 2 is no line: 3 of its edges meet at vertex 4 at \(4, 0\)"),
                          (3, 4, "the side 3 is 3 from end to end, the side 4 2: no translation or rotation")):
        with pytest.raises(ValueError, match=message):
            mesh.periodic(a, b)
    for marker, message in ((7, "there is no marker 7"), ("none", "no edge has the marker 'none'")):
        with pytest.raises(KeyError, match=message):
            mesh.periodic(3, marker)


def test_a_long_side_takes_no_time_for_each_vertex():
    x = np.linspace(0, 1, 300_001)
    mesh = lines(np.column_stack([x, x * x]), np.column_stack([x + 2, x * x]))
    pairs = mesh.periodic(1, 2)
    assert np.array_equal(pairs[:, 1] - pairs[:, 0], np.full(len(x), len(x)))


def test_pairs_of_markers_reach_the_request():
    def asked(pairs):
        request = _requests.mesh_request(SQUARE, None, 20, {"periodic": pairs})
        return [(getattr(pair, "from"), pair.to) for pair in request.quality.periodic]

    assert asked([(4, 2), ("bottom", "top")]) == [(4, 2), (1, 3)]
    assert asked(np.array([[4, 2]])) == [(4, 2)]
    assert asked([]) == []
    for pairs, message in (((4, 2), r"periodic\[0\] is 4; it must be a pair of markers"), (["ab"], "is 'ab'; it must"),
                           ([(4, 2), (1, 2, 3)], r"periodic\[1\] is \(1, 2, 3\)")):
        with pytest.raises(ValueError, match=message):
            asked(pairs)
    with pytest.raises(weft.DomainError, match="no marker of the domain is named 'botom'"):
        asked([("botom", "top")])


def test_an_error_names_the_argument():
    from weft import _arguments
    for field in ("quality.periodic", "quality.periodic[1]", "quality.periodic[0].from"):
        assert _arguments.argument_of(field, None) == "periodic"
    assert _arguments.argument_of("size.fields[0]", None) == ""


@pytest.mark.parametrize("sizes", [{"size": "0.001 + 0.02*x*y"}, {"edge": 0.1, "edge_at": {"left": 0.02}}])
def test_sides_have_the_same_vertices_if_the_request_says_so(client, sizes):
    mesh = client.mesh(SQUARE, periodic=[("left", "right"), (1, 3)], **sizes)
    for a, b, shift in (("left", "right", (1, 0)), (1, 3, (0, 1))):
        first, second = mesh.points[mesh.periodic(a, b).T]
        assert len(first) > 10 and np.abs(second - first - shift).max() < 1e-9
