# SPDX-License-Identifier: Apache-2.0
"""Domains in longitude and latitude: the same meshes as on the command line."""

import json
import subprocess
import sys

import numpy as np
import pyproj
import pytest
import weft
from conftest import MODELS

COAST = MODELS / "us-east-coast.geojson"
SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]
GROUND = pyproj.Geod(ellps="WGS84")
RINGS = {
    "tall": [(10, 40), (12, 40), (12, 52), (10, 52)],
    "wide": [(-100, 41), (-80, 40), (-80, 46), (-100, 46)],
    "equator": [(5, -2), (40, -2), (40, 2), (5, 2)],
    "date line by a jump": [(175, -20), (-178, -20), (-178, -12), (175, -12)],
    "date line beyond 180": [(175, -20), (182, -20), (182, -12), (175, -12)],
    "pole": [(lon, 80) for lon in range(0, 360, 30)],
    "south pole": [(lon - 180, -75) for lon in range(0, 360, 45)],
    "round": [(20, 60), (29, 58), (30, 64), (21, 66)],
    "one corner": [(0, 0), (1, 0), (0, 1)],
}


def ring_file(folder, ring):
    file = folder / "ring.geojson"
    file.write_text(json.dumps({"type": "Polygon", "coordinates": [[*ring, ring[0]]]}))
    return file


def read_npz(run_weft, server, folder, *arguments):
    run_weft("mesh", "--quiet", "--server", server.target, "-o", folder / "cli.npz", *arguments)
    with np.load(folder / "cli.npz") as arrays:
        return arrays["points"][:, :2], arrays["triangles"]


@pytest.mark.parametrize("ring", RINGS.values(), ids=RINGS.keys())
def test_a_domain_is_projected_as_on_the_command_line(client, server, run_weft, tmp_path, ring):
    domain = ring_file(tmp_path, ring)
    mesh = client.mesh(domain, edge=200_000, lonlat=True)
    points, triangles = read_npz(run_weft, server, tmp_path, domain, "--lonlat", "--edge", 200_000)
    np.testing.assert_array_equal(mesh.triangles, triangles)
    np.testing.assert_allclose(mesh.points, points, rtol=0, atol=1e-9)
    inputs = mesh.input_points[mesh.input_points[:, 1] < len(ring)]
    np.testing.assert_array_equal(mesh.points[inputs[:, 0]], np.array(ring)[inputs[:, 1]])


def test_a_coast_is_meshed_in_metres_with_edges_of_the_length_asked_for(client, digest_of):
    mesh = client.mesh(COAST, edge=20_000, lonlat=True)
    assert mesh.digest == digest_of(COAST, "--lonlat", "--edge", 20_000)
    a, b = mesh.points[mesh.triangles], np.roll(mesh.points[mesh.triangles], -1, axis=1)
    lengths = GROUND.inv(*a.reshape(-1, 2).T, *b.reshape(-1, 2).T)[2]
    assert 0.7 < np.median(lengths) / 20_000 < 1.03


def test_the_projection_may_be_named_and_the_mesh_left_in_metres(client, digest_of, tmp_path):
    domain = ring_file(tmp_path, RINGS["one corner"])
    mesh = client.mesh(domain, edge=20_000, crs="EPSG:32631", to_metres=True)
    assert mesh.points[:, 0].max() > 100_000
    assert mesh.digest == digest_of(domain, "--crs", "EPSG:32631", "--edge", 20_000)


def test_holes_and_regions_are_projected(client, tmp_path):
    box = np.array([(0, 0), (2, 0), (2, 2), (0, 2)])
    inner = 0.5 + box / 4
    domain = weft.Domain(np.concatenate([box, inner, inner + 0.6]),
                         [(i, i - 3 if i % 4 == 3 else i + 1) for i in range(12)],
                         holes=[(0.75, 0.75)], regions=[weft.Region(1.35, 1.35, 5, max_edge=5000)])
    mesh = client.mesh(domain, lonlat=True)
    centroids = mesh.points[mesh.triangles].mean(axis=1)
    assert not (np.abs(centroids - 0.75) < 0.25).all(axis=1).any()
    fine = mesh.regions == 5
    assert (fine == (np.abs(centroids - 1.35) < 0.25).all(axis=1)).all() and fine.sum() > 100


