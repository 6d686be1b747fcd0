# SPDX-License-Identifier: Apache-2.0
"""Has programs that are not ours read what weft writes, and compares what they find with what was
written; prints a row for every format and reader. DOCS, docs/formats.md, must have these, and every
format that weft writes must be among them.

    read_back.py WEFT DOCS

The mesh: a plate of 12 x 12 unit squares, each cut in two triangles, with a hole of 4 x 4 in the
middle. numpy makes it and `weft convert` writes it in every format. Region 3 is left of x = 6,
region 7 right of it; the sides are marked 1 to 4 from the bottom counter-clockwise, the hole 5, and
the line between the regions 9. Files of names have "inlet" for marker 2, "outer wall" for 4 and
"fluid" for region 3. The raster bed.asc has the elevation x + 2 y - 100, metres.

Needs Debian's libxdmf3, openfoam, python3-gmsh, python3-meshio, python3-netcdf4, python3-netgen, python3-numpy,
python3-qgis with qgis-providers, python3-shapely, python3-vtk9 and python3-xarray.
"""

import os
import re
import subprocess
import sys
import tempfile

import gmsh
import meshio
import netCDF4
import numpy
import shapely
import vtk
from qgis.core import Qgis, QgsApplication

import format_table
from readers.by_gmsh import gmsh_bed, gmsh_msh, gmsh_msh_2, gmsh_names
from readers.by_meshio import (meshio_2, meshio_bed, meshio_exodus, meshio_exodus_2, meshio_inp, meshio_inp_names, meshio_medit, meshio_msh,
                               meshio_names, meshio_stl, meshio_su2, meshio_su2_names,
                               meshio_surface, meshio_vtu)
from readers.by_netcdf import (netcdf4_exodus, netcdf4_names, netcdf4_parts, netcdf4_ugrid,
                               xarray_ugrid)
from readers.by_netgen import netgen_names, netgen_vol
from readers.by_numpy import (numpy_2dm, numpy_2dm_names, numpy_adcirc, numpy_adcirc_bed,
                              numpy_edge, numpy_mfem, numpy_mfem_names, numpy_neigh, numpy_node,
                              numpy_node_2, numpy_node_names, numpy_npz, numpy_npz_names,
                              numpy_parts, numpy_rcm, numpy_selafin)
from readers.by_openfoam import check_mesh_openfoam, vtk_openfoam, vtk_openfoam_names
from readers.by_qgis import qgis_2dm, qgis_selafin, qgis_ugrid
from readers.by_shapely import check_models, shapely_disv, shapely_geojson, shapely_names
from readers.by_vtk import (vtk_exodus, vtk_exodus_2, vtk_exodus_names, vtk_exodus_values,
                            vtk_names, vtk_parts, vtk_surface, vtk_vtu, vtk_vtu_2, vtk_vtu_bed)
from readers.by_xdmf import xdmf, xdmf_2, xdmf_names, xdmf_values
from readers.plate import bed_file, equal, names_of_source, plate

