# SPDX-License-Identifier: Apache-2.0
import json
import warnings

import numpy as np
import pytest
import shapely.geometry
import weft
from google.protobuf import json_format
from weft import _library, _protocol, _requests
from weft._rings import find_crossing
from conftest import MODELS

SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]
HOLE = [[1, 1], [2, 1], [2, 2], [1, 2], [1, 1]]


@pytest.mark.parametrize("name", ["key.poly", "pipe.poly", "us-east-coast.poly",
                                  "us-east-coast.geojson"])
def test_a_file_means_what_it_means_to_the_command_line(client, digest_of, name):
    assert client.mesh(MODELS / name).digest == digest_of(MODELS / name)


@pytest.mark.parametrize("name", ["key.poly", "us-east-coast.geojson", "rings.csv"])
def test_a_file_makes_the_very_domain_that_the_command_line_sends(run_weft, tmp_path, name):
    path = MODELS / name
    if name == "rings.csv":
        path = tmp_path / name
        path.write_text("x;y;marker\n0;0;1\n9,5;0;2\n9;9;inlet\n\n1;1;0\n2;1;0\n2;2;0\n")
    run_weft("convert", path, tmp_path / "sent.pb")
    assert sent_bytes(path) == (tmp_path / "sent.pb").read_bytes()


def sent_bytes(path):
    message = _protocol.message("weft.v1.Domain")()
    _requests._fill_domain(weft.Domain.read(path), message)
    return message.SerializeToString(deterministic=True)


FILES = MODELS.parent / "domain_files"
EXPECTED = json.loads((FILES / "expect.json").read_text())


@pytest.fixture(params=["the library", "the package"])
def by(request, monkeypatch):
    """Who reads: libweft.so, or Python's own readers, for want of it."""
    if request.param == "the package":
        def missing():
            raise weft.MissingPackage("no library")
        monkeypatch.setattr(_library, "_library", missing)
    return request.param


@pytest.mark.filterwarnings("ignore::weft.WeftWarning")
@pytest.mark.parametrize("name", EXPECTED)
def test_a_file_is_read_as_by_the_command_line(by, name):
    if EXPECTED[name] is None:
        with pytest.raises(weft.DomainError):
            weft.Domain.read(FILES / name)
        return
    message = json_format.ParseDict(EXPECTED[name], _protocol.message("weft.v1.Domain")())
    assert sent_bytes(FILES / name) == message.SerializeToString(deterministic=True)


@pytest.mark.parametrize("given", json.loads((FILES / "degrees.json").read_text()), ids=str)
def test_a_polygon_is_in_degrees_as_for_the_command_line(recwarn, given):
    polygon = {"type": "Polygon", "coordinates": [[*given["ring"], given["ring"][0]]]}
    if "crs" in given:
        polygon["crs"] = {"type": "name", "properties": {"name": given["crs"]}}
    assert bool(weft.Domain.geojson(polygon).geographic) == given["degrees"]
    assert len(recwarn) == given.get("is_told", False)


def test_rings_that_are_not_closed_are_closed_with_a_warning_for_five():
    polygons = {"type": "MultiPolygon", "coordinates": [[SQUARE[:-1]]] * 7}
    with pytest.warns(weft.WeftWarning) as told:
        domain = weft.Domain.geojson(polygons)
    assert (domain.segments[:4] == [[0, 1], [1, 2], [2, 3], [3, 0]]).all() and len(domain.segments) == 28
    assert [str(warning.message) for warning in told][::5] == [
        "coordinates[0][0] is a ring that is not closed: it starts at (0, 0) and ends at (0, 4); a segment closes it",
        "2 more rings are not closed"]


def test_polygons_that_overlap_are_united_each_with_its_region(client):
    mesh = client.mesh(named_features(
        ("Polygon", [SQUARE], {"region": 1, "max_area": 0.5}),
        ("Polygon", [[[2, 1], [6, 1], [6, 2], [2, 2], [2, 1]]], {"region": 2, "max_area": 0.05})))
    assert mesh.summary.area == pytest.approx(18)
    areas = mesh.quality().areas
    assert areas[mesh.regions == 2].sum() == pytest.approx(4)
    assert areas[mesh.regions == 2].max() <= 0.05
    assert areas[mesh.regions == 1].sum() == pytest.approx(14)


