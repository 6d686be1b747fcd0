# SPDX-License-Identifier: Apache-2.0
"""Has `weft convert` read domains that programs of others wrote, and compares what it makes of them
with what was meant; prints a row for every format and writer. DOCS, docs/formats.md, must have these.

    read_others.py WEFT DOCS

The domain: a plate of 12 x 12 with a hole of 4 x 4 in the middle and, beside it, a triangle. The
.poly file that comes out is judged by shapely: the faces between its segments, less those with a
seed of a hole, are the domain.

Rasters become values at the vertices of a mesh.

Needs Debian's python3-gdal, python3-gmsh, python3-meshio, python3-netgen, python3-numpy, python3-pyshp,
python3-shapely and python3-vtk9.
"""

import os
import re
import subprocess
import sys
import tempfile
import zipfile

import gmsh
import meshio
import numpy
import shapefile
import shapely
import shapely.wkt
import vtkmodules.all as vtk
from netgen import meshing
from netgen.geom2d import SplineGeometry
from osgeo import gdal, ogr, osr
from shapely.geometry import LineString, MultiLineString, MultiPolygon, Point, Polygon
from shapely.ops import polygonize, unary_union
from vtkmodules.util.numpy_support import numpy_to_vtk

import format_table

OUTER = [(0, 0), (12, 0), (12, 12), (0, 12)]
HOLE = [(4, 4), (4, 8), (8, 8), (8, 4)]
BESIDE = [(20, 0), (24, 0), (20, 4)]
PLATE = Polygon(OUTER, [HOLE])
AREA = PLATE.area + Polygon(BESIDE).area


def equal(what, found, expected):
    if found != expected:
        sys.exit(f"{what}: found {found}, expected {expected}")


def read_poly(path):
    """points, segments with markers, holes, regions"""
    lines = iter(open(path).read().splitlines())
    sections = []
    for _ in range(4):
        count = int(next(lines).split()[0])
        sections.append([[float(w) for w in next(lines).split()[1:]] for _ in range(count)])
    return sections


def check(path, markers=None, regions=None, area=AREA, digits=9):
    points, segments, holes, seeds = read_poly(path)
    lines = [LineString([points[int(a) - 1], points[int(b) - 1]]) for a, b, _ in segments]
    faces = list(polygonize(unary_union(lines)))
    filled = [f for f in faces if not any(f.contains(Point(h)) for h in holes)]
    equal("area", round(sum(f.area for f in filled), digits), area)
    if markers is not None:
        found = {int(m) for _, _, m in segments}
        equal("markers", found, markers)
    if regions is not None:
        found = {int(r): round(sum(f.area for f in filled if f.contains(Point(x, y))), digits)
                 for x, y, r, _ in seeds}
        equal("areas of regions", found, regions)


def write_wkt(path):
    with open(path, "w") as file:
        file.write(shapely.wkt.dumps(MultiPolygon([PLATE, Polygon(BESIDE)])))


def write_shapefile(path):
    with shapefile.Writer(path) as writer:
        writer.field("marker", "N", 9)
        writer.field("region", "N", 9)
        writer.poly([OUTER[::-1], HOLE[::-1]])
        writer.record(3, 7)
        writer.poly([BESIDE[::-1]])
        writer.record(4, 8)


def write_archive(path):
    """A shapefile in a folder, as it is published."""
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        write_shapefile(os.path.join(folder, "d.shp"))
        for name in sorted(os.listdir(folder)):
            archive.write(os.path.join(folder, name), f"borders/{name}")
            archive.writestr(f"__MACOSX/borders/._{name}", b"of macOS")
        archive.writestr("borders/read me.txt", "by their owner")


def write_csv(path):
    rows = [(ring, x, y, ring * 10) for ring, points in enumerate((OUTER, HOLE, BESIDE), start=1)
            for x, y in points]
    numpy.savetxt(path, rows, fmt=["%d", "%.18g", "%.18g", "%d"], delimiter=",",
                  header="ring,x,y,marker", comments="")