def test_fields_are_projected_along(client, digest_of, tmp_path):
    domain = ring_file(tmp_path, RINGS["round"])
    lines = tmp_path / "lines.geojson"
    lines.write_text('{"type": "LineString", "coordinates": [[22, 60], [25, 62], [28, 61]]}')
    edge = "20000 + 0.1*d"
    given = weft.distance(points=[(22, 60), (25, 62), (28, 61)], segments=[(0, 1), (1, 2)])
    mesh = client.mesh(domain, edge=edge, fields={"d": given}, lonlat=True)
    assert mesh.digest == digest_of(domain, "--lonlat", "--edge", edge, "--field",
                                    f"d=distance:{lines}")
    again = client.mesh(domain, edge="h", lonlat=True,
                        fields={"h": weft.on_mesh(mesh, np.full(len(mesh.points), 30_000.0))})
    assert again.summary.triangles == pytest.approx(
        client.mesh(domain, edge=30_000, lonlat=True).summary.triangles, rel=0.05)


def test_a_raster_is_projected_as_on_the_command_line(client, server, run_weft, tmp_path):
    gdal = pytest.importorskip("osgeo.gdal")
    osr = pytest.importorskip("osgeo.osr")
    domain = ring_file(tmp_path, RINGS["round"])
    x, y = np.meshgrid(np.arange(18, 33, 0.25), np.arange(68, 55, -0.25))
    file = tmp_path / "h.tif"
    data = gdal.GetDriverByName("GTiff").Create(str(file), x.shape[1], x.shape[0], 1, gdal.GDT_Float32)
    data.SetGeoTransform((18 - 0.125, 0.25, 0, 68 + 0.125, 0, -0.25))
    system = osr.SpatialReference()
    system.ImportFromEPSG(4326)
    data.SetProjection(system.ExportToWkt())
    wanted = (20_000 + 5_000 * np.sin(x) + 5_000 * np.cos(y)).astype(np.float32)
    data.GetRasterBand(1).WriteArray(wanted)
    del data
    as_array = weft.raster(wanted[::-1], origin=(18, y.min()), spacing=(0.25, 0.25))
    by_command = len(read_npz(run_weft, server, tmp_path, domain, "--lonlat", "--edge", "h",
                              "--field", f"h={file}")[1])
    for field in (weft.raster(file), as_array):
        mesh = client.mesh(domain, edge="h", fields={"h": field}, lonlat=True)
        assert mesh.summary.triangles == pytest.approx(by_command, rel=0.01)


def test_a_raster_in_grads_goes_on_over_its_seam_as_on_the_command_line(client, server, run_weft, tmp_path):
    """Of NTF (Paris), whose turn has 400 grads, and is 2.33722917 degrees east of Greenwich."""
    gdal = pytest.importorskip("osgeo.gdal")
    osr = pytest.importorskip("osgeo.osr")
    domain = ring_file(tmp_path, RINGS["date line by a jump"])
    x, y = np.meshgrid(np.arange(-199.5, 200), np.arange(99.5, -100, -1))
    file = tmp_path / "globe.tif"
    data = gdal.GetDriverByName("GTiff").Create(str(file), 400, 200, 1, gdal.GDT_Float32)
    data.SetGeoTransform((-200, 1, 0, 100, 0, -1))
    system = osr.SpatialReference()
    system.ImportFromEPSG(4807)
    data.SetProjection(system.ExportToWkt())
    data.GetRasterBand(1).WriteArray(60_000 + 20_000 * np.cos(2 * np.pi / 400 * 8 * x))
    del data
    by_command, _ = read_npz(run_weft, server, tmp_path, domain, "--lonlat", "--edge", "h",
                             "--field", f"h={file}")
    mesh = client.mesh(domain, edge="h", fields={"h": weft.raster(file)}, lonlat=True)
    assert len(mesh.points) == pytest.approx(len(by_command), rel=0.01)
    by_formula = client.mesh(domain, edge="h", lonlat=True, fields={"h": weft.raster(
        60_000 + 20_000 * np.cos(np.deg2rad(8 * (np.arange(170, 190, 0.5) - 2.33722917)))[None].repeat(40, 0),
        origin=(170, -26), spacing=(0.5, 0.5))})
    assert len(mesh.points) == pytest.approx(len(by_formula.points), rel=0.02)