def test_areas_of_a_domain_must_be_there_one_for_each_segment():
    square = [(0, 0), (1, 0), (1, 1)], [(0, 1), (1, 2), (2, 0)]
    assert weft.Domain(*square, areas=[weft.Area(region=3)], segment_areas=[1, 1, 1], fill="union").areas[0].region == 3
    with pytest.raises(weft.DomainError, match=r"segment_areas\[2\] is 2, there are 1 areas"):
        weft.Domain(*square, areas=[weft.Area()], segment_areas=[1, 1, 2])
    with pytest.raises(weft.DomainError, match="segment_areas: 2 for 3 segments"):
        weft.Domain(*square, areas=[weft.Area()], segment_areas=[1, 1])


def test_a_feature_collection_means_what_it_means_to_the_command_line(client, digest_of, tmp_path):
    def feature(kind, coordinates, **properties):
        return {"type": "Feature", "properties": properties,
                "geometry": {"type": kind, "coordinates": coordinates}}
    path = tmp_path / "all.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [
        feature("Polygon", [SQUARE, HOLE], marker=5, region=7, max_area=0.1),
        feature("MultiPolygon", [[[[5, 0], [6, 0], [6, 1], [5, 0]]], [[[5, 2], [6, 2], [6, 3], [5, 2]]]],
                region=-2),
        feature("LineString", [[0.5, 3], [0.5, 3], [3, 3.5]], marker=9),
        feature("Polygon", [[[10, 0], [12, 0], [12, 2], [10, 2], [10, 0]]]),
        feature("LineString", [[9, 1], [13, 1]], marker=9),  # through and out again
        feature("LineString", [[10.5, 0.2], [11.5, 0.2], [11, 0.8], [10.5, 0.2]]),  # no hole
        feature("MultiPoint", [[3, 1], [3, 2]]),
        {"type": "Feature", "properties": None, "geometry": None}]}))
    mesh = client.mesh(path)
    assert mesh.digest == digest_of(path)
    assert set(mesh.regions) == {7, -2, 0}
    assert set(mesh.edge_markers) == {0, 5, 9}


def test_arrays_shapely_and_geojson_are_the_same_domain(client):
    polygon = shapely.geometry.Polygon(SQUARE, [HOLE])
    digests = {client.mesh(domain, size=0.1).digest for domain in (
        polygon, polygon.__geo_interface__, [np.array(SQUARE), np.array(HOLE)],
        weft.Domain.rings(SQUARE[:-1], HOLE[:-1]), [SQUARE, HOLE], (tuple(map(tuple, SQUARE)), HOLE[:-1]))}
    assert len(digests) == 1


@pytest.mark.parametrize("kind", [np.array, list, tuple])
def test_one_array_or_list_of_pairs_is_a_ring(client, kind):
    assert client.mesh(kind(SQUARE)).summary.area == pytest.approx(16)


def test_a_multipolygon_of_shapely_is_meshed_in_all_its_parts(client):
    parts = shapely.geometry.MultiPolygon([shapely.geometry.box(0, 0, 1, 1),
                                            shapely.geometry.box(3, 0, 5, 1)])
    assert client.mesh(parts).summary.area == pytest.approx(3)


def test_attributes_of_triangles_regions_may_be_any_numbers(by, client, digest_of, tmp_path):
    path = tmp_path / "regions.poly"
    path.write_text("4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n5 1 3\n"
                    "0\n2\n1 3 1 0.7\n2 1 3 0.35 -1  # the first is its own maximum area\n")
    domain = weft.Domain.read(path)
    first, second = domain.regions
    assert domain.region_values == {1: 0.35, 2: 0.7}
    assert (first.id, first.max_area, second.id, second.max_area) == (2, 0.7, 1, None)
    assert client.mesh(path).digest == digest_of(path)


def test_holes_and_regions_of_seeds_are_kept(client):
    rings = weft.Domain.rings(SQUARE, HOLE)
    domain = weft.Domain(rings.points, rings.segments, markers=np.arange(8), holes=[(1.5, 1.5)],
                         regions=[weft.Region(3, 3, id=4, max_area=0.05)])
    mesh = client.mesh(domain)
    assert mesh.summary.area == pytest.approx(15)
    assert set(mesh.regions) == {4}
    assert mesh.quality().areas.max() <= 0.05
    assert (mesh.edge_markers == mesh.edge_segments).all()
    assert set(mesh.edge_markers) == set(range(8))