def gmsh_model(triangles, version, binary=0):
    """Physical curves 5, around the plate, and 6, around the triangle; the hole has none if the
    triangles tell of it. Physical surfaces 7 and 8. The plate's are "outer wall" and "plate"."""
    def write(path):
        gmsh.initialize(["gmsh", "-v", "2"])
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        geo = gmsh.model.geo

        def loop(points):
            corners = [geo.addPoint(x, y, 0, 2.5) for x, y in points]
            return [geo.addLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1])]

        outer, hole, beside = loop(OUTER), loop(HOLE), loop(BESIDE)
        loops = [geo.addCurveLoop(curves) for curves in (outer, hole, beside)]
        surfaces = [geo.addPlaneSurface(loops[:2]), geo.addPlaneSurface(loops[2:])]
        geo.synchronize()
        gmsh.model.addPhysicalGroup(1, outer, 5)
        gmsh.model.addPhysicalGroup(1, beside, 6)
        gmsh.model.setPhysicalName(1, 5, "outer wall")
        if triangles:
            for tag, surface in zip((7, 8), surfaces):
                gmsh.model.addPhysicalGroup(2, [surface], tag)
            gmsh.model.setPhysicalName(2, 7, "plate")
        gmsh.model.mesh.generate(2 if triangles else 1)
        gmsh.write(path)
        gmsh.finalize()
    return write


def netgen_mesh(path):
    """Boundary conditions by name, one for each loop, and two domains, of which one has a name."""
    geometry = SplineGeometry()
    for points, domain, name in ((OUTER, 1, "outer wall"), (HOLE, 1, "hole"), (BESIDE, 2, "beside")):
        corners = [geometry.AppendPoint(*point) for point in points]
        for a, b in zip(corners, corners[1:] + corners[:1]):
            geometry.Append(["line", a, b], leftdomain=domain, rightdomain=0, bc=name)
    geometry.SetMaterial(1, "plate")
    meshing.SetMessageImportance(0)
    geometry.GenerateMesh(maxh=2.5).Save(path)


def triangulation():
    """Points, triangles with regions 7 and 8, edges with markers 5 and 6, of the plate and the triangle."""
    inner = [HOLE[0], HOLE[3], HOLE[2], HOLE[1]]  # counter-clockwise, as the border is
    points = numpy.array([(x, y, 0.0) for x, y in OUTER + inner + BESIDE])
    triangles = [corners for k in range(4) for corners in
                 ((k, (k + 1) % 4, 4 + (k + 1) % 4), (k, 4 + (k + 1) % 4, 4 + k))] + [(8, 9, 10)]
    edges = [(k, (k + 1) % 4) for k in range(4)] + [(8, 9), (9, 10), (10, 8)]
    return points, triangles, [7] * 8 + [8], edges, [5] * 4 + [6] * 3


def vtk_grid(compressor, mode, base64, wide):
    """Blocks are small, so that there are several."""
    def write(path):
        points, triangles, regions, edges, markers = triangulation()
        grid = vtk.vtkUnstructuredGrid()
        at = vtk.vtkPoints()
        at.SetDataTypeToDouble()
        for point in points:
            at.InsertNextPoint(point)
        grid.SetPoints(at)
        for kind, cells in ((vtk.VTK_TRIANGLE, triangles), (vtk.VTK_LINE, edges)):
            for cell in cells:
                grid.InsertNextCell(kind, len(cell), cell)
        for name, values in (("region", regions + [0] * len(edges)),
                             ("marker", [0] * len(triangles) + markers)):
            array = numpy_to_vtk(numpy.array(values, numpy.int64), deep=1)
            array.SetName(name)
            grid.GetCellData().AddArray(array)
        writer = vtk.vtkXMLUnstructuredGridWriter()
        getattr(writer, f"SetCompressorTypeTo{compressor}")()
        getattr(writer, f"SetDataModeTo{mode}")()
        writer.SetEncodeAppendedData(base64)
        writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
        writer.SetBlockSize(64)
        writer.SetInputData(grid)
        writer.SetFileName(path)
        writer.Write()
    return write