def test_of_a_raster_file_only_the_part_is_read_that_the_plane_needs(
        client, server, run_weft, tmp_path, monkeypatch):
    gdal = pytest.importorskip("osgeo.gdal")
    x, y = np.meshgrid(np.arange(-179.5, 180), np.arange(89.5, -90, -1))
    file = tmp_path / "globe.tif"
    data = gdal.GetDriverByName("GTiff").Create(str(file), 360, 180, 1, gdal.GDT_Float32)
    data.SetGeoTransform((-180, 1, 0, 90, 0, -1))
    data.GetRasterBand(1).WriteArray((90_000 + 20_000 * np.sin(x) + 20_000 * np.cos(y)))
    del data
    sizes, read = [], weft._raster_file.RasterFile.read

    def counted(self, grid, column, row, columns, rows):
        sizes.append(columns * rows)
        return read(self, grid, column, row, columns, rows)

    monkeypatch.setattr(weft._raster_file.RasterFile, "read", counted)
    for name, most in (("round", 30 * 20), ("date line by a jump", 30 * 20), ("pole", 360 * 30)):
        domain = ring_file(tmp_path, RINGS[name])
        with pytest.warns(weft.WeftWarning, match="no coordinate system; .*EPSG:4326"):
            mesh = client.mesh(domain, edge="h", fields={"h": weft.raster(file)}, lonlat=True)
        by_command = len(read_npz(run_weft, server, tmp_path, domain, "--lonlat", "--edge", "h",
                                  "--field", f"h={file}")[1])
        assert mesh.summary.triangles == pytest.approx(by_command, rel=0.02)
        assert 0 < sum(sizes) <= most
        sizes.clear()


@pytest.mark.parametrize("size", [1, 100])
def test_a_corner_on_a_wall_is_merged_with_it_as_on_the_command_line(client, digest_of, tmp_path, size):
    domain = tmp_path / "parcels.geojson"
    rings = [[(13.4 + size * x * 1e-5, 52.5 + size * y * 1e-5) for x, y in ring] for ring in (
        [(0, 0), (110, 30), (90, 90), (0, 0)], [(55, 15), (110, 30), (120, -20), (55, 15)])]
    domain.write_text(json.dumps({"type": "MultiPolygon", "coordinates": [[ring] for ring in rings]}))
    edge = 5 * size
    mesh = client.mesh(domain, edge=edge, lonlat=True)
    assert mesh.summary.merging.tolerance == 2 / 1024
    assert mesh.digest == digest_of(domain, "--lonlat", "--edge", edge)
    assert client.mesh(domain, edge=edge, lonlat=True, snap=0.5).digest == \
        digest_of(domain, "--lonlat", "--edge", edge, "--snap", 0.5)


def test_places_of_the_summary_are_in_degrees_as_the_mesh_is(client):
    box, stray = [(10, 50), (12, 50), (12, 51), (10, 51), (10.002, 51.002)], [(13, 50), (13.5, 50)]
    domain = weft.Domain([*box, *stray], [(0, 1), (1, 2), (2, 3), (3, 0), (3, 4), (5, 6)])

    def places(**options):
        with pytest.warns(weft.WeftWarning, match="outside"):
            summary = client.mesh(domain, edge=20_000, snap=1000, lonlat=True, **options).summary
        return (summary.outside.x, summary.outside.y), (summary.merging.farthest_x, summary.merging.farthest_y)

    outside, farthest = places()
    assert outside == (13, 50)
    assert farthest == pytest.approx((10, 51), abs=0.01)
    assert min(np.hypot(*place) for place in places(to_metres=True)) > 10_000