@pytest.mark.parametrize("name", ["max_area", "max_edge"])
@pytest.mark.parametrize("bound, fault", [
    (-1, "-1, not positive"), ("abc", '"abc", not a number'), ("0,05", '"0,05", not a number'),
    (True, "true, not a number"), ([1], r"\[1\], not a number"), (-10**400, "-inf, not positive"),
    (10**400, "larger than .*"), pytest.param(10**5000, "larger than .*", id="5001 digits"),
    (np.inf, "larger than .*"), (np.nan, "nan, not positive")])
def test_a_bound_of_a_region_that_is_none_is_refused(name, bound, fault):
    feature = {"type": "Feature", "properties": {name: bound},
               "geometry": {"type": "Polygon", "coordinates": [SQUARE]}}
    with pytest.raises(weft.DomainError, match=f"^properties.{name} is {fault}$"):
        weft.Domain.geojson(feature)


@pytest.mark.parametrize("name", ["marker", "region"])
@pytest.mark.parametrize("number, text", [
    (10**400, "inf"), pytest.param(-10**5000, "-inf", id="5001 digits"), (np.inf, "inf"), (np.nan, "nan"),
    (2**31, "2147483648"), (0.5, "0.5")])
def test_a_marker_or_region_that_is_no_integer_of_32_bits_is_refused_by_its_feature(name, number, text):
    features = named_features(("Polygon", [SQUARE], {}), ("Polygon", [SQUARE], {name: number}))
    with pytest.raises(weft.DomainError, match=rf"^features\[1\]\.properties\.{name} is {text}, not an integer"):
        weft.Domain.geojson(features)


def test_a_coordinate_that_is_no_number_of_double_precision_is_refused_by_its_path():
    with pytest.raises(weft.DomainError, match=r"^coordinates\[0\] does not hold positions"):
        weft.Domain.geojson({"type": "Polygon", "coordinates": [[[0, 0], [10**400, 0], [1, 1], [0, 0]]]})


def test_a_bound_of_a_region_that_is_null_is_none():
    domain = weft.Domain.geojson({
        "type": "Feature", "properties": {"region": 1, "max_area": None, "max_edge": np.int64(2)},
        "geometry": {"type": "Polygon", "coordinates": [SQUARE]}})
    assert domain.areas == (weft.Area(1, pytest.approx(3**0.5)),)


def test_a_region_of_a_polygon_with_a_hole_is_outside_the_hole(client):
    # The widest gap between ordinates is at the height of the hole.
    json = {"type": "Feature", "properties": {"region": 3}, "geometry": {
        "type": "Polygon", "coordinates": [SQUARE, [[0.1, 0.5], [3, 0.5], [3, 3.5], [0.1, 3.5], [0.1, 0.5]]]}}
    mesh = client.mesh(json)
    assert set(mesh.regions) == {3}


def test_a_region_keeps_off_the_lines_inside_it(client):
    mesh = client.mesh({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"region": 3},
         "geometry": {"type": "Polygon", "coordinates": [SQUARE]}},
        {"type": "Feature", "geometry": {"type": "LineString", "coordinates": [[2, 1], [2, 3]]}}]})
    assert set(mesh.regions) == {3}


def test_a_poly_counts_from_0_or_1_and_finds_its_points_beside_it(client, tmp_path):
    nodes = "{}  0 0\n{}  1 0 # a comment\n\n{} 0 1\n"
    segments = "3 1\n 0 {0} {1} 7\n 1 {1} {2} 8\n 2 {2} {0} 9\n0\n"
    (tmp_path / "one.poly").write_text("3 2 0 0\n" + nodes.format(1, 2, 3) + segments.format(1, 2, 3))
    (tmp_path / "two.node").write_text("3 2 0 0\n" + nodes.format(0, 1, 2))
    (tmp_path / "two.poly").write_text("0 2 0 0\n" + segments.format(0, 1, 2))
    meshes = [client.mesh(tmp_path / name) for name in ("one.poly", "two.poly")]
    assert meshes[0].digest == meshes[1].digest
    assert set(meshes[0].edge_markers) == {7, 8, 9}


POLY = ("4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n4 1\n1 1 2 7\n2 2 3 7\n3 3 4 8\n4 4 1 8\n0\n"
        "1\n1 1 1 5 0.5\n# marker=7:inlet\n")
GEOJSON = json.dumps({"type": "Feature", "properties": {"marker": "wall", "region": 5},
                      "geometry": {"type": "Polygon", "coordinates": [SQUARE]}}, indent=1)


