# SPDX-License-Identifier: Apache-2.0
"""A mesh, as numpy arrays."""

from __future__ import annotations

import dataclasses
import io
import os
import pathlib
import tempfile
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Literal, Union

import numpy as np
import numpy.typing as npt

from . import _carried, _convert, _npz, _patches, _periodic, _pixels, _solvers, _vtu
from ._groups import Groups
from ._masked import nan_where_masked
from ._optional import need
from ._warning import warn
from .errors import MeshFileError, MissingPackage
from .quality import Quality, quality_of

if TYPE_CHECKING:
    from .results import Summary

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

NodalSource = Union[npt.ArrayLike, str, "os.PathLike[str]"]
"""Values at vertices: an array (n,), a number, or the path of a raster, "FILE" or "FILE:BAND"."""

# What `plot` colors triangles by, and what the color bar says.
_LABELS = {"angle": "smallest angle, degrees", "size": "length of edges", "area": "area",
           "region": "region"}
_LOGARITHMIC = ("size", "area")
_PIXELS = 1000  # along the longer side of a mesh that is drawn as an image


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
    """(k,) int32: index of the input segment per edge; the lowest if several overlap. Empty if the
    mesh was read from a file."""
    input_points: Ints
    """(p, 2) int32: vertex number and index of the input point, for each vertex that is one; none if
    the mesh was read from a file."""
    summary: Summary
    """What the server says about it; if it was read from a file, what follows from its triangles,
    and otherwise 0 or empty."""
    marker_names: Mapping[int, str] = dataclasses.field(default_factory=dict)
    """What markers are called, by number, as the domain or the file had it."""
    region_names: Mapping[int, str] = dataclasses.field(default_factory=dict)
    """What regions are called, by number, as the domain or the file had it."""
    edge_bulges: Floats = dataclasses.field(default_factory=lambda: np.zeros(0))
    """(k,) float64: of the arc from an edge's first vertex to its second that it is a chord of, as Domain.arcs
    has them, 0 if it is straight; empty if all are."""
    values: Mapping[str, Floats] = dataclasses.field(default_factory=dict)
    """By name, (n,) float64: values at the vertices, such as depths, of a file that was read. `write`
    writes them."""
    parts: Ints = dataclasses.field(default_factory=lambda: np.zeros(0, np.int32))
    """(m,) int32: part per triangle, from 0, of a file that has them, as `write(parts=...)` and the
    command line's --parts make them; otherwise empty. `write` keeps them if the format does."""

    @staticmethod
    def read(path: str | os.PathLike[str]) -> Mesh:
        """A mesh from a file of a format that the command line reads: .npz, which is read here; .vtu,
        .msh, .node, .14 and all others are read by the program weft, which is in the package or in
        the PATH. See docs/formats.md.

        Values at the vertices are in `values`; those that miss a number, or whose names no format
        can hold, only if the file is an .npz. Raises MeshFileError if the file is not a mesh, its
        format is unknown, or the program is needed and missing; OSError if it cannot be read.

            old = weft.Mesh.read("fort.14")
            mesh = client.mesh(domain, edge=weft.on_mesh(old, 0.1*old.values["depth"]))
        """
        path = pathlib.Path(path)
        if path.suffix.lower() == ".npz":
            return _read_npz(path, path)
        with tempfile.TemporaryDirectory(prefix="weft-") as folder:
            npz = pathlib.Path(folder) / "mesh.npz"
            try:
                warned = _convert.convert(path, npz, error=MeshFileError).warnings
            except _convert.Refused as refused:
                raise MeshFileError(str(refused)) from None
            for sentence in warned:
                warn(sentence)
            return _read_npz(npz, path)

    @property
    def digest(self) -> str:
        """SHA-256 in hexadecimal: the name of the mesh. The same request on the same engine version
        gives the same digest, everywhere."""
        return self.summary.digest

    def __repr__(self) -> str:
        values = f", values {', '.join(self.values)}" if self.values else ""
        return (f"<weft.Mesh of {len(self.triangles):,} triangles, {len(self.points):,} vertices, "
                f"angles {self.summary.min_angle_deg:.2f} to {self.summary.max_angle_deg:.2f} degrees"
                f"{values}>")

    def _repr_png_(self) -> bytes | None:
        """The picture that a notebook shows; None without matplotlib."""
        try:
            figure = need("matplotlib.figure", "a picture").Figure(figsize=(7, 5), layout="constrained")
        except MissingPackage:
            return None
        self.plot(ax=figure.subplots(), most=20_000)
        file = io.BytesIO()
        figure.savefig(file, format="png", dpi=100)
        return file.getvalue()

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

    @property
    def boundaries(self) -> Groups:
        """By marker, its name or its number: (k, 2) int32, the edges on segments that carry it, inside
        the domain, too.

            mesh.points[np.unique(mesh.boundaries["inlet"])]
        """
        return Groups("marker", self.edge_markers, self.edges, self.marker_names)

    @property
    def subdomains(self) -> Groups:
        """By region, its name or its number: (k,) int32, the numbers of its triangles."""
        return Groups("region", self.regions, np.arange(len(self.triangles), dtype=np.int32),
                      self.region_names)

    def periodic(self, a: str | int, b: str | int) -> Ints:
        """(n, 2) int32: pairs of vertices of two sides that repeat each other, one of the side with the
        marker `a` and its image on that with the marker `b`, in order along `a` from its lower left end.

        `a`, `b`: markers, numbers or names. The motion that takes one side to the other, ends to ends and
        vertices to vertices, is a translation or a rotation that takes the inside of the mesh to the outside; or
        the other one of these two, if only that fits. Sides of several lines, such as those that holes cut,
        are moved from lower left corner to lower left corner of the boxes around them.

        Raises ValueError if a side is no open line, or names the first vertex that has no image within 1e-9 of
        the extent of the mesh; KeyError if no edge has the marker.

            left, right = mesh.periodic("left", "right").T
            u[right] = u[left]
        """
        return _periodic.pairs(self, a, b)

    def remesh(self, within: Any, size: float | str | None = None, min_angle: float = 20, **options: Any) -> Mesh:
        """The mesh with a part of it meshed anew: the triangles whose corners are all within polygons. The
        triangles outside, their vertices, regions, edges and values stay as they are. By the program weft,
        which is in the package or in the PATH.

        `within`: the path of a file of polygons, a GeoJSON object, a shapely geometry, or arrays (n, 2) of
        rings. `size`: upper bound on areas, a number or an expression in x and y. `options`: `edge`, a length
        instead, `edge_at`, `keep`, `lonlat`, and the options of Client.mesh that are one value.

        Raises DomainError for what `weft remesh` refuses, MeshFileError without the program.

            finer = mesh.remesh([(0, 0), (10, 0), (10, 5), (0, 5)], edge=0.1)
        """
        return _patches.remesh(self, within, {"size": size, "min_angle": min_angle, **options})

    def second_order(self) -> tuple[Floats, Ints]:
        """The points (n + e, 2), with the middles of all edges after the vertices, and the triangles (m, 6):
        behind the corners the middles between 1 and 2, 2 and 3, 3 and 1. As `write(order=2)` has them: on an
        edge that is a chord of an arc, the middle is that of the arc, unless a triangle would turn over."""
        return _solvers.second_order(self)

    def to_skfem(self) -> Any:
        """A skfem.MeshTri of scikit-fem. Its boundaries and subdomains have the names of markers and regions, or
        `marker 2` and `region 2` for what has none; 0 is none of them. Raises MissingPackage."""
        return _solvers.to_skfem(self)

    def to_dolfinx(self, comm: Any = None) -> tuple[Any, Any, Any]:
        """A mesh of FEniCSx (dolfinx 0.5), the tags of its cells, which are the regions, and those of its
        facets on segments, which are the markers.

        `comm`: the MPI communicator, over which the mesh is divided; every process must have the same
        mesh. Default: COMM_WORLD. Raises MissingPackage.

            domain, cells, facets = mesh.to_dolfinx()
            facets.find(mesh.boundaries.number("inlet"))
        """
        return _solvers.to_dolfinx(self, comm)

    def to_meshio(self) -> Any:
        """A meshio.Mesh: cells `triangle` and `line` (those of `edges`), cell data `region` (0 on
        lines) and `marker` (0 on triangles), field data as meshio has them: of each name its number and
        the dimension, 1 for a marker and 2 for a region. A WeftWarning says that a name of a marker is left
        out because a region has it, too. Raises MissingPackage without meshio."""
        mesh = self._meshio(self.points)
        for dimension, names in ((1, self.marker_names), (2, self.region_names)):
            for number, name in names.items():
                if name in mesh.field_data:
                    warn(f"to_meshio: the marker {mesh.field_data[name][0]} has no name: {name!r} is that of "
                         "a region, too")
                mesh.field_data[name] = np.array([number, dimension])
        return mesh

    def _meshio(self, points: Floats) -> Any:
        zeros = [np.zeros(len(cells), np.int32) for cells in (self.triangles, self.edges)]
        return need("meshio", "Mesh.to_meshio").Mesh(
            points, [("triangle", self.triangles), ("line", self.edges)],
            cell_data={"region": [self.regions, zeros[1]], "marker": [zeros[0], self.edge_markers]})

    def write(self, path: str | os.PathLike[str], order: Literal[1, 2] = 1, *,
              nodal: Mapping[str, NodalSource] | None = None, parts: int | None = None,
              renumber: Literal["none", "rcm"] = "none",
              msh_version: Literal["2.2", "4.1"] = "4.1",
              open_boundary: int | str | Iterable[int | str] = ()) -> None:
        """Writes a file in the format of its suffix, as the command line does: .vtu, .msh, .node, .14,
        .nc and all others of docs/formats.md; or else one of meshio's.

        `order`: 2 writes triangles of six nodes, with sides that follow arcs, to .vtu, .msh, .node, .xdmf,
        .exo, .e and .inp.
        `nodal`: values at the vertices, by name, besides those of `values` or instead of them: an
        array (n,), a number, or the path of a raster. `depth` is positive down, `elevation` positive
        up, both in metres.
        `parts`: divide the triangles into this number of parts, 1 to 65536, of the same size with few
        edges between them; stored in .vtu, .nc, .npz, .xdmf and .exo.
        `renumber`: "rcm" numbers the vertices by reverse Cuthill-McKee.
        `msh_version`: the version of .msh files.
        `open_boundary`: the marker, or markers, of segments that are open boundary in ADCIRC's .14
        and .grd and SCHISM's .gr3, by number or by name, or "deeper:50" for what of the outer
        boundary is deeper than 50 m by `depth` or `elevation`; the others are land.

        .npz without options is written here, and .vtu if nothing has a name or a part. The rest is
        written by the program weft, which is in the package or in the PATH. Formats that it does not
        write, and without it all that need no options, are written by meshio. A WeftWarning says what
        a file does not hold.

        The file appears when it is complete. Raises MeshFileError if the format is unknown or has no
        such option, or the program is needed and missing; ValueError unless values are one finite
        number per vertex; OSError if it cannot be written.

            mesh.write("fort.14", nodal={"depth": depth}, open_boundary="deeper:50")
        """
        path = pathlib.Path(path)
        values, options = self._nodal(nodal or {})
        markers = ([open_boundary] if isinstance(open_boundary, (int, str))
                   or not isinstance(open_boundary, Iterable) else list(open_boundary))
        options += [f"--open-boundary={marker}" for marker in markers]
        for flag, value, default in (("order", order, 1), ("parts", parts, None),
                                     ("renumber", renumber, "none"),
                                     ("msh-version", msh_version, "4.1")):
            if value != default:
                options.append(f"--{flag}={value}")
        arrays: dict[str, npt.NDArray[Any]] = {
            name: getattr(self, name)
            for name in ("points", "triangles", "regions", "edges", "edge_markers")}
        names = _npz.name_arrays(self.marker_names, self.region_names)
        suffix = path.suffix.lower()
        divided = {"parts": self.parts} if len(self.parts) and parts is None else {}
        curved = {"edge_bulges": self.edge_bulges} if len(self.edge_bulges) else {}
        with tempfile.TemporaryDirectory(dir=path.absolute().parent, prefix=".weft-") as folder:
            part = pathlib.Path(folder) / path.name
            if suffix == ".vtu" and not (values or options or names or divided):
                with open(part, "wb") as file:
                    _vtu.write(file, *arrays.values())
                os.replace(part, path)
            elif suffix == ".npz" and not values and not options:
                _npz.write(part, {**arrays, **curved, **names, **divided})
                os.replace(part, path)
            elif values or options or _carried.program("weft"):
                self._write_by_weft(path, part, {**arrays, **curved, **names, **divided, **values}, options)
            else:
                self._write_by_meshio(path, part)

    def _nodal(self, nodal: Mapping[str, NodalSource]) -> tuple[dict[str, Floats], list[str]]:
        """The arrays of values, and the options of weft for all others."""
        arrays = {name: values for name, values in self.values.items() if name not in nodal}
        options = []
        for name, source in nodal.items():
            if isinstance(source, (str, os.PathLike)):
                options.append(f"--nodal={name}={os.fspath(source)}")
                continue
            values = nan_where_masked(source, np.float64)
            if values.shape not in ((), (len(self.points),)):
                raise ValueError(f"nodal: {name} has the shape {values.shape}, expected "
                                 f"({len(self.points)},), a number per vertex")
            if not np.isfinite(values).all():
                raise ValueError(f"nodal: {name} is {values[~np.isfinite(values)].flat[0]} at vertex "
                                 f"{np.flatnonzero(~np.isfinite(values))[0]}")
            arrays[name] = np.broadcast_to(values, len(self.points))
        for name in arrays:
            if name in _npz.MESH_ARRAYS:
                raise ValueError(f"nodal: {name} is an array of the mesh itself")
        return arrays, options

    def _write_by_weft(self, path: pathlib.Path, part: pathlib.Path,
                       arrays: Mapping[str, npt.NDArray[Any]], options: list[str]) -> None:
        npz = part.with_name("arrays.npz")
        _npz.write(npz, arrays)
        try:
            warned = _convert.convert(npz, path, *options, error=MeshFileError).warnings
        except _convert.Refused as refused:
            if not refused.usage or options:
                raise MeshFileError(str(refused)) from None
            try:
                self._write_by_meshio(path, part)
            except (MeshFileError, MissingPackage):
                raise MeshFileError(str(refused)) from None
            return
        for sentence in warned:
            warn(sentence)

    def _write_by_meshio(self, path: pathlib.Path, part: pathlib.Path) -> None:
        if path.suffix in (".node", ".ele"):  # of TetGen, to meshio
            raise MeshFileError(f"{path}: needs the program weft")
        for what, lost in (("parts of the triangles", len(self.parts)),
                           ("names of markers and regions", self.marker_names or self.region_names)):
            if lost:
                warn(f"{path}: the {what} are not written")
        meshio = need("meshio", f"without the program weft, writing {path.suffix} files")
        in_space = np.column_stack([self.points, np.zeros(len(self.points))])
        mesh = self._meshio(in_space)
        form = None
        if path.suffix in (".obj", ".off", ".ply", ".stl"):
            mesh = meshio.Mesh(in_space, [("triangle", self.triangles)])
        elif path.suffix == ".msh":
            form = "gmsh22"
            groups = [self.regions, self.edge_markers]
            mesh.cell_data = {"gmsh:physical": groups, "gmsh:geometrical": groups}
        elif path.suffix == ".mesh":  # Medit, of two dimensions, as FreeFem++ reads it
            mesh.points = self.points
            mesh.cell_data = {"medit:ref": [self.regions, self.edge_markers]}
        try:
            mesh.write(part, file_format=form)
        except (meshio.ReadError, meshio.WriteError, KeyError) as error:
            raise MeshFileError(f"{path}: {error}") from None
        os.replace(part, path)

    def plot(self, color: str | npt.ArrayLike | None = None, ax: Any = None, *,
             segments: bool = True, linewidth: float = 0.3, most: int = 100_000,
             box: tuple[float, float, float, float] | None = None, **keywords: Any) -> Any:
        """Draws the mesh with matplotlib; gives back the Axes.

        `color`: None draws edges alone; "angle" fills triangles by their smallest angle in degrees;
        "size" by their size, as the length of the edges of the equilateral triangle of the same
        area, and "area" by their area, both on a logarithmic scale; "region" by their region; an
        array (m,) by its values, (n,) by values at the vertices. `ax`: the Axes to draw into;
        default: a new figure. `segments`: whether edges on input segments are drawn over it.
        `box`: min x, min y, max x, max y: draw this part alone. `keywords` go to tripcolor or
        triplot, or to imshow for an image.

        More than `most` triangles, 100,000 by default, are drawn as an image of 1000 pixels along
        its longer side: a pixel has the mean of the triangles in it, by their area (of regions, one
        of them); without a color, of their size. `box` shows a part of a large mesh in detail.
        Raises MissingPackage without matplotlib.

            mesh.plot("size", box=(-74.3, 40.4, -73.7, 40.9))
        """
        if ax is None:
            ax = need("matplotlib.pyplot", "Mesh.plot").subplots(layout="constrained")[1]
        lower, upper = self._bounds() if box is None else (np.array(box[:2]), np.array(box[2:]))
        shown = _meets(self.points[self.triangles], lower, upper) if box else np.ones(
            len(self.triangles), bool)
        thinned = int(shown.sum()) > most
        if color is None and thinned:
            color = "size"
        if color is None:
            ax.triplot(*self.points.T, self.triangles[shown],
                       **{"color": "0.4", "linewidth": linewidth, **keywords})
        else:
            if isinstance(color, str) and color in _LOGARITHMIC and "norm" not in keywords:
                limits = [keywords.pop(name, None) for name in ("vmin", "vmax")]
                keywords["norm"] = need("matplotlib.colors", "Mesh.plot").LogNorm(*limits)
            draw = self._draw_pixels if thinned else self._draw_triangles
            drawn = draw(ax, color, shown, (*lower, *upper), linewidth, keywords)
            label = _LABELS[color] if isinstance(color, str) else None
            ax.figure.colorbar(drawn, ax=ax, shrink=0.8, label=label)
        if segments:
            lines = self.points[self.edges]
            if box:
                lines = lines[_meets(lines, lower, upper)]
            width = 0.2 if thinned else 2 * linewidth
            ax.add_collection(need("matplotlib.collections", "Mesh.plot").LineCollection(
                lines, colors="k", linewidths=width, rasterized=thinned))
        if box:
            ax.set_xlim(lower[0], upper[0])
            ax.set_ylim(lower[1], upper[1])
        else:
            ax.autoscale_view()
        ax.set_aspect("equal")
        return ax

    def _draw_triangles(self, ax: Any, color: str | npt.ArrayLike, shown: npt.NDArray[np.bool_],
                        box: tuple[float, ...], linewidth: float, keywords: dict[str, Any]) -> Any:
        values = self._values(color)
        if len(values) == len(self.triangles):
            values = values[shown]
        return ax.tripcolor(*self.points.T, self.triangles[shown], values,
                            **{"edgecolors": "face" if linewidth == 0 else "#00000060",
                               "linewidth": linewidth, **keywords})

    def _draw_pixels(self, ax: Any, color: str | npt.ArrayLike, shown: npt.NDArray[np.bool_],
                     box: tuple[float, ...], linewidth: float, keywords: dict[str, Any]) -> Any:
        values = self._values(color)
        if len(values) != len(self.triangles):
            values = values[self.triangles].mean(axis=1)
        left, bottom, right, top = box
        picture = _pixels.image(self.points[self.triangles[shown]],
                                np.asarray(values, np.float64)[shown], (left, bottom, right, top),
                                _PIXELS, not (isinstance(color, str) and color == "region"))
        return ax.imshow(picture, **{"origin": "lower", "extent": (left, right, bottom, top),
                                     "interpolation": "nearest", **keywords})

    def _bounds(self) -> tuple[Floats, Floats]:
        if not len(self.points):
            return np.zeros(2), np.ones(2)
        return self.points.min(axis=0), self.points.max(axis=0)

    def _values(self, color: str | npt.ArrayLike) -> npt.NDArray[Any]:
        if not isinstance(color, str):
            return np.asarray(color)
        if color == "angle":
            return self.quality().min_angles
        if color == "size":
            sizes: Floats = np.sqrt(self.quality().areas * (4 / np.sqrt(3)))
            return sizes
        if color == "area":
            return self.quality().areas
        if color == "region":
            return self.regions
        raise ValueError(f"color is {color!r}; there are {', '.join(_LABELS)}, None and arrays")


def _meets(corners: Floats, lower: Floats, upper: Floats) -> npt.NDArray[np.bool_]:
    """(m,): whether the box around each of the corners (m, k, 2) meets the box."""
    meets: npt.NDArray[np.bool_] = ((corners.max(axis=1) >= lower)
                                    & (corners.min(axis=1) <= upper)).all(axis=1)
    return meets


def _read_npz(npz: pathlib.Path, path: pathlib.Path) -> Mesh:
    from .results import summary_of  # which needs the protocol, as this module does not

    try:
        arrays, values, marker_names, region_names = _npz.read(npz)
    except ValueError as error:
        raise MeshFileError(f"{path}: {error}") from None
    return Mesh(**arrays, edge_segments=np.zeros(0, np.int32),
                input_points=np.zeros((0, 2), np.int32),
                summary=summary_of(arrays["points"], arrays["triangles"], len(arrays["edges"])),
                marker_names=marker_names, region_names=region_names, values=values)