def meshio_grid(compression):
    def write(path):
        points, triangles, regions, edges, markers = triangulation()
        meshio.Mesh(points, [("triangle", numpy.array(triangles)), ("line", numpy.array(edges))],
                    cell_data={"region": [numpy.array(regions), numpy.zeros(len(edges), int)],
                               "marker": [numpy.zeros(len(triangles), int), numpy.array(markers)]},
                    ).write(path, compression=compression)
    return write


VTK = f"VTK {vtk.vtkVersion.GetVTKVersion()}"
MESHIO = f"meshio {meshio.__version__}"
NETGEN = "Netgen 6.2.1905"
GMSH = f"Gmsh {gmsh.__version__}"
GDAL = f"GDAL {gdal.__version__}"
REGIONS = {7: PLATE.area, 8: 8.0}
OF_MESH = {"markers": {0, 5, 6}, "regions": REGIONS}
OF_FIELDS = {"markers": {3, 4}, "regions": REGIONS}
DRAWN = {"markers": {0}, "area": AREA + 16}  # the hole is a face like the others
def ogr_file(driver, options=(), lines=False):
    """Polygons with attributes; or, of formats that are drawings, their rings."""
    def write(path):
        file = ogr.GetDriverByName(driver).CreateDataSource(path, options=list(options))
        made = file.CreateLayer("d", geom_type=ogr.wkbMultiLineString if lines else ogr.wkbPolygon)
        if not lines:
            for field in ("marker", "region"):
                made.CreateField(ogr.FieldDefn(field, ogr.OFTInteger))
        for shape, marker, region in ((PLATE, 3, 7), (Polygon(BESIDE), 4, 8)):
            for part in MultiLineString([shape.exterior, *shape.interiors]).geoms if lines else (shape,):
                feature = ogr.Feature(made.GetLayerDefn())
                if not lines:
                    feature["marker"], feature["region"] = marker, region
                feature.SetGeometry(ogr.CreateGeometryFromWkt(part.wkt))
                made.CreateFeature(feature)
    return write