@pytest.mark.parametrize("name, text", [("d.poly", POLY), ("d.geojson", GEOJSON)])
@pytest.mark.parametrize("encode", [
    lambda text: b"\xef\xbb\xbf" + text.encode(),
    lambda text: b"\xff\xfe" + text.encode("utf-16-le"),
    lambda text: b"\xfe\xff" + text.encode("utf-16-be"),
    lambda text: text.replace("\n", "\r\n").encode(),
    lambda text: text.replace("\n", "\r").encode(),
    lambda text: text.replace("\n", "\t\n").encode(),
], ids=["utf-8 mark", "utf-16 little", "utf-16 big", "CR LF", "CR", "tabs"])
def test_a_file_is_the_same_whatever_program_saved_it(by, tmp_path, name, text, encode):
    path = tmp_path / name
    path.write_text(text)
    expected = weft.Domain.read(path)
    path.write_bytes(encode(text))
    domain = weft.Domain.read(path)
    assert np.array_equal(domain.points, expected.points)
    assert np.array_equal(domain.segments, expected.segments)
    assert np.array_equal(domain.markers, expected.markers)
    assert domain.regions == expected.regions
    assert domain.marker_names == expected.marker_names


@pytest.mark.parametrize("name", ["d.poly", "d.geojson"])
@pytest.mark.parametrize("raw", [b"\xef\xbb\xbf", b"\xff\xfe", b"\xff\xfe0", b"\xff\xfe\x00\xd8"])
def test_a_file_of_no_text_is_refused_by_its_name(by, tmp_path, name, raw):
    (tmp_path / name).write_bytes(raw)
    with pytest.raises(weft.DomainError, match=name):
        weft.Domain.read(tmp_path / name)


def test_a_poly_has_exponents_of_fortran_any_numbers_and_headers_that_end_early(client, digest_of, tmp_path):
    path = tmp_path / "fortran.poly"
    path.write_text("4\n70 0.0D+00 0.d0\n-3 4.0D+00 0\n12 0.4D+01 3.0d0\n5 0 3.0+000\n"
                    "4\n1 70 -3 5\n2 -3 12\n3 12 5 6\n4 5 70\n0\n")
    domain = weft.Domain.read(path)
    assert domain.points.tolist() == [[0, 0], [4, 0], [4, 3], [0, 3]]
    assert domain.segments.tolist() == [[0, 1], [1, 2], [2, 3], [3, 0]]
    assert domain.markers.tolist() == [5, 0, 6, 0]
    assert client.mesh(path).digest == digest_of(path)


def test_a_property_that_is_a_text_may_be_a_number():
    def read(**properties):
        return weft.Domain.geojson({"type": "Feature", "properties": properties,
                                    "geometry": {"type": "Polygon", "coordinates": [SQUARE]}})
    domain = read(marker="3", region=" 7 ", max_area="1.0D-1", max_edge="2")
    assert set(domain.markers) == {3}
    assert domain.areas == (weft.Area(7, 0.1),)
    assert (domain.marker_names, domain.region_names) == ({}, {})
    assert read(marker="", region=" ", max_area="").areas == (weft.Area(),)
    assert read(marker="7a").marker_names == {1: "7a"}
    capitals = read(MARKER=4, marker=3, Region="inlet", MAX_AREA="0.5", Max_Area=9)
    assert set(capitals.markers) == {3}
    assert (capitals.areas, capitals.region_names) == ((weft.Area(1, 0.5),), {1: "inlet"})
    with pytest.raises(weft.DomainError, match='properties.max_area is "small", not a number'):
        read(max_area="small")
    with pytest.raises(weft.DomainError, match="properties.marker is 1.5, not an integer"):
        read(marker="1.5")


def test_a_property_that_is_no_marker_no_region_and_no_name_is_left_out_with_a_warning(by, tmp_path):
    path = tmp_path / "odd.geojson"
    rows = [{"marker": True, "region": ["bay"]}, {"marker_name": 5, "region_name": {}},
            {"marker": "a", "marker_name": "b"}, {"marker": "a", "marker_name": "a"},
            {"marker": False}, {"region": [0]}]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": row, "geometry": {"type": "Polygon", "coordinates": [SQUARE]}}
        for row in rows]}))
    with pytest.warns(weft.WeftWarning) as warned:
        domain = weft.Domain.read(path)
    places = [str(warning.message).removeprefix(f"{path}: ") for warning in warned]
    assert places == [
        "features[0].properties.marker is left out: it is true, neither a number nor a text",
        'features[0].properties.region is left out: it is ["bay"], neither a number nor a text',
        "features[1].properties.marker_name is left out: it is 5, not a text",
        "features[1].properties.region_name is left out: it is {}, not a text",
        "features[2].properties.marker_name is left out: it is 'b' beside the name 'a'",
        "2 more properties are left out"]
    assert domain.marker_names == {1: "a"}


