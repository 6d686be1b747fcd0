# SPDX-License-Identifier: Apache-2.0
"""What libxdmf reads."""

import collections
import ctypes
import itertools

import numpy

from readers.plate import (AREA, EDGES, MARKERS, NAMES, REGIONS, TRIANGLES, area, check_bed,
                           check_mesh, check_midsides, check_parts, equal, tally)


class Xdmf:
    """libxdmf by its functions in C; Debian's module of Python lacks some that it names."""

    def __init__(self, path):
        self.library = ctypes.CDLL("libXdmf.so.3")
        reader = self.call("XdmfReaderNew")
        status = ctypes.c_int()
        domain = self.call("XdmfReaderRead", reader, path.encode(), ctypes.byref(status))
        equal("status of libxdmf", status.value, 1)
        self.grid = self.call("XdmfDomainGetUnstructuredGrid", domain, ctypes.c_uint(0))

    def call(self, name, *words):
        function = getattr(self.library, name)
        function.restype = ctypes.c_void_p
        return function(*(ctypes.c_void_p(w) if type(w) is int else w for w in words))

    def values(self, kind, item):
        status = ctypes.c_int()
        self.call(f"Xdmf{kind}Read", item, ctypes.byref(status))
        equal("status of libxdmf", status.value, 1)
        text = ctypes.string_at(self.call(f"Xdmf{kind}GetValuesString", item)).decode()
        return numpy.array(text.split(), float)

    def points(self):
        return self.values("Geometry", self.call("XdmfUnstructuredGridGetGeometry",
                                                 self.grid)).reshape(-1, 2)

    def cells(self):
        """Cells by their kind, each an array of the nodes."""
        item = self.call("XdmfUnstructuredGridGetTopology", self.grid)
        numbers = iter(self.values("Topology", item).astype(int).tolist())
        cells = collections.defaultdict(list)
        for kind in numbers:
            size = next(numbers) if kind == 2 else {4: 3, 36: 6, 34: 3}[kind]
            cells[kind].append(list(itertools.islice(numbers, size)))
        return {kind: numpy.array(nodes) for kind, nodes in cells.items()}

    def attribute(self, name):
        return self.values("Attribute", self.call("XdmfUnstructuredGridGetAttributeByName",
                                                  self.grid, name.encode()))


    def information(self, name):
        item = self.call("XdmfUnstructuredGridGetInformationByKey", self.grid, name.encode())
        equal(f"there is information on {name}", bool(item), True)
        return ctypes.string_at(self.call("XdmfInformationGetValue", item)).decode()


def xdmf(path):
    file = Xdmf(path)
    cells = file.cells()
    check_mesh(file.points(), cells[4])
    equal("edges", cells[2].shape, (EDGES, 2))
    equal("regions", tally(file.attribute("region")[:TRIANGLES]), REGIONS)
    equal("markers", tally(file.attribute("marker")[TRIANGLES:]), MARKERS)


def xdmf_2(path):
    file = Xdmf(path)
    points, cells = file.points(), file.cells()
    equal("area", area(points, cells[36]), AREA)
    check_midsides(points, cells[36], [(0, 1), (1, 2), (2, 0)])
    check_midsides(points, cells[34], [(0, 1)])


def xdmf_values(path):
    file = Xdmf(path)
    check_bed(file.points(), file.attribute("elevation"))
    parts = file.attribute("part")
    check_parts(parts[:TRIANGLES])
    equal("edges are of no part", tally(parts[TRIANGLES:]), {-1: EDGES})


def xdmf_names(path):
    file = Xdmf(path)
    check_mesh(file.points(), file.cells()[4])
    for dimension, kind in ((1, "marker"), (2, "region")):
        equal("names", {number: file.information(f"{kind} {number}") for number in NAMES[dimension]},
              NAMES[dimension])