GMSH = f"Gmsh {gmsh.__version__}"
MESHIO = f"meshio {meshio.__version__}"
NETGEN = "Netgen 6.2.1905"
NETCDF4 = f"netCDF4 {netCDF4.__version__}"
NUMPY = f"numpy {numpy.__version__}"
SHAPELY = f"shapely {shapely.__version__}"
QGIS = f"QGIS {Qgis.QGIS_VERSION.split('-')[0]}"
VTK = f"VTK {vtk.vtkVersion.GetVTKVersion()}"
XDMF = "libxdmf 3.0"
OPENFOAM = "OpenFOAM 1912"
XARRAY = "xarray"  # Debian's says 999
SECOND = ["--order", "2"]
BED = ["--nodal", "elevation=bed.asc"]
CHECKS = [  # file, flags of weft convert, reader, check
    ("plate.vtu", [], VTK, vtk_vtu),
    ("plate.vtu", [], MESHIO, meshio_vtu),
    ("bed.vtu", BED, VTK, vtk_vtu_bed),
    ("bed.vtu", BED, MESHIO, meshio_bed),
    ("parts.vtu", ["--parts", "4"], VTK, vtk_parts),
    ("names.vtu", [], VTK, vtk_names),
    ("names.vtu", [], MESHIO, meshio_names),
    ("plate2.vtu", SECOND, VTK, vtk_vtu_2),
    ("plate2.vtu", SECOND, MESHIO, meshio_2),
    ("plate.msh", [], GMSH, gmsh_msh),
    ("plate.msh", [], MESHIO, meshio_msh),
    ("bed.msh", BED, GMSH, gmsh_bed),
    ("bed2.msh", [*BED, *SECOND], GMSH, gmsh_bed),
    ("bed22.msh", ["--msh-version", "2.2", *BED], MESHIO, meshio_bed),
    ("plate2.msh", SECOND, GMSH, gmsh_msh_2),
    ("plate2.msh", SECOND, MESHIO, meshio_2),
    ("plate22.msh", ["--msh-version", "2.2"], GMSH, gmsh_msh),
    ("plate22.msh", ["--msh-version", "2.2"], MESHIO, meshio_msh),
    ("plate222.msh", ["--msh-version", "2.2", *SECOND], GMSH, gmsh_msh_2),
    ("plate222.msh", ["--msh-version", "2.2", *SECOND], MESHIO, meshio_2),
    ("names.msh", [], GMSH, gmsh_names),
    ("names22.msh", ["--msh-version", "2.2"], GMSH, gmsh_names),
    ("names22.msh", ["--msh-version", "2.2"], MESHIO, meshio_names),
    ("plate.node", [], NUMPY, numpy_node),
    ("plate2.node", SECOND, NUMPY, numpy_node_2),
    ("names.node", [], NUMPY, numpy_node_names),
    ("plate.edge", [], NUMPY, numpy_edge),
    ("plate.neigh", [], NUMPY, numpy_neigh),
    ("fort.14", ["--open-boundary", "2"], NUMPY, numpy_adcirc),
    ("bed.14", ["--open-boundary", "2", *BED], NUMPY, numpy_adcirc_bed),
    ("plate.grd", ["--open-boundary", "2"], NUMPY, numpy_adcirc),
    ("plate.gr3", ["--open-boundary", "2"], NUMPY, numpy_adcirc),
    ("bed.2dm", BED, QGIS, qgis_2dm),
    ("bed.2dm", BED, NUMPY, numpy_2dm),
    ("names.2dm", BED, QGIS, qgis_2dm),
    ("names.2dm", BED, NUMPY, numpy_2dm_names),
    ("bed.nc", BED, QGIS, qgis_ugrid),
    ("bed.nc", BED, NETCDF4, netcdf4_ugrid),
    ("bed.nc", BED, XARRAY, xarray_ugrid),
    ("parts.nc", ["--parts", "4"], NETCDF4, netcdf4_parts),
    ("names.nc", [], NETCDF4, netcdf4_names),
    ("bed.slf", BED, QGIS, qgis_selafin),
    ("bed.slf", BED, NUMPY, numpy_selafin),
    ("plate.xdmf", [], XDMF, xdmf),
    ("values.xdmf", [*BED, "--parts", "4"], XDMF, xdmf_values),
    ("plate2.xdmf", SECOND, XDMF, xdmf_2),
    ("names.xdmf", [], XDMF, xdmf_names),
    ("plate.exo", [], VTK, vtk_exodus),
    ("plate.exo", [], NETCDF4, netcdf4_exodus),
    ("values.exo", [*BED, "--parts", "4"], VTK, vtk_exodus_values),
    ("values.exo", [*BED, "--parts", "4"], MESHIO, meshio_exodus),
    ("plate.e", [], VTK, vtk_exodus),
    ("bed2.exo", [*BED, *SECOND], VTK, vtk_exodus_2),
    ("bed2.exo", [*BED, *SECOND], MESHIO, meshio_exodus_2),
    ("names.exo", [], VTK, vtk_exodus_names),
    ("plate.foam", [], VTK, vtk_openfoam),
    ("plate.foam", [], OPENFOAM, check_mesh_openfoam),
    ("names.foam", [], VTK, vtk_openfoam_names),
    ("names.foam", [], OPENFOAM, check_mesh_openfoam),
    ("bed.disv", BED, SHAPELY, shapely_disv),
    ("plate.su2", [], MESHIO, meshio_su2),
    ("names.su2", [], MESHIO, meshio_su2_names),
    ("plate.mesh", [], MESHIO, meshio_medit),
    ("plate.vol", [], NETGEN, netgen_vol),
    ("names.vol", [], NETGEN, netgen_names),
    ("plate.mfem", [], NUMPY, numpy_mfem),
    ("names.mfem", [], NUMPY, numpy_mfem_names),
    ("plate.inp", [], MESHIO, meshio_inp),
    ("names.inp", [], MESHIO, meshio_inp_names),
    ("plate.npz", [], NUMPY, numpy_npz),
    ("rcm.npz", ["--renumber", "rcm"], NUMPY, numpy_rcm),
    ("parts.npz", ["--parts", "4"], NUMPY, numpy_parts),
    ("names.npz", [], NUMPY, numpy_npz_names),
    ("plate.geojson", [], SHAPELY, shapely_geojson),
    ("names.geojson", [], SHAPELY, shapely_names),
    ("plate.obj", [], MESHIO, meshio_surface),
    ("plate.obj", [], VTK, vtk_surface(vtk.vtkOBJReader())),
    ("plate.off", [], MESHIO, meshio_surface),
    ("plate.ply", [], MESHIO, meshio_surface),
    ("plate.ply", [], VTK, vtk_surface(vtk.vtkPLYReader())),
    ("plate.stl", [], MESHIO, meshio_stl),
    ("plate.stl", [], VTK, vtk_surface(vtk.vtkSTLReader())),
]


