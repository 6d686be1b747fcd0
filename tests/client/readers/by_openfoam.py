# SPDX-License-Identifier: Apache-2.0
"""What VTK and checkMesh make of OpenFOAM's cases."""

import os
import re
import subprocess

import vtk
from vtk.util.numpy_support import vtk_to_numpy

from readers.plate import AREA, BOUNDARY, REGIONS, TRIANGLES, VERTICES, equal


def vtk_openfoam(path, names={1: {}, 2: {}}):
    reader = vtk.vtkOpenFOAMReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.EnableAllPatchArrays()
    reader.ReadZonesOn()
    reader.Update()
    blocks = {}

    def collect(data):
        for i in range(data.GetNumberOfBlocks()):
            block = data.GetBlock(i)
            name = data.GetMetaData(i).Get(vtk.vtkCompositeDataSet.NAME())
            if isinstance(block, vtk.vtkMultiBlockDataSet):
                collect(block)
            elif block is not None:
                blocks[name] = block
    collect(reader.GetOutput())
    thickness = (AREA / TRIANGLES) ** 0.5
    inside = blocks["internalMesh"]
    equal("points, cells", (inside.GetNumberOfPoints(), inside.GetNumberOfCells()),
          (2 * VERTICES, TRIANGLES))
    size = vtk.vtkCellSizeFilter()
    size.SetInputData(inside)
    size.Update()
    volumes = vtk_to_numpy(size.GetOutput().GetCellData().GetArray("Volume"))
    equal("volume", (round(float(volumes.sum()), 4), bool((volumes > 0).all())),
          (round(AREA * thickness, 4), True))  # VTK reads single precision
    walls = {names[1].get(m, f"marker_{m}"): n for m, n in BOUNDARY.items()}
    zones = {names[2].get(r, f"region_{r}"): n for r, n in REGIONS.items()}
    equal("patches", {n: blocks[n].GetNumberOfCells() for n in walls}, walls)
    equal("front and back", blocks["frontAndBack"].GetNumberOfCells(), 2 * TRIANGLES)
    equal("zones", {n: blocks[n].GetNumberOfCells() for n in zones}, zones)
    equal("blocks", sorted(blocks), sorted(["internalMesh", "frontAndBack", *walls, *zones]))


def vtk_openfoam_names(path):
    vtk_openfoam(path, {1: {2: "inlet", 4: "outer_wall"}, 2: {3: "fluid"}})


def check_mesh_openfoam(path):
    """OpenFOAM's own judge of meshes, which wants a case around it."""
    case = os.path.dirname(path)
    os.makedirs(os.path.join(case, "system"), exist_ok=True)
    schemes = " ".join(f"{name}Schemes {{ default none; }}" for name in (
        "ddt", "grad", "div", "laplacian", "interpolation", "snGrad"))
    for name, entries in (("controlDict", "deltaT 1; writeInterval 1;"), ("fvSchemes", schemes),
                          ("fvSolution", "")):
        with open(os.path.join(case, "system", name), "w") as file:
            file.write(f"FoamFile {{ version 2.0; format ascii; class dictionary; object {name}; }}\n"
                       + entries)
    told = subprocess.run(["checkMesh", "-case", case], capture_output=True, text=True,
                          env={**os.environ, "WM_PROJECT_DIR": "/usr/share/openfoam"})
    text = told.stdout + told.stderr
    for patch in ("inlet", "outer_wall") if os.path.basename(path) == "names.foam" else ():
        equal(f"checkMesh lists {patch}", bool(re.search(rf"^ *{patch} +12 ", text, re.M)) or text[-2000:],
              True)
    for line in ("Mesh OK.", "All edges aligned with or perpendicular to non-empty directions.",
                 "Mesh has 2 geometric (non-empty/wedge) directions (1 1 0)"):
        equal(f"checkMesh says {line}", (line in text) or text[-2000:], True)
