# SPDX-License-Identifier: Apache-2.0
"""Floor plans as drawing programs give them: rooms with walls of their own, so that points and segments are
there twice; doors, whose ends are in the middles of walls; a building at any angle, its coordinates rounded to
centimetres, so that doors end beside their walls."""

import random

import numpy as np


def floor_plan(seed):
    """A dict for weft.triangulate, in metres. Walls have the marker 1, doors 2."""
    chance = random.Random(seed)
    points, segments, markers, regions = [], [], [], []

    def add(marker, *places):
        first = len(points)
        points.extend(places)
        ends = [(first + i, first + i + 1) for i in range(len(places) - 1)]
        segments.extend(ends)
        markers.extend([marker] * len(ends))

    def divide(left, low, right, high, depth):
        width, height = right - left, high - low
        if depth == 0 or max(width, height) < 4:
            room(left, low, right, high)
        elif width > height:
            wall = left + width * chance.uniform(0.3, 0.7)
            divide(left, low, wall, high, depth - 1)
            divide(wall, low, right, high, depth - 1)
        else:
            wall = low + height * chance.uniform(0.3, 0.7)
            divide(left, low, right, wall, depth - 1)
            divide(left, wall, right, high, depth - 1)

    def room(left, low, right, high):
        add(1, (left, low), (right, low), (right, high), (left, high), (left, low))
        leaf = min(0.9, 0.4 * (right - left))
        hinge = left + chance.uniform(0.1, 0.9) * (right - left - leaf)
        if chance.random() < 0.5:  # a door, open
            add(2, (hinge, low), (hinge, low + min(leaf, 0.8 * (high - low))))
        else:  # a partition from wall to wall
            add(2, (hinge, low), (hinge, high))
        regions.append((left + 0.95 * (right - left), low + 0.05 * (high - low), float(len(regions) % 7), 0.5))

    divide(0, 0, chance.uniform(8, 30), chance.uniform(6, 20), chance.randint(1, 4))
    angle = chance.choice([0, 0, 30, chance.uniform(0, 90)]) * np.pi / 180
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    seeds = np.array(regions)
    seeds[:, :2] = seeds[:, :2] @ turn
    return {"vertices": np.round(np.array(points) @ turn, 2), "segments": np.array(segments),
            "segment_markers": np.array(markers), "regions": seeds}


def write_poly(path, given):
    """By Triangle's documentation of the format."""
    points, segments = given["vertices"], given["segments"]
    markers = np.ravel(given.get("segment_markers", np.zeros(len(segments), int)))
    holes, regions = given.get("holes", ()), given.get("regions", ())
    tables = [(f"{len(points)} 2 0 0", np.array(points, float).tolist()),
              (f"{len(segments)} 1", [(*ends, marker) for ends, marker in zip(segments, markers)]),
              (len(holes), holes), (len(regions), [(x, y, int(a), area) for x, y, a, area in regions])]
    lines = [line for header, rows in tables
             for line in (header, *(" ".join(map(str, (i, *row))) for i, row in enumerate(rows)))]
    path.write_text("\n".join(map(str, lines)) + "\n")