@pytest.mark.parametrize("holes, fault", [
    ([[[20, 1], [21, 1], [21, 2], [20, 1]]],
     "coordinates[1] is a hole that is outside of its polygon or in another hole, at (20, 1)"),
    ([HOLE, HOLE[::-1]], "coordinates[2] is a hole that is outside of its polygon or in another hole, at (1, 1)"),
    ([HOLE, [[1.2, 1.2], [1.4, 1.2], [1.4, 1.4], [1.2, 1.2]]],
     "coordinates[2] is a hole that is outside of its polygon or in another hole, at (1.2, 1.2)"),
    ([HOLE, [[1.5, 0.5], [3, 0.5], [3, 3], [1.5, 0.5]]],
     "coordinates[2] is a ring that crosses another of its polygon: coordinates[1]"),
    ([[[3, 1], [5, 1], [5, 2], [3, 1]]],
     "coordinates[1] is a ring that crosses another of its polygon: coordinates[0]"),
    ([HOLE, [[2, 1], [3, 1], [3, 2], [2, 2], [2, 1]], [[0, 0], [1, 1], [0, 1], [0, 0]]], None),
])
def test_rings_that_parity_does_not_take_for_holes_are_a_warning_as_on_the_command_line(
        by, run_weft, tmp_path, holes, fault):
    path = tmp_path / "holes.geojson"
    path.write_text(json.dumps({"type": "Polygon", "coordinates": [SQUARE, *holes]}))
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        weft.Domain.read(path)
    said = [str(warning.message) for warning in warned]
    printed = json.loads(run_weft("mesh", path, "--json", "-o", tmp_path / "mesh.npz")).get("warnings", [])
    for texts in (said, printed):  # which crossing is found first may differ
        assert [text.partition(", near")[0].partition("; what")[0] for text in texts] == \
            ([] if fault is None else [f"{path}: {fault}"])


BOW = [[0, 0], [4, 4], [4, 4], [4, 0], [0, 4], [0, 0]]


@pytest.mark.parametrize("rings, faults", [
    ([BOW], ["coordinates[0] is a ring that crosses itself: edge 0 from (0, 0) to (4, 4) crosses edge 3 from "
             "(4, 0) to (0, 4)"]),
    ([SQUARE, [[1, 1], [3, 3], [3, 1], [1, 3], [1, 1]]],
     ["coordinates[1] is a ring that crosses itself: edge 0 from (1, 1) to (3, 3) crosses edge 2 from (3, 1) to "
      "(1, 3)"]),
    ([SQUARE, [[1, 1], [3, 1], [3, 2], [2, 1], [2, 3], [1, 1]]], []),  # touches itself
])
def test_a_ring_that_crosses_itself_is_a_warning_as_on_the_command_line(by, run_weft, recwarn, tmp_path, rings, faults):
    path = tmp_path / "bow.geojson"
    path.write_text(json.dumps({"type": "Polygon", "coordinates": rings}))
    weft.Domain.read(path)
    printed = json.loads(run_weft("mesh", path, "--json", "-o", tmp_path / "mesh.npz")).get("warnings", [])
    wanted = [f"{path}: {fault}" for fault in faults]
    assert [str(warning.message) for warning in recwarn] == printed == wanted


def test_of_many_rings_that_cross_themselves_five_are_told(recwarn):
    weft.Domain.geojson({"type": "MultiPolygon", "coordinates": [
        [[[x + 9 * i, y] for x, y in BOW]] for i in range(7)]})
    said = [str(warning.message) for warning in recwarn]
    assert len(said) == 6 and said[-1] == "2 more rings cross themselves"


