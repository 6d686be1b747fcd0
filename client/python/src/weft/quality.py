# SPDX-License-Identifier: Apache-2.0
"""How good triangles are."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from ._short import ShortRepr

Floats = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Quality(ShortRepr):
    """A figure per triangle; `str` sums them up.

        quality = mesh.quality()
        worst = quality.min_angles.argmin()
    """

    areas: Floats
    """(m,) float64, squared units of the domain; positive, for triangles are counter-clockwise."""
    min_angles: Floats
    """(m,) float64: the smallest angle of each triangle, in degrees."""
    max_angles: Floats
    """(m,) float64: the largest angle of each triangle, in degrees."""
    aspects: Floats
    """(m,) float64: longest edge / (2 sqrt(3) inradius); 1 for equilateral."""

    @property
    def min_angle(self) -> float:
        """The smallest angle of all, in degrees; NaN if there are no triangles."""
        return float(self.min_angles.min()) if len(self.min_angles) else float("nan")

    @property
    def max_angle(self) -> float:
        """The largest angle of all, in degrees; NaN if there are no triangles."""
        return float(self.max_angles.max()) if len(self.max_angles) else float("nan")

    @property
    def area(self) -> float:
        """The sum of the areas."""
        return float(self.areas.sum())

    def __str__(self) -> str:
        return (f"{len(self.areas):,} triangles, angles {self.min_angle:.2f} to "
                f"{self.max_angle:.2f} degrees, area {self.area:.6g}")


def quality_of(points: Floats, triangles: npt.NDArray[np.int32]) -> Quality:
    """Of counter-clockwise triangles (m, 3) over points (n, 2)."""
    corners = points[triangles]
    edges = np.roll(corners, -1, axis=1) - corners  # from each corner to the next
    back = -np.roll(edges, 1, axis=1)  # and to the one before
    doubled = edges[..., 0] * back[..., 1] - edges[..., 1] * back[..., 0]
    angles = np.degrees(np.arctan2(doubled, (edges * back).sum(axis=2)))
    lengths = np.hypot(edges[..., 0], edges[..., 1])
    areas = doubled[:, 0] / 2
    with np.errstate(divide="ignore", invalid="ignore"):  # of area 0: infinite
        # inradius = 2 area / perimeter
        aspects = lengths.max(axis=1) * lengths.sum(axis=1) / (4 * np.sqrt(3) * areas)
    return Quality(areas, angles.min(axis=1), angles.max(axis=1), aspects)