CASES = [  # file, kind, writer, what writes, what is expected
    ("d.wkt", "", f"shapely {shapely.__version__}", write_wkt, {}),
    ("d.shp", "", f"pyshp {shapefile.__version__}", write_shapefile, OF_FIELDS),
    ("d.csv", "", f"numpy {numpy.__version__}", write_csv, {"markers": {10, 20, 30}}),
    ("d41.msh", " 4.1, text", GMSH, gmsh_model(True, 4.1), {"markers": {0, 5, 6}, "regions": REGIONS}),
    ("d41b.msh", " 4.1, binary", GMSH, gmsh_model(True, 4.1, 1), {"markers": {0, 5, 6}, "regions": REGIONS}),
    ("d22.msh", " 2.2, text", GMSH, gmsh_model(True, 2.2), {"markers": {0, 5, 6}, "regions": REGIONS}),
    ("d22b.msh", " 2.2, binary", GMSH, gmsh_model(True, 2.2, 1), {"markers": {0, 5, 6}, "regions": REGIONS}),
    # References are the numbers of curves and surfaces. The hole's curves are in no group: not there.
    ("d.mesh", "", GMSH, gmsh_model(True, 4.1), {"markers": {0, 1, 2, 3, 4, 9, 10, 11},
                                                 "regions": {1: PLATE.area, 2: 8.0}}),
    # Lines and surfaces without a name are "PhysicalLine6", "PhysicalSurface8": names, too.
    ("d.inp", "", GMSH, gmsh_model(True, 4.1), {"markers": {0, 1, 2}, "regions": {1: PLATE.area, 2: 8.0}}),
    ("d.vol", "", NETGEN, netgen_mesh, {"markers": {1, 2, 3}, "regions": {1: PLATE.area, 2: 8.0}}),
    ("dz.vtu", ", zlib, appended", VTK, vtk_grid("ZLib", "Appended", False, True), OF_MESH),
    ("dl.vtu", ", LZ4, appended in base64", VTK, vtk_grid("LZ4", "Appended", True, False), OF_MESH),
    ("dx.vtu", ", LZMA, inline", VTK, vtk_grid("LZMA", "Binary", False, True), OF_MESH),
    ("dn.vtu", ", not compressed, inline", VTK, vtk_grid("None", "Binary", False, False), OF_MESH),
    ("dt.vtu", ", text", VTK, vtk_grid("ZLib", "Ascii", False, False), OF_MESH),
    ("dm.vtu", ", zlib", MESHIO, meshio_grid("zlib"), OF_MESH),
    ("do.vtu", ", LZMA", MESHIO, meshio_grid("lzma"), OF_MESH),
    ("d.gpkg", "", GDAL, ogr_file("GPKG"), OF_FIELDS),
    ("d.fgb", "", GDAL, ogr_file("FlatGeobuf"), OF_FIELDS),
    ("d.kml", "", GDAL, ogr_file("LIBKML"), OF_FIELDS),
    ("d.kmz", "", GDAL, ogr_file("LIBKML"), OF_FIELDS),
    ("d.zip", " of a `.shp`", f"pyshp {shapefile.__version__}", write_archive, OF_FIELDS),
    ("d.gml", "", GDAL, ogr_file("GML"), OF_FIELDS),
    ("d.dxf", "", GDAL, ogr_file("DXF", lines=True), DRAWN),
    ("d.dgn", "", GDAL, ogr_file("DGN", lines=True), DRAWN),
    ("d.tab", "", GDAL, ogr_file("MapInfo File"), {**OF_FIELDS, "digits": 2}),  # in integers
    ("d.mif", "", GDAL, ogr_file("MapInfo File", ["FORMAT=MIF"]), OF_FIELDS),
    ("d.gmt", "", GDAL, ogr_file("OGR_GMT"), OF_FIELDS),
    ("d.geojsonl", "", GDAL, ogr_file("GeoJSONSeq"), OF_FIELDS),
]


def lines_only(weft, folder):
    """Without triangles every bounded face is filled: the hole has no group, so it is not there."""
    path, poly = (os.path.join(folder, name) for name in ("lines.msh", "lines.poly"))
    gmsh_model(False, 4.1)(path)
    subprocess.run([weft, "convert", path, poly, "--quiet"], check=True)
    points, segments, holes, _ = read_poly(poly)
    lines = [LineString([points[int(a) - 1], points[int(b) - 1]]) for a, b, _ in segments]
    equal("areas of faces", sorted(round(f.area, 9) for f in polygonize(unary_union(lines))), [8.0, 144.0])
    equal("holes", holes, [])
    equal("markers", {int(m) for _, _, m in segments}, {5, 6})


RASTERS = [(".asc", "AAIGrid"), (".tif", "GTiff"), (".nc", "netCDF"), (".img", "HFA"), (".bil", "EHdr"),
           (".vrt", "VRT")]


def write_raster(path, driver):
    """The plane x + 2 y at cells of 0.5, centred from (0, 0) to (4, 3)."""
    x, y = numpy.meshgrid(numpy.arange(9) / 2, numpy.arange(6, -1, -1) / 2)
    raster = gdal.GetDriverByName("MEM").Create("", 9, 7, 1, gdal.GDT_Float32)
    raster.SetGeoTransform((-0.25, 0.5, 0, 3.25, 0, -0.5))
    raster.GetRasterBand(1).WriteArray(x + 2 * y)
    if driver == "VRT":  # it has no values of its own
        raster = gdal.GetDriverByName("GTiff").CreateCopy(path + ".tif", raster)
        raster.FlushCache()
    gdal.GetDriverByName(driver).CreateCopy(path, raster).FlushCache()


