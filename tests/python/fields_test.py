# SPDX-License-Identifier: Apache-2.0
"""Sizes by edge lengths, named fields and gradation."""

import os
import subprocess
import warnings

import numpy as np
import pytest
import weft
from conftest import KEY
from weft import _requests

SQUARE = weft.Domain(points=[[0, 0], [8, 0], [8, 8], [0, 8], [2, 4], [6, 4]],
                     segments=[[0, 1], [1, 2], [2, 3], [3, 0], [4, 5]], markers=[1, 1, 1, 1, 7])


def centroids(mesh):
    return mesh.points[mesh.triangles].mean(axis=1)


def edges_allowed(mesh):
    """Of each triangle, the edge of the equilateral one with its area."""
    return np.sqrt(mesh.quality().areas * 4 / np.sqrt(3))


def distance(p, a, b):
    """Of points (n, 2) to the segment from a to b."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    t = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
    return np.hypot(*(p - a - t[:, None] * (b - a)).T)


def test_an_edge_bounds_areas_by_an_equilateral_triangle_and_is_the_mean_edge(client):
    mesh = client.mesh(SQUARE, edge=0.1)
    assert edges_allowed(mesh).max() <= 0.1
    corners = mesh.points[mesh.triangles]
    lengths = np.hypot(*(corners - np.roll(corners, 1, axis=1)).reshape(-1, 2).T)
    assert lengths.mean() == pytest.approx(0.1, rel=0.03)


def test_an_edge_may_be_a_function_or_a_raster(client):
    by_expression = client.mesh(SQUARE, edge="0.1 + 0.02*x")
    by_function = client.mesh(SQUARE, edge=lambda x, y: 0.1 + 0.02 * x)
    assert by_function.summary.triangles == pytest.approx(by_expression.summary.triangles, rel=0.02)


def test_size_and_edge_exclude_each_other(client):
    with pytest.raises(ValueError, match="exclude each other"):
        client.mesh(SQUARE, size=1, edge=1)


def test_a_distance_to_marked_segments_grades_the_mesh(client):
    mesh = client.mesh(SQUARE, edge="0.05 + 0.2*wall", fields={"wall": weft.distance(marker=7)})
    bound = 0.05 + 0.2 * distance(centroids(mesh), (2, 4), (6, 4))
    assert (edges_allowed(mesh) <= bound * (1 + 1e-9)).all()
    assert mesh.summary.triangles < 4000


def test_a_distance_to_points_and_to_their_segments(client):
    ends = [[9, 9], [9, -1]]
    to_points = client.mesh(SQUARE, edge="0.1*d", fields={"d": weft.distance(points=ends)})
    p = centroids(to_points)
    nearest = np.min([np.hypot(*(p - end).T) for end in ends], axis=0)
    assert (edges_allowed(to_points) <= 0.1 * nearest * (1 + 1e-9)).all()
    to_line = client.mesh(SQUARE, edge="0.1*d",
                          fields={"d": weft.distance(points=ends, segments=[[0, 1]])})
    p = centroids(to_line)
    assert (edges_allowed(to_line) <= 0.1 * distance(p, *ends) * (1 + 1e-9)).all()


def test_a_raster_may_be_negative_and_undefined_if_guarded(client):
    values = np.full((9, 9), -4.0)
    values[:, 5:] = np.nan
    depth = weft.raster(values, origin=(0, 0), spacing=(1, 1))
    mesh = client.mesh(SQUARE, edge="coalesce(abs(depth)/10, 0.2)", fields={"depth": depth})
    left = centroids(mesh)[:, 0] < 4
    assert edges_allowed(mesh)[left].max() <= 0.4
    assert edges_allowed(mesh)[~left].max() <= 0.2
    with pytest.raises(weft.InvalidRequest, match="depth is undefined"):
        client.mesh(SQUARE, edge="abs(depth)/10", fields={"depth": depth})


def bands_file(path, values, names, kind="GDT_Float32", driver="GTiff"):
    """A raster with one value in each band, around the domain."""
    gdal = pytest.importorskip("osgeo.gdal")
    data = gdal.GetDriverByName("MEM").Create("", 2, 2, len(values), getattr(gdal, kind))
    data.SetGeoTransform((-100, 100, 0, 100, 0, -100))
    for i, (value, name) in enumerate(zip(values, names)):
        data.GetRasterBand(i + 1).Fill(value)
        data.GetRasterBand(i + 1).SetDescription(name)
    gdal.GetDriverByName(driver).CreateCopy(str(path), data)
    return path


def raster_file(path, values, left, top, step, overviews=()):
    """A GeoTIFF whose first row is the northmost."""
    gdal = pytest.importorskip("osgeo.gdal")
    data = gdal.GetDriverByName("GTiff").Create(str(path), *values.shape[::-1], 1, gdal.GDT_Float32)
    data.SetGeoTransform((left, step, 0, top, 0, -step))
    data.GetRasterBand(1).SetNoDataValue(-1)
    data.GetRasterBand(1).WriteArray(values)
    if overviews:
        data.BuildOverviews("NEAREST", list(overviews))
    return path


def test_of_a_raster_file_the_part_is_read_that_the_domain_needs(client, digest_of, tmp_path):
    values = np.random.default_rng(2).uniform(0.1, 0.4, (400, 600)).astype(np.float32)
    values[90:110, 200:230] = -1
    file = raster_file(tmp_path / "h.tif", values, -300, 300, 1)
    domain = tmp_path / "box.geojson"
    domain.write_text('{"type": "Polygon", "coordinates": [[[-2, 3], [40, 5], [5, 31], [-2, 3]]]}')
    request = _requests.mesh_request(weft.Domain.read(domain), None, 20, {
        "edge": "h", "fields": {"h": weft.raster(file)}})
    raster = request.size.fields[0].raster
    assert (raster.columns, raster.rows) == (42 + 4, 28 + 4)
    assert (raster.x, raster.y) == (-3.5, 1.5)
    np.testing.assert_array_equal(np.array(raster.values).reshape(32, 46),
                                  values[::-1][101:133, 296:342])
    mesh = client.mesh(domain, edge="h", fields={"h": weft.raster(file)})
    assert mesh.digest == digest_of(domain, "--edge", "h", "--field", f"h={file}")


@pytest.mark.parametrize("overviews", [(), (2, 4)])
def test_a_raster_file_of_too_many_values_is_reduced_as_on_the_command_line(
        client, digest_of, tmp_path, overviews):
    values = np.random.default_rng(3).uniform(1, 9, (4200, 4300)).astype(np.float32)
    values[1000:1101, 1500:2001] = -1
    file = raster_file(tmp_path / "h.tif", values, -5, 4205, 1, overviews)
    domain = tmp_path / "box.geojson"
    domain.write_text('{"type": "Polygon", "coordinates": [[[1, 6], [4290, 6], [4290, 4200], [1, 6]]]}')
    edge = "coalesce(100 + 10*h, 50)"
    with pytest.warns(weft.WeftWarning, match=r"resolution of \(2, 2\), not its own of \(1, 1\), because"):
        mesh = client.mesh(domain, edge=edge, fields={"h": weft.raster(file)})
    assert mesh.digest == digest_of(domain, "--edge", edge, "--field", f"h={file}")


def test_a_raster_file_goes_on_over_its_seam_as_on_the_command_line(client, digest_of, tmp_path):
    values = np.random.default_rng(4).uniform(0.5, 2, (180, 360)).astype(np.float32)
    file = raster_file(tmp_path / "globe.tif", values, -180, 90, 1)
    domain = tmp_path / "box.geojson"
    domain.write_text('{"type": "Polygon", "coordinates": [[[170, 0], [190, 0], [190, 20], [170, 0]]]}')
    mesh = client.mesh(domain, edge="h", fields={"h": weft.raster(file)})
    assert mesh.digest == digest_of(domain, "--edge", "h", "--field", f"h={file}")


def test_raster_files_share_what_a_server_takes_and_no_more(client, digest_of, tmp_path):
    def file(name, side):
        values = np.add.outer(np.arange(side) % 7, np.arange(side) % 5).astype(np.float32)
        return raster_file(tmp_path / name, values, 0, 8, 8 / side)

    def warned(**files):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            mesh = client.mesh(box, edge="1 + 0.01*(a + b)", fields=dict(zip(
                files, map(weft.raster, files.values()))))
        flags = [flag for name, path in files.items() for flag in ("--field", f"{name}={path}")]
        assert mesh.digest == digest_of(box, "--edge", "1 + 0.01*(a + b)", *flags)
        return [str(warning.message) for warning in caught]

    box = tmp_path / "box.geojson"
    box.write_text('{"type": "Polygon", "coordinates": [[[0, 0], [8, 0], [8, 8], [0, 8], [0, 0]]]}')
    large = file("large.tif", 3000)
    assert warned(a=large, b=file("small.tif", 30)) == []
    said = warned(a=large, b=file("other.tif", 3000))
    assert len(said) == 2 and all("more than 8,388,608" in sentence for sentence in said)


def test_a_raster_file_with_a_fault_says_what_is_wrong(client, tmp_path):
    file = raster_file(tmp_path / "h.tif", np.ones((4, 4), np.float32), 1000, 1000, 1)
    for field, words in ((weft.raster(file), r"\(1000, 996\) to \(1004, 1000\), does not meet the domain's box, "
                                             r"\(0, 0\) to \(8, 8\)"),
                         (weft.raster(file, band=2), "h.tif: has no band '2'; there are 1$"),
                         (weft.raster(tmp_path / "none.tif"), "none.tif")):
        with pytest.raises(weft.DomainError, match=words):
            client.mesh(SQUARE, edge="h", fields={"h": field})


def value_of(file, band=None):
    request = _requests.mesh_request(SQUARE, None, 20, {"edge": "h", "fields": {
        "h": weft.raster(file, band=band)}})
    return request.size.fields[0].raster.values[0]


def refusal_by_command(server, file, band=None):
    """What the command line says of a raster that must be refused."""
    source = file if band is None else f"{file}:{band}"
    done = subprocess.run([os.environ["WEFT_BINARY"], "mesh", KEY, "-o", file.with_suffix(".vtu"), "--edge",
                           "h", "--field", f"h={source}", "--server", server.target],
                          capture_output=True, text=True)
    assert done.returncode != 0
    return done.stderr


def test_a_band_is_chosen_by_number_or_name_as_on_the_command_line(server, tmp_path):
    file = bands_file(tmp_path / "h.tif", (1, 2, 3), ("depth", "", "speed"))
    for band, value in ((1, 1), (np.int64(2), 2), ("3", 3), ("depth", 1), ("speed", 3)):
        assert value_of(file, band) == value
    for band, words in ((None, "has 3 bands; "), ("height", "has no band 'height'; "), (0, "has no band '0'; "),
                        (4, "has no band '4'; "), ("1x", "has no band '1x'; "),
                        ("1:2", "has no band '1:2'; "),
                        ("9" * 5000, "has no band '999")):
        with pytest.raises(weft.DomainError) as caught:
            value_of(file, band)
        assert str(caught.value).startswith(f"{file}: {words}")
        assert str(caught.value).endswith("; there are 1 'depth', 2, 3 'speed'")
        if band != "9" * 5000:
            said = refusal_by_command(server, file, band)
            assert f"{file}: {words}" in said and "; there are 1 'depth', 2, 3 'speed'" in said


def test_the_only_band_is_that_which_is_not_for_transparency(tmp_path):
    gdal = pytest.importorskip("osgeo.gdal")
    file = bands_file(tmp_path / "h.tif", (255, 5), ("", ""))
    data = gdal.Open(str(file), gdal.GA_Update)
    data.GetRasterBand(1).SetColorInterpretation(gdal.GCI_AlphaBand)
    data.GetRasterBand(2).SetColorInterpretation(gdal.GCI_GrayIndex)
    del data
    assert value_of(file) == 5


def test_a_variable_of_several_is_chosen_by_number_or_name_as_on_the_command_line(server, tmp_path):
    file = bands_file(tmp_path / "h.nc", (1, 2), ("", ""), driver="netCDF")
    for band, value in ((1, 1), (2, 2), ("Band2", 2), ("Band2:1", 2)):
        assert value_of(file, band) == value
    for band, words in ((None, "has 2 variables; "), ("depth", "has no variable 'depth'; ")):
        with pytest.raises(weft.DomainError, match="; there are 1 'Band1', 2 'Band2'$") as caught:
            value_of(file, band)
        assert str(caught.value).startswith(f"{file}: {words}")
        assert f"{file}: {words}" in refusal_by_command(server, file, band)


def test_a_band_of_complex_numbers_is_refused_by_file_and_band_as_on_the_command_line(server, tmp_path):
    file = bands_file(tmp_path / "h.tif", (1, 2), ("", "phase"), kind="GDT_CFloat32")
    for band, name in ((1, "1"), ("phase", "2 'phase'")):
        with pytest.raises(weft.DomainError) as caught:
            value_of(file, band)
        assert str(caught.value) == f"{file}: the values of band {name} are complex numbers"
        assert str(caught.value) in refusal_by_command(server, file, band)


def test_a_mesh_may_be_refined_by_what_was_found_on_an_earlier_one(client):
    mesh = client.mesh(SQUARE, edge=1)
    for _ in range(3):
        h = 0.02 + 0.3 * np.hypot(*(mesh.points - 3).T)
        mesh = client.mesh(SQUARE, edge=weft.on_mesh(mesh, h))
    bound = 0.02 + 0.3 * np.hypot(*(centroids(mesh) - 3).T)
    ratio = edges_allowed(mesh) / bound
    assert np.percentile(ratio, 99) < 1.05
    assert mesh.summary.triangles > 500


def test_a_field_alone_is_a_size(client):
    coarse = client.mesh(SQUARE, edge=1)
    field = weft.on_mesh(coarse, 0.2 + 0.1 * coarse.points[:, 0])
    named = client.mesh(SQUARE, edge="h", fields={"h": field})
    assert client.mesh(SQUARE, edge=field).digest == named.digest
    assert client.mesh(SQUARE, field).digest == client.mesh(SQUARE, "h", fields={"h": field}).digest
    with pytest.raises(weft.InvalidRequest) as caught:
        client.mesh(SQUARE, edge=weft.distance(marker=77))
    assert [violation.argument for violation in caught.value.violations] == ["edge"]
    with pytest.raises(ValueError, match="edge is a field, and fields has another of that name"):
        client.mesh(SQUARE, edge=field, fields={"edge": field})


def test_a_size_of_no_kind_is_refused_in_one_line(client):
    with pytest.raises(weft.DomainError) as caught:
        client.mesh(SQUARE, size=[weft.distance(), np.zeros(1000)])
    assert len(str(caught.value)) < 200


def test_a_gradation_limits_how_edges_grow(client):
    jump = "hypot(x-4, y-1) < 0.5 ? 0.02 : 2"
    steep = client.mesh(SQUARE, edge=jump)
    graded = client.mesh(SQUARE, edge=jump, gradation=0.15)
    assert graded.summary.triangles > 1.5 * steep.summary.triangles
    away = np.maximum(np.hypot(*(centroids(graded) - (4, 1)).T) - 0.5, 0)
    assert (edges_allowed(graded) <= 0.02 + 0.15 * away + 1e-9).all()


def test_the_width_of_a_channel(client):
    channel = weft.Domain(points=[[0, 0], [40, 0], [40, 1], [0, 1]],
                          segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    mesh = client.mesh(channel, edge="w/4", fields={"w": weft.width()})
    middle = np.abs(centroids(mesh)[:, 0] - 20) < 10
    assert edges_allowed(mesh)[middle].max() <= 0.27


@pytest.mark.parametrize("make, words", [
    (lambda: weft.raster([1.0, 2.0], origin=(0, 0), spacing=(1, 1)), r"shape \(2,\)"),
    (lambda: weft.raster([[1.0, np.inf]], origin=(0, 0), spacing=(1, 1)), "column 1 of row 0"),
    (lambda: weft.raster([[1.0]]), "needs origin and spacing"),
    (lambda: weft.distance(segments=[[0, 1]]), "without points"),
    (lambda: weft.distance(marker=1, points=[[0, 0]]), "exclude each other"),
    (lambda: weft.distance(points=[1, 2, 3]), r"expected \(n, 2\)"),
    (lambda: weft.on_mesh(([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]), [1, 2]), "for 3 points"),
])
def test_fields_with_a_fault_say_what_is_wrong(make, words):
    with pytest.raises(weft.DomainError, match=words):
        make()


@pytest.mark.parametrize("field, words", [
    (3, "is 3, not a field"),
    (None, "is None, not a field"),
    (weft.distance, r"is the function distance, not a field; .*weft.distance\(\.\.\.\)"),
    (weft.Raster([[1.0]], (0, 0), (1, 1)), r"is Raster\("),
])
def test_what_is_no_field_is_refused_by_name(client, field, words):
    with pytest.raises(weft.DomainError, match=r"fields\['d'\] " + words):
        client.mesh(SQUARE, edge="1 + d", fields={"d": field})


@pytest.mark.parametrize("request_options, words", [
    ({"size": 1000}, "edges of 48[.][0-9]+ or more in a domain that is 8 by 8; is it in another unit"),
    ({"edge": 9.5}, "edges of 9.5 or more in a domain that is 8 by 8;"),
    ({"edge": weft.Raster([[9e5, 1e6]], (0, 0), (8, 8))}, r"edges of 9[.][0-9]+e\+05 or more"),
    ({"edge": weft.Raster([[1, 2]], (0, 0), (8, 8))},
     "its nodes are 8 apart, and the least edge is 1; details between the nodes are missed"),
    ({"edge": "50 + x"}, "edges of 5[0-9.]+ or more"),
    ({"edge": "wide/8", "fields": {"wide": weft.width(), "wid": weft.distance()}},
     "^the size does not name the field 'wid'$"),
    ({"edge": 1, "fields": {"d": weft.distance()}}, "does not name the field 'd'"),
])
def test_a_size_that_is_hardly_meant_gives_a_warning(client, request_options, words):
    with pytest.warns(weft.WeftWarning, match=words) as caught:
        client.mesh(SQUARE, **request_options)
    assert [warning.filename for warning in caught] == [__file__]


def test_a_size_that_is_meant_gives_no_warning(client):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        client.mesh(SQUARE, edge="1 + d", fields={"d": weft.distance()})
        client.mesh(SQUARE, edge=8)
        client.mesh(SQUARE, edge=lambda x, y: 0.01 + 0.1 * x)


def test_a_warning_of_a_size_is_that_of_the_command_line(client, server, tmp_path):
    domain = tmp_path / "box.geojson"
    domain.write_text('{"type": "Polygon", "coordinates": [[[0, 0], [0.1, 0], [0.1, 1e-7], [0, 0]]]}')
    with pytest.warns(weft.WeftWarning) as caught:
        client.mesh(domain, edge=123456, fields={"d": weft.distance()})
    said = subprocess.run([os.environ["WEFT_BINARY"], "mesh", domain, "--edge", "123456", "--field",
                           "d=distance", "--server", server.target, "-o", tmp_path / "m.vtu"],
                          capture_output=True, text=True)
    for warning in caught:
        assert str(warning.message) in said.stdout + said.stderr
    assert len(caught) == 2


def test_an_unknown_name_is_refused_with_a_suggestion(client):
    with pytest.raises(weft.InvalidRequest, match="did you mean 'coast'"):
        client.mesh(SQUARE, edge="1 + cost", fields={"coast": weft.distance()})


def edge_lengths(mesh):
    return np.hypot(*(mesh.points[mesh.edges[:, 0]] - mesh.points[mesh.edges[:, 1]]).T)


def test_a_size_at_a_marker_bounds_the_edges_that_carry_it(client):
    mesh = client.mesh(SQUARE, edge_at={7: 0.1})
    marked = mesh.edge_markers == 7
    assert edge_lengths(mesh)[marked].max() <= 0.1 * (1 + 1e-9)
    assert edge_lengths(mesh)[~marked].max() > 1


def test_a_gradation_within_the_domain_grows_around_land(client, digest_of, tmp_path):
    domain = tmp_path / "u.geojson"
    domain.write_text('{"type": "Polygon", "coordinates":'
                      '[[[0,0], [8,0], [8,8], [5,8], [5,1], [3,1], [3,8], [0,8], [0,0]]]}')
    spot = "hypot(x-1, y-7) < 0.25 ? 0.02 : 20"
    across = client.mesh(domain, edge=spot, gradation=0.15)
    within = client.mesh(domain, edge=spot, gradation=0.15, gradation_within=True)
    beyond = [np.sum((mesh.points[:, 0] > 5) & (mesh.points[:, 1] > 1.5)) for mesh in (across, within)]
    assert beyond[1] < 0.5 * beyond[0]
    assert within.digest == digest_of(domain, "--edge", spot, "--gradation", 0.15, "--gradation-within")
    assert across.digest == client.mesh(domain, edge=spot, gradation=0.15, gradation_within=False).digest


def test_a_gradation_within_the_domain_needs_a_gradation(client):
    with pytest.raises(ValueError, match="gradation_within needs gradation"):
        client.mesh(SQUARE, edge=1, gradation_within=True)


def test_a_size_at_a_marker_grows_by_the_gradation(client):
    mesh = client.mesh(SQUARE, edge=2, edge_at={7: 0.1}, gradation=0.2)
    bound = np.minimum(2, 0.1 + 0.2 * distance(centroids(mesh), (2, 4), (6, 4)))
    assert (edges_allowed(mesh) <= bound * (1 + 1e-9)).all()
    assert edge_lengths(mesh)[mesh.edge_markers == 7].max() <= 0.1 * (1 + 1e-9)
    assert mesh.summary.triangles > 1.5 * client.mesh(SQUARE, edge=2, edge_at={7: 0.1}).summary.triangles


def test_a_size_at_a_marker_is_that_of_the_command_line(client, digest_of, tmp_path):
    domain = tmp_path / "box.geojson"
    domain.write_text('{"type": "Feature", "properties": {"marker": 3, "max_edge": 0.5}, "geometry":'
                      '{"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 0]]]}}')
    mesh = client.mesh(domain, edge_at={3: 0.1}, gradation=0.3)
    assert mesh.digest == digest_of(domain, "--edge-at", "marker=3:0.1", "--gradation", 0.3)
    assert mesh.digest != client.mesh(domain, edge_at={3: 0.2}, gradation=0.3).digest
    assert edges_allowed(mesh).max() <= 0.5 * (1 + 1e-12)


NAMED = weft.Domain(SQUARE.points, SQUARE.segments, SQUARE.markers,
                    marker_names={1: "wall", 7: "inlet"})


def test_a_marker_may_be_named(client):
    by_number = client.mesh(NAMED, edge="0.1 + 0.2*d", edge_at={7: 0.1},
                            fields={"d": weft.distance(marker=[1, 7])})
    by_name = client.mesh(NAMED, edge="0.1 + 0.2*d", edge_at={"inlet": 0.1},
                          fields={"d": weft.distance(marker=("wall", 7))})
    assert by_name.digest == by_number.digest
    assert client.mesh(NAMED, edge="0.1 + d", fields={"d": weft.distance(marker="inlet")}).digest == (
        client.mesh(NAMED, edge="0.1 + d", fields={"d": weft.distance(marker=np.int64(7))}).digest)


@pytest.mark.parametrize("domain, marker, words", [
    (NAMED, "outlet", "no marker of the domain is named 'outlet': there are wall, inlet"),
    (SQUARE, "inlet", "no marker of the domain is named 'inlet': it names none"),
    (NAMED, 2.5, "the marker 2.5 is neither a number nor a name"),
    (NAMED, 1 << 31, "the marker 2147483648 is not a number of 32 bits"),
])
def test_a_marker_that_the_domain_does_not_know_is_refused_by_name(client, domain, marker, words):
    with pytest.raises(weft.DomainError, match=words):
        client.mesh(domain, edge_at={marker: 0.1})
    with pytest.raises(weft.DomainError, match=words):
        client.mesh(domain, edge="1 + d", fields={"d": weft.distance(marker=marker)})


def test_a_size_at_a_marker_that_no_segment_has_is_refused_by_name(client):
    with pytest.raises(weft.InvalidRequest, match="marker of no segment") as caught:
        client.mesh(SQUARE, edge_at={7: 1, 8: 1})
    assert caught.value.violations[0].field == "size.at[1].marker"


D = {"fields": {"d": weft.distance()}}


@pytest.mark.parametrize("options, field, argument", [
    ({"edge": "d + coast", "fields": {"d": weft.distance(), "coast": weft.distance(marker=3)}},
     "size.fields[1].distance.markers", "fields['coast']"),
    ({"edge": "1 +", **D}, "size.expression", "edge"),
    ({"size": "1 +", **D}, "size.expression", "size"),
    ({"edge": -1}, "size.constant", "edge"),
    ({"edge": "x - 3"}, "size", "edge"),
    ({"size": "x - 3"}, "size", "size"),
    ({"edge_at": {7: 1, 8: 1}}, "size.at[1].marker", "edge_at[8]"),
    ({"edge_at": {"inlet": -1}}, "size.at[0].max_edge", "edge_at['inlet']"),
    ({"edge": 1, "gradation": -1}, "size.gradation", "gradation"),
    ({"edge": 1, "cells_across": -1}, "size.cells_across", "cells_across"),
    ({"points_per_circle": 1e6}, "size.points_per_circle", "points_per_circle"),
    ({"min_angle": 99}, "quality.min_angle_deg", "min_angle"),
    ({"min_edge": -1}, "quality.min_edge", "min_edge"),
    ({"keep": [7, 8]}, "quality.keep.markers[1]", "keep"),
    ({"periodic": [(7, 8)]}, "quality.periodic[0]", "periodic"),
    ({"layers": {7: weft.Layers(1, 5), 8: weft.Layers(-1, 5)}}, "quality.layers[1].first", "layers"),
    ({"optimise": 99}, "quality.optimise", "optimise"),
    ({"snap": -1}, "domain.snap", "snap"),
    ({"max_seconds": -1}, "budget.max_seconds", "max_seconds"),
])
def test_an_error_names_the_argument_and_the_field_on_the_wire(client, job_server, options, field, argument):
    domain = weft.Domain(SQUARE.points, SQUARE.segments, SQUARE.markers, marker_names={7: "inlet"})
    with pytest.raises(weft.InvalidRequest) as caught:
        client.mesh(domain, **options)
    told = [(violation.field, violation.argument) for violation in caught.value.violations]
    assert told == [(field, argument)]
    assert f"\n  argument {argument}, field {field}\n" in str(caught.value)


def test_an_error_of_a_submission_names_the_argument_too(job_server):
    with weft.Client(job_server.target) as client, pytest.raises(weft.InvalidRequest) as caught:
        client.submit(SQUARE, edge="1 +")
    assert caught.value.violations[0].argument == "edge"


def test_an_error_names_the_field_alone_if_no_argument_is_known():
    from weft import _arguments, _requests
    request = _requests.mesh_request(SQUARE, None, 20, {"edge_at": {7: 1}})
    for field in ("size.fields[0]", "size.at[1].marker", "size", "sizes", "domain.points[3].x", ""):
        assert _arguments.argument_of(field, request) == ""
    assert _arguments.argument_of("size.at[0]", None) == ""


def test_a_region_may_have_a_length_of_edges(client):
    seed = {"x": 1, "y": 1, "id": 4}
    ring = dict(points=SQUARE.points[:4], segments=SQUARE.segments[:4])
    by_edge = client.mesh(weft.Domain(**ring, regions=[weft.Region(**seed, max_edge=0.5)]))
    area = np.sqrt(3) / 4 * 0.25
    by_area = client.mesh(weft.Domain(**ring, regions=[weft.Region(**seed, max_area=area)]))
    assert edges_allowed(by_edge).max() <= 0.5 * (1 + 1e-12)
    assert by_edge.digest == by_area.digest
