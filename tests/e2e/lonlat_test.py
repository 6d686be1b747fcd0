# SPDX-License-Identifier: Apache-2.0
"""Meshes of domains in longitude and latitude, measured on the WGS84 ellipsoid by pyproj: angles,
edges and areas hold on the ground, at all latitudes, over the date line and around a pole."""
from __future__ import annotations

import json
import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pyproj
import pytest

sys.path.append(str(pathlib.Path(__file__).parents[1] / "documents"))
import processors  # noqa: E402

MODELS = pathlib.Path(__file__).parents[1] / "models"
COAST = MODELS / "us-east-coast.geojson"
WEFT = os.environ["WEFT_BINARY"]
GROUND = pyproj.Geod(ellps="WGS84")


class Mesh:
    """A mesh that weft made, on the ground."""

    def __init__(self, folder: pathlib.Path, domain: pathlib.Path, *flags: object):
        file = folder / "mesh.npz"
        done = subprocess.run([WEFT, "mesh", domain, "-o", file, "--json", "--quiet", *map(str, flags)],
                              capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        self.report = json.loads(done.stdout)
        with np.load(file) as arrays:
            self.points = arrays["points"][:, :2]
            self.triangles = arrays["triangles"]

    def edges(self) -> np.ndarray:
        """Metres: of each triangle, the edge from corner k to the next."""
        a, b = self._ends()
        return GROUND.inv(a[..., 0], a[..., 1], b[..., 0], b[..., 1])[2]

    def areas(self) -> np.ndarray:
        """Square metres, by Heron's formula."""
        edge = self.edges()
        s = edge.sum(axis=1) / 2
        return np.sqrt(s * (s - edge[:, 0]) * (s - edge[:, 1]) * (s - edge[:, 2]))

    def angles(self) -> np.ndarray:
        """Degrees: of each triangle, at each corner, between the geodesics to the other two."""
        a, b = self._ends()
        there, back, _ = GROUND.inv(a[..., 0], a[..., 1], b[..., 0], b[..., 1])
        return np.abs((there - np.roll(back, 1, axis=1) + 180) % 360 - 180)

    def _ends(self) -> tuple[np.ndarray, np.ndarray]:
        a = self.points[self.triangles]
        return a, np.roll(a, -1, axis=1)


def flat_angles(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Degrees, in the plane."""
    a = points[triangles]
    out, back = np.roll(a, -1, axis=1) - a, np.roll(a, 1, axis=1) - a
    cross = out[..., 0] * back[..., 1] - out[..., 1] * back[..., 0]
    return np.degrees(np.arctan2(cross, (out * back).sum(axis=2)))


def ring_file(folder: pathlib.Path, ring: list[tuple[float, float]]) -> pathlib.Path:
    file = folder / "ring.geojson"
    file.write_text(json.dumps({"type": "Polygon", "coordinates": [[*ring, ring[0]]]}))
    return file


def area_between(ring: list[tuple[float, float]]) -> float:
    """Square metres within a ring whose sides are straight in longitude and latitude."""
    lon, lat = [], []
    for (x0, y0), (x1, y1) in zip(ring, [*ring[1:], ring[0]]):
        step = (x1 - x0 + 180) % 360 - 180
        at = np.arange(2000) / 2000
        lon.extend(x0 + step * at)
        lat.extend(y0 + (y1 - y0) * at)
    return abs(GROUND.polygon_area_perimeter(lon, lat)[0])


def has_all(mesh: Mesh, points: np.ndarray) -> bool:
    """Whether each point is a vertex, bit for bit."""
    vertices = {tuple(point) for point in mesh.points}
    return all(tuple(point) in vertices for point in points)


@pytest.fixture(scope="module")
def coast(tmp_path_factory: pytest.TempPathFactory) -> Mesh:
    return Mesh(tmp_path_factory.mktemp("coast"), COAST, "--lonlat", "--size", 1e8)


def test_the_coast_has_the_angles_of_the_plane_on_the_ground(coast: Mesh, tmp_path: pathlib.Path):
    metres = Mesh(tmp_path, COAST, "--to-metres", "--size", 1e8)
    assert metres.report["digest"] == coast.report["digest"]
    flat = flat_angles(metres.points, metres.triangles)
    ground = coast.angles()
    assert np.abs(ground - flat).max() < 0.05
    least = flat.min(axis=1)
    assert coast.report["unrefined"]["small_input_angle"] == (least < 20).sum()
    assert ground.min(axis=1)[least >= 20].min() >= 19.95


def test_the_coast_has_the_sizes_that_were_asked_for_at_all_latitudes(coast: Mesh):
    # The scale of the projection is at most 1.3 % off.
    scale = coast.report["projection"]
    assert 0.987 < scale["least_scale"] < 1 < scale["greatest_scale"] < 1.013
    areas, edges = coast.areas(), coast.edges()
    assert areas.max() <= 1e8 / scale["least_scale"] ** 2 * 1.001
    wanted = np.sqrt(1e8 / 0.433)  # what docs/size.md says of edges
    latitudes = coast.points[coast.triangles][..., 1].mean(axis=1)
    for south in range(24, 46, 2):
        here = (latitudes >= south) & (latitudes < south + 2) & (areas > 0.9e8)
        assert here.sum() > 50
        assert abs(np.median(edges[here]) / wanted - 1) < 0.03, south


def test_the_coast_has_its_vertices_bit_for_bit(coast: Mesh):
    ring = np.array(json.loads(COAST.read_text())["geometry"]["coordinates"][0])
    assert has_all(coast, ring)


@pytest.mark.parametrize("east", [-177.0, 183.0])
def test_a_ring_over_the_date_line_is_whole(tmp_path: pathlib.Path, east: float):
    ring = [(177.0, -20.0), (east, -20.0), (east, -14.0), (177.0, -14.0)]
    mesh = Mesh(tmp_path, ring_file(tmp_path, ring), "--lonlat", "--size", 1e8)
    # A meridian is a curve in the plane, and may be cut short by a thousandth.
    assert mesh.areas().sum() == pytest.approx(area_between(ring), rel=2e-3)
    assert mesh.angles().min() >= 19.95
    assert has_all(mesh, np.array(ring))
    longitudes = mesh.points[:, 0]
    assert longitudes.max() <= max(180.0, east) + 1e-9
    if east > 180:
        assert longitudes.min() >= 177 - 1e-9
    else:
        assert np.abs(longitudes).min() >= 177 - 1e-9
        assert any("--to-metres" in warning for warning in mesh.report["warnings"])


@pytest.mark.parametrize("latitude", [80.0, -75.0])
def test_a_ring_around_a_pole_holds_the_pole(tmp_path: pathlib.Path, latitude: float):
    ring = [(lon, latitude) for lon in (0.0, 90.0, 180.0, -90.0)]
    mesh = Mesh(tmp_path, ring_file(tmp_path, ring), "--lonlat", "--size", 1e9)
    assert mesh.areas().sum() == pytest.approx(area_between(ring), rel=2e-3)
    assert mesh.angles().min() >= 19.9
    assert has_all(mesh, np.array(ring))
    # No latitude between the ring and the pole is left out.
    assert np.diff(np.sort(np.abs(mesh.points[:, 1]))).max() < 0.5


def test_a_named_projection_is_used_and_its_metres_are_written(tmp_path: pathlib.Path):
    ring = [(-74.0, 40.0), (-73.0, 40.0), (-73.0, 41.0)]
    mesh = Mesh(tmp_path, ring_file(tmp_path, ring), "--crs", "EPSG:32618", "--to-metres")
    assert mesh.report["projection"]["name"] == "EPSG:32618"
    utm = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:32618", always_xy=True)
    expected = np.array(utm.transform(*zip(*ring))).T
    for point in expected:
        assert np.hypot(*(mesh.points - point).T).min() < 1e-3


def test_a_place_in_an_error_is_on_the_globe_too(tmp_path: pathlib.Path):
    ring = [(-74.0, 40.0), (-73.0, 40.0), (-73.0, 41.0)]
    done = subprocess.run([WEFT, "mesh", ring_file(tmp_path, ring), "-o", tmp_path / "mesh.vtu", "--lonlat",
                           "--edge", "d/10", "--field", "d=distance"], capture_output=True, text=True)
    assert done.returncode == 67
    assert "\n  --edge: the size falls to 0 on the segment through (" in done.stderr
    lon, lat = map(float, re.search(r"this one is at longitude (\S+), latitude (\S+)\n", done.stderr).groups())
    to_border = min(abs(lat - 40), abs(lon + 73), abs((lat - 40) - (lon + 74)))
    assert -74 < lon <= -73 and 40 <= lat < 41 and to_border < 1e-3, done.stderr


def test_the_mesh_in_metres_is_checked(tmp_path: pathlib.Path):
    file = tmp_path / "coast.vtu"
    for command in (["mesh", COAST, "-o", file, "--quiet"], ["check", file, "--domain", COAST]):
        done = subprocess.run([WEFT, *command, "--to-metres", "--size", "1e9"], capture_output=True,
                              text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    done = subprocess.run([WEFT, "check", file, "--domain", COAST, "--lonlat"], capture_output=True,
                          text=True)
    assert done.returncode == 2
    assert "--to-metres" in done.stderr


def test_the_mesh_in_metres_is_that_of_processors_with_other_sines(tmp_path: pathlib.Path):
    # Without fused operations, the C library's sines round otherwise, and so does PROJ.
    meshes = []
    for processor in ("own", "sse4"):
        file = tmp_path / f"{processor}.vtu"
        subprocess.run([WEFT, "mesh", COAST, "-o", file, "--quiet", "--to-metres", "--size", "1e8"],
                       check=True, env=os.environ | processors.environment(processor))
        meshes.append(file.read_bytes())
    assert meshes[0] == meshes[1]


def parcels(folder: pathlib.Path, size: float = 1, digits: int = 15) -> pathlib.Path:
    """Two rows of parcels of some 20 m, or `size` times that. The corners of one row lie in the middle of the
    walls of the other, to rounding."""
    def row(first: float, y: float, many: int) -> list:
        def at(across: float, up: float) -> tuple[float, float]:
            return (round(13.4 + (0.96 * across - 0.28 * up) * size * 2.5e-5, digits),
                    round(52.5 + (0.28 * across + 0.96 * up) * size * 1.5e-5, digits))
        return [[[at(x + dx, y + dy) for dx, dy in [(0, 0), (12, 0), (12, 16), (0, 16), (0, 0)]]]
                for x in (first + 12 * i for i in range(many))]

    file = folder / "parcels.geojson"
    file.write_text(json.dumps({"type": "MultiPolygon", "coordinates": [*row(0, 0, 6), *row(5, 16, 5)]}))
    return file


def test_a_corner_on_the_wall_of_a_neighbour_stays_there(tmp_path: pathlib.Path):
    # What rounding to the grid moves makes no triangles of its size.
    file = parcels(tmp_path)
    mesh = Mesh(tmp_path, file, "--to-metres", "--edge", 2)
    assert mesh.report["merging"]["tolerance"] == 2 / 1024
    assert mesh.report["merging"]["segments"] > 5
    assert not mesh.report["narrow"]
    finer = Mesh(tmp_path, file, "--to-metres", "--edge", 2, "--snap", 1e-6)
    assert finer.report["triangles"] > 3 * mesh.report["triangles"]


def test_a_corner_on_a_wall_that_the_plane_bends_stays_there(tmp_path: pathlib.Path):
    # By two decimetres, in the middle of walls of 4 km.
    mesh = Mesh(tmp_path, parcels(tmp_path, size=200), "--lonlat", "--edge", 400)
    assert mesh.report["merging"]["segments"] == 0
    assert mesh.report["unrefined"]["small_input_angle"] == 0
    assert mesh.angles().min() > 20


def test_a_snap_merges_what_is_as_near_in_the_file_before_the_plane_bends_it(tmp_path: pathlib.Path):
    file, mesh = parcels(tmp_path, size=1000 / 7, digits=6), tmp_path / "mesh.vtu"
    lint = [WEFT, "lint", file, "--lonlat", "--ignore", "junction"]
    assert subprocess.run(lint).returncode == 3
    assert subprocess.run([*lint, "--snap", "0.1"]).returncode == 0
    flags = ["--to-metres", "--edge", "400", "--snap", "0.1"]
    done = subprocess.run([WEFT, "mesh", file, "-o", mesh, *flags, "--json"], check=True, capture_output=True)
    assert json.loads(done.stdout)["unrefined"]["small_input_angle"] == 0
    assert subprocess.run([WEFT, "check", mesh, "--domain", file, *flags]).returncode == 0


def test_the_domain_that_is_checked_is_merged_as_that_which_is_meshed(tmp_path: pathlib.Path):
    file, mesh = parcels(tmp_path), tmp_path / "mesh.vtu"
    subprocess.run([WEFT, "mesh", file, "-o", mesh, "--to-metres", "--edge", "2", "--quiet"], check=True)
    check = [WEFT, "check", mesh, "--domain", file, "--to-metres", "--edge", "2"]
    assert subprocess.run(check).returncode == 0
    assert subprocess.run([*check, "--snap", "1e-6"]).returncode == 3


def test_degrees_that_the_file_names_are_a_warning_without_lonlat(tmp_path):
    file = tmp_path / "triangle.csv"
    file.write_text("lat,lon\n52.1,4.2\n52.2,4.9\n52.6,4.8\n")
    told = [f"{file}: its coordinates are longitudes and latitudes (columns 'lon' and 'lat'): lengths, areas and "
            "angles are those of degrees; --lonlat has them on the ground"]
    assert Mesh(tmp_path, file, "--edge", 0.05).report["warnings"] == told
    assert "warnings" not in Mesh(tmp_path, file, "--edge", 5000, "--lonlat").report
    lint = subprocess.run([WEFT, "lint", file], capture_output=True, text=True)
    assert lint.returncode == 3 and told[0].partition(": ")[2] in lint.stdout
    assert subprocess.run([WEFT, "lint", file, "--lonlat"], capture_output=True).returncode == 0
    file.write_text("y,x\n52.1,4.2\n52.2,4.9\n52.6,4.8\n")
    assert "warnings" not in Mesh(tmp_path, file, "--edge", 0.05).report


def test_a_domain_that_is_converted_is_still_known_to_be_in_degrees(tmp_path):
    file = tmp_path / "triangle.csv"
    file.write_text("lat,lon\n52.1,4.2\n52.2,4.9\n52.6,4.8\n")
    system = "coordinates: longitude and latitude (columns 'lon' and 'lat')"
    for name, told in (("d.pb", []), ("d.poly", [
            f"WARNING: {tmp_path / 'd.poly'}: does not say that its coordinates are longitudes and latitudes "
            "(columns 'lon' and 'lat'); mesh it with --lonlat"])):
        done = subprocess.run([WEFT, "convert", file, tmp_path / name], capture_output=True, text=True, check=True)
        assert done.stdout.splitlines()[1:] == [system, f"wrote {tmp_path / name}", *told]
    file.write_text("x,y\n52.1,4.2\n52.2,4.9\n52.6,4.8\n")
    done = subprocess.run([WEFT, "convert", file, tmp_path / "d.poly"], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[1:] == [f"wrote {tmp_path / 'd.poly'}"]


def test_what_is_converted_is_reported_as_data(tmp_path):
    file = tmp_path / "ring.csv"
    file.write_text("lat,lon,depth\n52.1,4.2,3\n52.2,4.9,3\n52.6,4.8,3\n")
    done = subprocess.run([WEFT, "convert", "--json", file, tmp_path / "d.pb"], capture_output=True, text=True,
                          check=True)
    assert json.loads(done.stdout) == {
        "points": 3, "segments": 3, "holes": 0, "regions": 0, "areas": 1,
        "coordinates": {"name": "columns 'lon' and 'lat'", "geographic": True},
        "warnings": [{"kind": "column", "file": str(file), "count": 1,
                      "sentence": f"{file}: this column is ignored: 'depth'"}]}


def test_a_raster_in_a_plane_is_warped_to_a_domain_in_degrees(tmp_path):
    file = tmp_path / "triangle.csv"
    file.write_text("lat,lon\n52.1,4.2\n52.2,4.9\n52.6,4.8\n")
    (tmp_path / "d.asc").write_text("ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + "0.03 0.03 0.03\n" * 3)
    subprocess.run(["gdal_translate", "-q", "-a_srs", "EPSG:32631", "-a_ullr", "500000", "5900000", "700000", "5700000",
                    "d.asc", "d.tif"], cwd=tmp_path, check=True)
    warped = Mesh(tmp_path, file, "--edge", "d", "--field", f"d={tmp_path / 'd.tif'}").report["triangles"]
    assert warped == pytest.approx(Mesh(tmp_path, file, "--edge", 0.03).report["triangles"], rel=0.02)