def capabilities(weft, folder, source, extension):
    """What the table of formats says of one, as weft does it: written, --order 2, read, values, parts,
    names."""
    def run(*words):
        return subprocess.run([weft, *words], cwd=folder, capture_output=True, text=True)
    name = "any" + extension
    made = run("convert", source, name, "--nodal", "depth=1", "--nodal", "other=2", "--parts", "2")
    equal(f"exit status, {name}", (made.returncode, made.stderr), (0, ""))
    lost = re.search(r"WARNING: .* values at vertices: (.*)", made.stdout)
    lost_names = re.search(r"WARNING: .* carry these names: (.*)", made.stdout)
    lost_kinds = {kind for kind in ("marker", "region") if lost_names and kind in lost_names[1]}
    return ["yes",
            "yes" if run("convert", source, "second" + extension, "--order", "2").returncode == 0 else "",
            "yes" if run("info", name).stdout.startswith("mesh ") else "",
            {None: "all", "other": "the bed", "depth, other": ""}[lost and lost[1]],
            "" if "does not carry the parts" in made.stdout else "yes",
            {0: "all", 1: "of markers", 2: ""}[len(lost_kinds)]]


def check_table_of_formats(weft, docs, folder, source, written):
    """The columns of the table that say yes or no. "yes, .ele too" is a yes, "as a domain" is none."""
    said = {}
    for line in open(docs):
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if len(cells) != 10 or not cells[0].startswith("`."):
            continue
        for extension in re.findall(r"`(\.\w+)`", cells[0]):
            read = "yes" if cells[4].startswith("yes") else ""
            said[extension] = [cells[2], cells[3], read, cells[5], cells[6], cells[7]]
    equal("table of formats", said,
          {extension: capabilities(weft, folder, source, extension) for extension in written})


def main():
    weft, docs = os.path.abspath(sys.argv[1]), sys.argv[2]
    rows = []
    os.environ["QT_QPA_PLATFORM"] = "offscreen"
    qgis = QgsApplication([], False)
    qgis.initQgis()
    with tempfile.TemporaryDirectory() as folder:
        source = os.path.join(folder, "source.npz")
        numpy.savez_compressed(source, **plate())
        named = os.path.join(folder, "named.npz")
        numpy.savez_compressed(named, **plate(), **names_of_source())
        bed_file(os.path.join(folder, "bed.asc"))
        for name, flags, reader, check in CHECKS:
            path = os.path.join(folder, name)
            if not os.path.exists(path):
                subprocess.run([weft, "convert", named if name.startswith("names") else source, path, "--quiet", *flags], check=True,
                               cwd=folder)
            about = ", with names" if name.startswith("names") else ""
            row = f"| `{' '.join([os.path.splitext(name)[1], *flags])}`{about} | {reader} |"
            print(row, flush=True)
            rows.append(row)
            check(path)
        check_models(weft, folder)
        format_table.check(docs, "| written by weft | read by |", rows)
        usage = subprocess.run([weft, "convert", "--help"], check=True, capture_output=True,
                               text=True).stdout
        written = re.search(r"^  OUT .*? Mesh: ([^;]*)", usage, re.M)[1].split(", ")
        equal("formats that weft writes", sorted({os.path.splitext(c[0])[1] for c in CHECKS}),
              sorted(written))
        check_table_of_formats(weft, docs, folder, named, written)
    qgis.exitQgis()


main()
