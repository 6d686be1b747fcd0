# SPDX-License-Identifier: Apache-2.0
"""What QGIS reads."""

import sys

import numpy
from qgis.core import QgsMesh, QgsMeshDatasetGroupMetadata, QgsMeshDatasetIndex, QgsMeshLayer

from readers.plate import REGIONS, check_bed, check_mesh, equal, tally


def qgis_mesh(path):
    """What MDAL finds: points, triangles, and values by the name of their group."""
    layer = QgsMeshLayer(path, "plate", "mdal")  # the provider lives as long as the layer
    provider = layer.dataProvider()
    if not provider.isValid():
        sys.exit(f"QGIS does not read {path}")
    mesh = QgsMesh()
    provider.populateMesh(mesh)
    vertices = [mesh.vertex(i) for i in range(mesh.vertexCount())]
    values = {}
    for g in range(provider.datasetGroupCount()):
        group = provider.datasetGroupMetadata(g)
        at_vertices = group.dataType() == QgsMeshDatasetGroupMetadata.DataOnVertices
        count = mesh.vertexCount() if at_vertices else mesh.faceCount()
        block = provider.datasetValues(QgsMeshDatasetIndex(g, 0), 0, count)
        values[group.name()] = [block.value(i).scalar() for i in range(count)]
    points = numpy.array([(v.x(), v.y(), v.z()) for v in vertices])
    triangles = [mesh.face(i) for i in range(mesh.faceCount())]
    check_mesh(points, triangles)
    return points, values


def qgis_selafin(path):
    points, values = qgis_mesh(path)
    check_bed(points, values["bottom".ljust(16) + "m"])  # with its unit


def qgis_2dm(path):
    points, values = qgis_mesh(path)
    check_bed(points, points[:, 2])
    equal("materials", tally(values["Material ID"]), REGIONS)


def qgis_ugrid(path):
    points, values = qgis_mesh(path)
    check_bed(points, points[:, 2])
    check_bed(points, values["elevation"])
    equal("regions", tally(values["Region of the triangle"]), REGIONS)