def test_the_crossing_of_a_long_ring_is_found():
    angles = np.arange(20_000) * (2 * np.pi / 20_000)
    ring = (1 + 0.1 * np.cos(40 * angles))[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    assert find_crossing(ring) is None
    ring[[7000, 7001]] = ring[[7001, 7000]]
    assert find_crossing(ring) == (6999, 7001)


def test_markers_that_the_header_of_a_poly_denies_are_a_warning(by, tmp_path):
    path = tmp_path / "denied.poly"
    path.write_text("3 2 0 0\n1 0 0\n2 1 0\n3 1 1\n3 0\n1 1 2 7\n2 2 3\n3 3 1\n0\n")
    with pytest.warns(weft.WeftWarning, match="denied.poly(:6)?: what follows the points of segments is ignored"):
        assert weft.Domain.read(path).markers.tolist() == [0, 0, 0]


@pytest.mark.parametrize("name, told", [("urn:ogc:def:crs:EPSG::32618", True), ("EPSG:4326", False),
                                        ("urn:ogc:def:crs:OGC:1.3:CRS84", False)])
def test_a_coordinate_system_that_is_not_wgs_84_is_a_warning(recwarn, name, told):
    weft.Domain.geojson({"type": "Polygon", "coordinates": [SQUARE],
                         "crs": {"type": "name", "properties": {"name": name}}})
    assert [str(warning.message) for warning in recwarn] == [
        f"its crs is '{name}', not WGS 84 as GeoJSON's is; coordinates are taken as they are"][:told]


def test_what_has_no_area_and_no_length_is_left_out_with_one_warning(by, client, digest_of, tmp_path):
    flat = [[1, 1], [2, 2], [2, 2], [1, 1]]
    path = tmp_path / "left.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"marker": "a"},
         "geometry": {"type": "Polygon", "coordinates": [[[9, 9], [9, 9]], HOLE]}},
        {"type": "Feature", "properties": {"marker": "b"},
         "geometry": {"type": "Polygon", "coordinates": [SQUARE, flat, []]}},
        {"type": "Feature", "properties": {"region": 4}, "geometry": {
            "type": "Polygon", "coordinates": [[[9, 0], [10, 0], [10, 1], [10, 0], [9, 0]]]}},
        {"type": "Feature", "properties": {}, "geometry": {
            "type": "GeometryCollection", "geometries": [None, {"type": "Polygon", "coordinates": []}]}},
        {"type": "Feature", "properties": {"marker": "c"},
         "geometry": {"type": "LineString", "coordinates": [[1, 1], [1, 1]]}}]}))
    with pytest.warns(weft.WeftWarning) as warned:
        domain = weft.Domain.read(path)
    assert [str(warning.message) for warning in warned] == [
        f"{path}: 3 rings without an area, 1 line without a length and 2 empty geometries are left out, "
        "the first is features[0].geometry.coordinates[0]"]
    assert len(domain.segments) == 4 + 4
    with pytest.warns(weft.WeftWarning):
        assert client.mesh(path).digest == digest_of(path)
    with pytest.raises(weft.DomainError, match="holds no geometry: 1 ring without an area is left out: "):
        weft.Domain.geojson({"type": "Polygon", "coordinates": [flat]})


@pytest.mark.parametrize("domain, words", [
    (np.zeros((3, 3)), r"\(3, 3\)"),
    (np.array([[0, 0], [1, np.nan], [1, 1]]), r"ring 0\[1\]"),
    (42, "int is no domain"),
    ([1, 2, 3], "list is no domain"),
    ("no.stl", "no.stl"),
    ({"type": "Circle", "coordinates": [0, 0]}, "'Circle'"),
    ({"type": "Polygon", "coordinates": [SQUARE, [["x", 1]] * 4]}, r"coordinates\[1\]"),
    ({"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": 3}]},
     r"features\[0\]\.geometry"),
    ({"type": "Feature", "properties": {"marker": 0.5},
      "geometry": {"type": "Polygon", "coordinates": [SQUARE]}}, "properties.marker is 0.5"),
])
def test_what_is_no_domain_is_refused_by_name(domain, words):
    with pytest.raises(weft.DomainError, match=words):
        weft.domain.as_domain(domain)


@pytest.mark.parametrize("arguments, words", [
    (([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 3)]), r"segments\[1\] names point 3 of 3"),
    (([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2)], [1]), "markers: 1 for 2 segments"),
    (([(0, 0), (1, 0), (0, 1)], [(0, 1.5)]), "segments: not integers"),
])
def test_what_is_no_graph_is_refused_by_name(arguments, words):
    with pytest.raises(weft.DomainError, match=words):
        weft.Domain(*arguments)


