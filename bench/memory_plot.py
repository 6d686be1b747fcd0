#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the table of `weft-bench stream --memory`, and prints how memory grows with the mesh.

    weft-bench stream --memory --triangles 1e6,1e7 | bench/memory_plot.py bench/memory.png
"""

import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def rows(lines):
    """Reader, triangles and megabytes of each row."""
    for line in lines:
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) == 8 and cells[1].isdigit():
            yield cells[0], int(cells[1]), float(cells[6])


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    of_reader = {}
    for reader, triangles, megabytes in rows(sys.stdin):
        of_reader.setdefault(reader, []).append((triangles, megabytes))
    figure, axes = plt.subplots(figsize=(6, 4), dpi=120, layout="constrained")
    for reader, points in of_reader.items():
        points.sort()
        axes.loglog(*zip(*points), marker="o", label=f"reader {reader}")
        large = [point for point in points if point[0] >= 5e6]
        if len(large) > 1:
            (n, a), (m, b) = large[0], large[-1]
            print(f"reader {reader}: from {n:,} to {m:,} triangles memory grows with the power "
                  f"{math.log(b / a) / math.log(m / n):.2f}")
    whole = sorted({triangles for points in of_reader.values() for triangles, _ in points})
    axes.loglog(whole, [36e-6 * n for n in whole], color="0.6", linestyle="--",
                label="36 bytes a triangle: a mesh that is held")
    axes.set_xlabel("triangles")
    axes.set_ylabel("most memory of the server, MB")
    axes.grid(True, which="major", color="0.9")
    axes.legend(frameon=False)
    figure.savefig(sys.argv[1])


if __name__ == "__main__":
    main()
