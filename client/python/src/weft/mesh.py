# SPDX-License-Identifier: Apache-2.0
"""A mesh, as numpy arrays."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import tempfile
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _vtu
from ._optional import need
from .errors import MeshFileError
from .quality import Quality, quality_of

if TYPE_CHECKING:
    from .results import Summary

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

# What `plot` colors triangles by, and what the color bar says.
_LABELS = {"angle": "smallest angle, degrees", "area": "area", "region": "region"}


@dataclasses.dataclass(frozen=True, eq=False)
class Mesh:
    """A graded, constrained Delaunay triangulation; verified against its digest.

        mesh = client.mesh("coast.geojson", size=1e-3)
        mesh.points[mesh.triangles].mean(axis=1)     # the centroids, (m, 2)
    """

    points: Floats
    """(n, 2) float64: the vertices, in the unit of the domain."""
    triangles: Ints
    """(m, 3) int32: vertex numbers, counter-clockwise."""
    regions: Ints
    """(m,) int32: region id per triangle, 0 if there is none."""
    edges: Ints
    """(k, 2) int32: vertex numbers of the edges that lie on input segments."""
    edge_markers: Ints
    """(k,) int32: marker per edge."""
    edge_segments: Ints
    """(k,) int32: index of the input segment per edge; the lowest where several overlap."""
    input_points: Ints
    """(p, 2) int32: vertex number and index of the input point, for each vertex that is one."""
    summary: Summary
    """What the server says of it."""

    @property
    def digest(self) -> str:
        """SHA-256 in hexadecimal: the name of the mesh. The same request on the same engine version
        gives the same digest, everywhere."""
        return self.summary.digest

    def __repr__(self) -> str:
        return (f"<weft.Mesh of {len(self.triangles):,} triangles, {len(self.points):,} vertices, "
                f"angles {self.summary.min_angle_deg:.2f} to {self.summary.max_angle_deg:.2f} degrees>")

    def quality(self) -> Quality:
        """Areas, angles and aspect ratios of all triangles, computed here."""
        return quality_of(self.points, self.triangles)

    def boundary(self) -> Ints:
        """(b, 2) int32: the edges that belong to one triangle only, each with the mesh on its left.

        The edges on segments inside the domain are in `edges`, and not in here.
        """
        sides = np.concatenate([self.triangles[:, [0, 1]], self.triangles[:, [1, 2]],
                                self.triangles[:, [2, 0]]])
        names = np.sort(sides, axis=1).astype(np.int64)
        _, first, count = np.unique(names[:, 0] * len(self.points) + names[:, 1],
                                    return_index=True, return_counts=True)
        alone: Ints = sides[np.sort(first[count == 1])]
        return alone

    def to_meshio(self) -> Any:
        """A meshio.Mesh: cells `triangle` and `line` (those of `edges`), cell data `region` (0 on
        lines) and `marker` (0 on triangles). Raises MissingPackage without meshio."""
        return self._meshio(self.points)

    def _meshio(self, points: Floats) -> Any:
        zeros = [np.zeros(len(cells), np.int32) for cells in (self.triangles, self.edges)]
        return need("meshio", "Mesh.to_meshio").Mesh(
            points, [("triangle", self.triangles), ("line", self.edges)],
            cell_data={"region": [self.regions, zeros[1]], "marker": [zeros[0], self.edge_markers]})

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes a file, by its suffix: .vtu, or with meshio one of meshio's formats.

        .msh is Gmsh 2.2 with regions and markers as physical groups; .obj, .off, .ply and .stl hold
        the triangles alone.

        The file appears when it is complete. Raises MeshFileError where meshio knows no such
        format, MissingPackage without meshio, OSError where it cannot be written.
        """
        path = pathlib.Path(path)
        with tempfile.TemporaryDirectory(dir=path.absolute().parent, prefix=".weft-") as folder:
            part = pathlib.Path(folder) / path.name
            if path.suffix == ".vtu":
                with open(part, "wb") as file:
                    _vtu.write(file, self.points, self.triangles, self.regions, self.edges,
                               self.edge_markers)
            else:
                self._write_by_meshio(path, part)
            os.replace(part, path)

    def _write_by_meshio(self, path: pathlib.Path, part: pathlib.Path) -> None:
        meshio = need("meshio", f"writing {path.suffix} files")
        in_space = np.column_stack([self.points, np.zeros(len(self.points))])
        mesh = self._meshio(in_space)
        form = None
        if path.suffix in (".obj", ".off", ".ply", ".stl"):
            mesh = meshio.Mesh(in_space, [("triangle", self.triangles)])
        elif path.suffix == ".msh":
            form = "gmsh22"
            groups = [self.regions, self.edge_markers]
            mesh.cell_data = {"gmsh:physical": groups, "gmsh:geometrical": groups}
        try:
            mesh.write(part, file_format=form)
        except (meshio.ReadError, meshio.WriteError, KeyError) as error:
            raise MeshFileError(f"{path}: {error}") from None

    def plot(self, color: str | npt.ArrayLike | None = None, ax: Any = None, *,
             segments: bool = True, linewidth: float = 0.3, **keywords: Any) -> Any:
        """Draws the mesh with matplotlib; gives back the Axes.

        `color`: None draws edges alone; "angle" fills triangles by their smallest angle in degrees,
        "area" by their area, "region" by their region; an array (m,) by its values, (n,) by values
        at the vertices. `ax`: the Axes to draw into; default: a new figure. `segments`: whether
        edges on input segments are drawn over it. `keywords` go to tripcolor or triplot. Raises
        MissingPackage without matplotlib.
        """
        if ax is None:
            ax = need("matplotlib.pyplot", "Mesh.plot").subplots(layout="constrained")[1]
        x, y = self.points.T
        if color is None:
            ax.triplot(x, y, self.triangles, **{"color": "0.4", "linewidth": linewidth, **keywords})
        else:
            drawn = ax.tripcolor(
                x, y, self.triangles, self._values(color),
                **{"edgecolors": "face" if linewidth == 0 else "#00000060",
                   "linewidth": linewidth, **keywords})
            label = _LABELS[color] if isinstance(color, str) else None
            ax.figure.colorbar(drawn, ax=ax, shrink=0.8, label=label)
        if segments:
            lines = need("matplotlib.collections", "Mesh.plot").LineCollection
            ax.add_collection(lines(self.points[self.edges], colors="k", linewidths=2 * linewidth))
        ax.set_aspect("equal")
        return ax

    def _values(self, color: str | npt.ArrayLike) -> npt.NDArray[Any]:
        if not isinstance(color, str):
            return np.asarray(color)
        if color == "angle":
            return self.quality().min_angles
        if color == "area":
            return self.quality().areas
        if color == "region":
            return self.regions
        raise ValueError(f"color is {color!r}; there are {', '.join(_LABELS)}, None and arrays")