@pytest.mark.parametrize("text, words", [
    ("3 2 0 0\n1 0 0\n2 1 0\n", ("4: the file ends where a point should follow", "ends after 2 of 3 points")),
    ("1 2 0 0\n1 0 x\n", ("2:5: expected the y coordinate", "points: ")),
    ("1 2 0 0\n1 0 4.0Dx\n", ("2:5: expected the y coordinate", "points: ")),
    ("2 2 0 0\n5 0 0\n5 1 1\n0 0\n0\n", ("3:1: the point number is 5", "not numbered")),
    ("2 2 0 0\n5 0 0\n9 1 1\n1 0\n1 5 6\n0\n", ("5:5: .* which no point has; the numbers are from 5 to 9",
                                                "names the point 6; the numbers are from 5 to 9")),
])
def test_a_poly_that_is_wrong_is_refused_by_file_and_part(by, tmp_path, text, words):
    path = tmp_path / "bad.poly"
    path.write_text(text)
    with pytest.raises(weft.DomainError, match=f"bad.poly:.*{words[by == 'the package']}"):
        weft.Domain.read(path)


def named_features(*features):
    return {"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": at}}
        for kind, at, properties in features]}


NAMED = named_features(
    ("Polygon", [SQUARE], {"marker": "wall", "region": "fluid"}),
    ("LineString", [[1, 1], [2, 2]], {"marker": 1, "marker_name": "gauge"}),
    ("LineString", [[1, 2], [2, 3]], {"marker": "wall"}),
    ("Polygon", [[[5, 0], [9, 0], [9, 4], [5, 0]]],
     {"region": 4, "region_name": "solid", "marker": "", "max_area": 1}))


def test_names_of_geojson_come_with_the_mesh_and_markers_are_those_of_the_command_line(
        client, digest_of, tmp_path):
    path = tmp_path / "named.geojson"
    path.write_text(json.dumps(NAMED))
    mesh = client.mesh(path)
    assert mesh.digest == digest_of(path)
    assert mesh.marker_names == {1: "gauge", 2: "wall"}
    assert mesh.region_names == {1: "fluid", 4: "solid"}
    assert set(mesh.edge_markers) == {0, 1, 2}
    assert set(mesh.regions) == {1, 4}


def test_names_of_geojson_that_cannot_be_are_left_out_with_a_warning():
    features = named_features(
        ("LineString", [[1, 1], [2, 2]], {"marker": 1, "marker_name": "a"}),
        ("LineString", [[1, 1], [3, 2]], {"marker": 1, "marker_name": "b"}),
        ("LineString", [[1, 1], [4, 2]], {"marker": 2, "marker_name": "a"}),
        ("LineString", [[1, 1], [5, 2]], {"marker": "a\nb"}))
    with pytest.warns(weft.WeftWarning) as warned:
        domain = weft.Domain.geojson(features)
    assert domain.marker_names == {1: "a"}
    assert domain.markers.tolist() == [1, 1, 2, 3]
    assert [str(w.message) for w in warned] == [
        "a name of marker 1 is left out: the first is 'a'",
        "a name of marker 2 is left out: 'a' is another one's, too",
        "a name of marker 3 is left out: it has a control character"]


def test_names_of_a_poly_are_its_comments_and_values_that_are_no_integers(by, tmp_path):
    path = tmp_path / "named.poly"
    path.write_bytes(b"# marker=2:inlet \n3 2 0 0 # caf\xe9\n1 0 0\n2 1 0\n3 1 1\n3 1\n1 1 2 2\n2 2 3 3\n"
                     b"3 3 1 3\n0\n2\n1 .7 .2 0.0001 -1\n2 .7 .1 4 -1\n# marker=3:in # out: all\r\n"
                     b" # marker=7:no\n# marker=x:no\n# region=4:fluid\xe2\x80\xa8\n# region=99999999999:no\n")
    domain = weft.Domain.read(path)
    assert domain.marker_names == {2: "inlet ", 3: "in # out: all"}
    assert domain.region_names == {1: "1e-04", 4: "fluid\u2028"}


def test_names_that_the_command_line_reads_come_back(by, tmp_path):
    path = tmp_path / "rings.csv"
    path.write_text("x,y,marker\n0,0,quay\n1,0,2\n1,1,open-sea\n0,1,quay\n")
    domain = weft.Domain.read(path)
    assert domain.marker_names == {1: "quay", 3: "open-sea"}
    assert domain.markers.tolist() == [1, 2, 3, 1]


