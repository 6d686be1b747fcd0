# SPDX-License-Identifier: Apache-2.0
"""Writes VTK's unstructured grid, the same bytes as files/formats/meshes/vtu_writer.cpp: XML with raw
appended data, the triangles and then the edges on input segments as lines, cell data `region` and
`marker`.
"""

from __future__ import annotations

from typing import BinaryIO

import numpy as np
import numpy.typing as npt

_LINE, _TRIANGLE = 3, 5


def write(file: BinaryIO, points: npt.NDArray[np.float64], triangles: npt.NDArray[np.int32],
          regions: npt.NDArray[np.int32], edges: npt.NDArray[np.int32],
          markers: npt.NDArray[np.int32]) -> None:
    m, k = len(triangles), len(edges)
    in_space = np.zeros((len(points), 3))
    in_space[:, :2] = points
    sections = [
        ('<Points><DataArray type="Float64" Name="Points" NumberOfComponents="3"', in_space),
        ('</Points><Cells><DataArray type="UInt32" Name="connectivity"',
         np.concatenate([triangles.ravel(), edges.ravel()]).astype("<u4")),
        ('<DataArray type="Int64" Name="offsets"',
         np.concatenate([3 * np.arange(1, m + 1), 3 * m + 2 * np.arange(1, k + 1)]).astype("<i8")),
        ('<DataArray type="UInt8" Name="types"', np.repeat([_TRIANGLE, _LINE], [m, k]).astype("u1")),
        ('</Cells><CellData><DataArray type="Int32" Name="region"',
         np.concatenate([regions, np.zeros(k, np.int32)])),
        ('<DataArray type="Int32" Name="marker"', np.concatenate([np.zeros(m, np.int32), markers])),
    ]
    header = ('<?xml version="1.0"?>\n'
              '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
              'header_type="UInt64">\n'
              f'<UnstructuredGrid><Piece NumberOfPoints="{len(points)}" NumberOfCells="{m + k}">\n')
    offset = 0
    for tag, array in sections:
        header += f'{tag} format="appended" offset="{offset}"/>\n'
        offset += 8 + array.nbytes
    header += '</CellData></Piece></UnstructuredGrid>\n<AppendedData encoding="raw">\n_'
    file.write(header.encode())
    for _, array in sections:
        file.write(array.nbytes.to_bytes(8, "little"))
        file.write(array.data)
    file.write(b"\n</AppendedData>\n</VTKFile>\n")