def check_raster(weft, folder, path):
    """A plane is its own bilinear interpolation."""
    points = numpy.array([[0, 0], [4, 0], [4, 3], [0.3, 2.7], [1.1, 1.3]])
    mesh, out = (os.path.join(folder, name) for name in ("three.npz", "values.npz"))
    numpy.savez(mesh, points=points, triangles=numpy.array([[0, 1, 2], [0, 2, 3], [0, 4, 3]], "u4"))
    subprocess.run([weft, "convert", mesh, out, "--quiet", "--nodal", "h=" + path], check=True)
    errors = numpy.load(out)["h"] - points @ [1, 2]
    equal("values of the raster", float(abs(errors).max()) < 1e-6, True)


def projected_raster(weft, folder):
    """A raster in degrees gives values to a domain in metres; one that is elsewhere, or has no such
    band, is refused before there is a mesh."""
    depth, shore, out = (os.path.join(folder, name) for name in ("depth.tif", "shore.gpkg", "shore.npz"))
    raster = gdal.GetDriverByName("GTiff").Create(depth, 60, 60, 1, gdal.GDT_Float32)
    raster.SetGeoTransform([-75.3, 0.01, 0, 39.3, 0, -0.01])
    degrees = osr.SpatialReference()
    degrees.ImportFromEPSG(4326)
    raster.SetProjection(degrees.ExportToWkt())
    raster.GetRasterBand(1).WriteArray(numpy.full((60, 60), 7.5))
    raster = None
    plane = osr.SpatialReference()
    plane.ImportFromEPSG(32618)
    file = ogr.GetDriverByName("GPKG").CreateDataSource(shore)
    layer = file.CreateLayer("d", srs=plane, geom_type=ogr.wkbPolygon)
    feature = ogr.Feature(layer.GetLayerDefn())
    feature.SetGeometry(ogr.CreateGeometryFromWkt(
        "POLYGON ((500000 4317000, 510000 4317000, 510000 4327000, 500000 4317000))"))
    layer.CreateFeature(feature)
    file = layer = feature = None
    subprocess.run([weft, "mesh", shore, "-o", out, "--quiet", "--nodal", "depth=" + depth], check=True)
    equal("values of the projected raster", set(numpy.load(out)["depth"]), {7.5})
    os.remove(out)
    refused = subprocess.run([weft, "mesh", shore, "-o", out, "--nodal",
                              f"depth={depth}:3"], capture_output=True, text=True)
    equal("a band that is not there", (refused.returncode, "band" in refused.stderr), (4, True))


def main():
    weft, docs = os.path.abspath(sys.argv[1]), sys.argv[2]
    gdal.UseExceptions()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, kind, writer, write, expected in CASES:
            path = os.path.join(folder, name)
            write(path)
            poly = path + ".poly"
            subprocess.run([weft, "convert", path, poly, "--quiet"], check=True)
            row = f"| `{os.path.splitext(name)[1]}`{kind} | {writer} |"
            print(row, flush=True)
            rows.append(row)
            check(poly, **expected)
            if name.endswith(".msh"):
                told = subprocess.run([weft, "info", path], check=True, capture_output=True,
                                      text=True).stdout
                equal("names", re.findall(r"'([^']*)'", told), ["plate", "outer wall"])
        lines_only(weft, folder)
        projected_raster(weft, folder)
        for extension, driver in RASTERS:
            path = os.path.join(folder, "raster" + extension)
            write_raster(path, driver)
            row = f"| `{extension}`, a raster | {GDAL} |"
            print(row, flush=True)
            rows.append(row)
            check_raster(weft, folder, path)
    format_table.check(docs, "| read by weft | written by |", rows)


main()
