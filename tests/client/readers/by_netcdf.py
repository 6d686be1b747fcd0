# SPDX-License-Identifier: Apache-2.0
"""What netCDF4 and xarray read."""

import netCDF4
import numpy
import xarray

from readers.plate import (EDGES, MARKERS, NAMES, REGIONS, SIDES, TRIANGLES, VERTICES, check_bed,
                           check_mesh, check_parts, equal, plate, tally)


def netcdf4_ugrid(path):
    with netCDF4.Dataset(path) as file:
        equal("format", file.data_model, "NETCDF3_64BIT_OFFSET")
        mesh, = file.get_variables_by_attributes(cf_role="mesh_topology")
        equal("dimension", int(mesh.topology_dimension), 2)
        x, y = (file[name][:] for name in mesh.node_coordinates.split())
        points = numpy.column_stack([x, y])
        check_mesh(points, file[mesh.face_node_connectivity][:])
        edges = file[mesh.edge_node_connectivity][:]
        equal("edges", len({tuple(e) for e in edges.tolist()}), SIDES)
        by_place = lambda place: {v.name: v for v in file.get_variables_by_attributes(location=place)}
        equal("regions", tally(by_place("face")["mesh2d_region"][:]), REGIONS)
        equal("markers", tally(by_place("edge")["mesh2d_edge_marker"][:]),
              {**MARKERS, 0: SIDES - EDGES})
        bed = by_place("node")["mesh2d_node_z"]
        equal("bed", (bed.standard_name, bed.positive, bed.units), ("altitude", "up", "m"))
        check_bed(points, bed[:])
        check_bed(points, by_place("node")["mesh2d_elevation"][:])


def xarray_ugrid(path):
    with xarray.open_dataset(path) as data:
        equal("dimensions", dict(data.sizes), {
            "mesh2d_nNodes": VERTICES, "mesh2d_nEdges": SIDES, "mesh2d_nFaces": TRIANGLES,
            "mesh2d_nMax_face_nodes": 3, "Two": 2})
        points = numpy.column_stack([data.mesh2d_node_x, data.mesh2d_node_y])
        check_bed(points, data.mesh2d_node_z)
        faces = data.mesh2d_face_nodes.values
        middles = points[faces.astype(int)].mean(axis=1)
        equal("regions are where they were",
              bool(((middles[:, 0] < 6) == (data.mesh2d_region.values == 3)).all()), True)


def netcdf4_parts(path):
    with netCDF4.Dataset(path) as file:
        equal("location", file["mesh2d_part"].location, "face")
        check_parts(file["mesh2d_part"][:])


def netcdf4_exodus(path):
    """The original numbers of the triangles, which the others do not show."""
    with netCDF4.Dataset(path) as file:
        triangles = numpy.concatenate([file["connect1"][:], file["connect2"][:]]) - 1
        equal("triangles", bool((triangles == plate()["triangles"][file["elem_num_map"][:] - 1]).all()),
              True)
        equal("ids of blocks, of side sets", (file["eb_prop1"][:].tolist(), file["ss_prop1"][:].tolist()),
              (sorted(REGIONS), sorted(MARKERS)))


def netcdf4_names(path):
    with netCDF4.Dataset(path) as file:
        for dimension, variable in ((1, "mesh2d_edge_marker"), (2, "mesh2d_region")):
            flags = file[variable]
            equal("flags", dict(zip(numpy.ravel(flags.flag_values).tolist(),
                                    flags.flag_meanings.split(" "))),
                  {k: v.replace(" ", "_") for k, v in NAMES[dimension].items()})