def test_what_is_odd_in_a_file_is_a_warning(by, tmp_path):
    path = tmp_path / "crossing.csv"
    path.write_text("0,0\n4,4\n4,0\n0,4\n")
    with pytest.warns(weft.WeftWarning, match="crosses itself"):
        weft.Domain.read(path)


def test_names_are_checked():
    triangle = ([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)])
    domain = weft.Domain(*triangle, marker_names={np.int32(2): "inlet", -1: "Wänd"},
                         region_names={2: "inlet"})
    assert domain.marker_names == {2: "inlet", -1: "Wänd"}
    assert domain.region_names == {2: "inlet"}
    for names, words in (({2: ""}, "0 bytes"), ({2: "é" * 128}, "256 bytes"),
                         ({2: "a\nb"}, "control character"), ({2: "a\x85"}, "control character"),
                         ({1: "a", 2: "a"}, "'a' is there twice"), ({2**31: "a"}, "32 bits"),
                         ({2: 3}, "no number of a text"), ({"2": "a"}, "no number of a text"),
                         ({2: "\ud800"}, "no number of a text")):
        with pytest.raises(weft.DomainError, match=words):
            weft.Domain(*triangle, marker_names=names)


HALF_DISK = """2 2 0
1 -1 0
2 1 0
2 1
1 1 2 5
2 2 1 6
0
# arc=2:1
"""


def test_arcs_are_followed_by_the_mesh(client, tmp_path):
    path = tmp_path / "half.poly"
    path.write_text(HALF_DISK)
    domain = weft.Domain.read(path)
    assert domain.arcs == {1: 1.0}
    mesh = client.mesh(domain, edge=0.02)
    x, y = mesh.points[np.unique(mesh.edges[mesh.edge_markers == 6])].T
    assert len(x) > 150 and np.abs(np.hypot(x, y) - 1).max() < 1e-15 * 8
    assert abs(mesh.summary.area - np.pi / 2) < 2e-4
    assert weft.mesh(domain, edge=0.02).digest == mesh.digest


def test_sides_of_second_order_follow_arcs(client, run_weft, tmp_path):
    path = tmp_path / "half.poly"
    path.write_text(HALF_DISK)
    mesh = client.mesh(weft.Domain.read(path))
    here = weft.mesh(weft.Domain.read(path))
    assert mesh.digest == here.digest and np.array_equal(mesh.edge_bulges, here.edge_bulges)
    turns = 4 * np.arctan(mesh.edge_bulges)
    assert abs(np.abs(turns).sum() - np.pi) < 1e-12 and (turns[mesh.edge_markers == 5] == 0).all()

    points, triangles = mesh.second_order()
    area = 0
    for k in range(3):  # sides are parabolas from p through q to r
        p, q, r = np.moveaxis(points[triangles[:, [k, 3 + k, (k + 1) % 3]]], 1, 0)
        area += (4 * (np.cross(p, q) + np.cross(q, r)) - np.cross(p, r)).sum() / 6
    assert abs(mesh.summary.area - np.pi / 2) > 0.03 and abs(area - np.pi / 2) < 1e-3

    mesh.write(tmp_path / "half.npz")
    again = weft.Mesh.read(tmp_path / "half.npz")
    assert np.array_equal(again.edge_bulges, mesh.edge_bulges)
    run_weft("check", tmp_path / "half.npz", "--domain", path)


def test_arcs_are_checked():
    square = ([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)])
    assert weft.Domain(*square, arcs={2: 1, np.int64(0): -0.5}).arcs == {0: -0.5, 2: 1.0}
    for arcs, words in (({3: 1}, "arcs: segment 3 of 3"), ({0: np.nan}, r"arcs\[0\] is nan")):
        with pytest.raises(weft.DomainError, match=words):
            weft.Domain(*square, arcs=arcs)
    with pytest.raises(weft.DomainError, match="longitude and latitude has no arcs"):
        weft.mesh(weft.Domain(*square, arcs={0: 1}), edge=10000, lonlat=True)


@pytest.mark.parametrize("comment", ["# arc=9:1", "# arc=2:x", "# arc=2:0.5"])
def test_arcs_of_a_poly_that_cannot_be_are_refused(by, tmp_path, comment):
    path = tmp_path / "half.poly"
    path.write_text(HALF_DISK + comment + "\n")
    with pytest.raises(weft.DomainError, match="# arc="):
        weft.Domain.read(path)