class _Frame:
    """As a GeoDataFrame is, as far as it is looked at."""

    def __init__(self, geographic):
        self.crs = type("Crs", (), {"is_geographic": geographic})()
        self.__geo_interface__ = {"type": "Polygon", "coordinates": [SQUARE]}


@pytest.mark.parametrize("domain, degrees", [
    (_Frame(True), True), (_Frame(False), False), ({"type": "Polygon", "coordinates": [SQUARE]}, False),
    ({"type": "Polygon", "coordinates": [(np.array(SQUARE) + (4.8952, 52.3702)).tolist()]}, True),
    (np.array(SQUARE) + (4.8952, 52.3702), False)])
def test_degrees_that_are_not_projected_are_a_warning(recwarn, client, domain, degrees):
    client.mesh(domain, size=1)
    assert [str(warning.message).partition(":")[0] for warning in recwarn] == \
        ["the coordinates are longitudes and latitudes"][:degrees]
    recwarn.clear()
    if degrees:
        client.mesh(domain, size=1e10, lonlat=True)
    assert not recwarn.list


@pytest.mark.parametrize("header, degrees", [("lon,lat", True), ("x,y", False)])
def test_degrees_of_a_file_that_the_command_line_reads_are_a_warning(recwarn, client, tmp_path, header, degrees):
    path = tmp_path / "triangle.csv"
    path.write_text(f"{header}\n0,0\n1,0\n0,1\n")
    client.mesh(path, size=0.1)
    assert [str(warning.message).partition(":")[0] for warning in recwarn] == \
        ["the coordinates are longitudes and latitudes"][:degrees]
    recwarn.clear()
    client.mesh(path, size=1e9, lonlat=True)
    assert not recwarn.list


def test_what_lies_in_a_plane_is_not_projected(client, tmp_path):
    with pytest.raises(weft.DomainError, match="lies in a plane"):
        client.mesh(_Frame(False), lonlat=True)
    source, path = tmp_path / "d.geojson", tmp_path / "d.gpkg"
    source.write_text(json.dumps({"type": "Polygon", "coordinates": [SQUARE]}))
    subprocess.run(["ogr2ogr", path, source, "-a_srs", "EPSG:32618"], check=True)
    with pytest.raises(weft.DomainError, match="lies in a plane"):
        client.mesh(path, crs="EPSG:32618")
    assert client.mesh(path, size=1).summary.area == 16


def test_what_cannot_be_projected_is_named(client, tmp_path):
    domain = ring_file(tmp_path, RINGS["one corner"])
    for crs, what in (("EPSG:4326", "not a projected"), ("EPSG:2263", "metres"),
                      ("nonsense", "PROJ knows")):
        with pytest.raises(weft.DomainError, match=what):
            client.mesh(domain, crs=crs)
    with pytest.raises(weft.DomainError, match="latitude 91"):
        client.mesh(np.array([(0, 0), (1, 0), (0, 91)]), lonlat=True)
    globe = [(-150, -85), (-50, -85), (50, -85), (150, -85), (150, 0), (150, 85), (50, 85), (-50, 85),
             (-150, 85), (-150, 0), (0, 0)]
    with pytest.raises(weft.DomainError, match="tenfold"):
        client.mesh(weft.Domain(globe, [(i, (i + 1) % 10) for i in range(10)]), lonlat=True)
    with pytest.raises(ValueError, match="to_metres"):
        client.submit(domain, lonlat=True)


def test_without_pyproj_the_error_names_it(client, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyproj", None)
    with pytest.raises(weft.MissingPackage, match="python3-pyproj"):
        client.mesh(np.array([(0, 0), (1, 0), (0, 1)]), lonlat=True)
