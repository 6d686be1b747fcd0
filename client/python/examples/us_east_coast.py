# SPDX-License-Identifier: Apache-2.0
"""The ocean off the US east coast, finer towards the shore: a mesh and its picture.

    python3 us_east_coast.py [PICTURE]     default: us_east_coast.png
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import weft

coast = pathlib.Path(__file__).parents[3] / "tests/models/us-east-coast.geojson"
new_york = (-74.0, 40.6)

with weft.local() as client:
    mesh = client.mesh(coast, lonlat=True, min_angle=30, edge="min(5000 + 0.15*shore, 50000)",  # metres
                       fields={"shore": weft.distance()})
print(mesh.quality())

figure, (all_of_it, close) = plt.subplots(1, 2, figsize=(11, 6), layout="constrained")
mesh.plot(ax=all_of_it, color="angle", linewidth=0.1)
mesh.plot(ax=close, linewidth=0.5)
close.set(xlim=(new_york[0] - 1, new_york[0] + 1.2), ylim=(new_york[1] - 0.9, new_york[1] + 0.9))
close.locator_params(nbins=5)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "us_east_coast.png", dpi=150)
