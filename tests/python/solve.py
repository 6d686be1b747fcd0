# SPDX-License-Identifier: Apache-2.0
"""Runs the examples of docs/solvers.md with FEniCSx, FreeFem++ and CalculiX, and FEniCSx on two processes, too, and
problems with known answers on periodic sides and on layers with FreeFem++; for tests/deep.sh, which installs them.

    solve.py [PART]     PART: fenicsx, freefem, cells, flow or calculix; default: all of it
"""

import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import warnings

PAGE = (pathlib.Path(__file__).parents[2] / "docs/solvers.md").read_text()


def block(heading, language):
    """The first block of the language under the heading; of the page if it is empty."""
    part = PAGE[PAGE.index(f"\n## {heading}\n"):] if heading else PAGE
    return re.search(rf"```{language}\n(.*?)```", part, re.S)[1]


def channel():
    names = {}
    exec(block("", "python"), names)
    return names["mesh"]


def check(ok, what):
    print(("holds: " if ok else "FAILS: ") + what)
    if not ok:
        sys.exit(1)


def two_rooms():
    """Squares side by side, regions 4 and 9, with marker 5 between them; 2 is above and below the left one
    and to its left, 3 above and below the right one, -7 to its right."""
    import weft

    two = weft.Domain([(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)],
                      [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)], markers=[2, 3, -7, 3, 2, 2, 5],
                      regions=[weft.Region(0.5, 0.5, id=4), weft.Region(1.5, 0.5, id=9)])
    with weft.local() as client:
        return client.mesh(two, edge=0.1)


# The moments of regions 4 and 9 about x = 0, the lengths of markers 2, 3, -7 and 5.
ROOMS = """
mesh Th = readmesh("rooms.mesh");
cout << int2d(Th, 4)(x) << " " << int2d(Th, 9)(x) << " " << int1d(Th, 2)(1.) << " " << int1d(Th, 3)(1.) << " "
     << int1d(Th, -7)(1.) << " " << int1d(Th, 5)(1.) << endl;
"""


def fenicsx():
    import numpy as np
    import ufl
    import weft
    from dolfinx import fem

    mesh = channel()
    names = {"mesh": mesh}
    exec(block("FEniCSx", "python"), names)
    domain, markers, solution = (names[key] for key in ("domain", "markers", "solution"))
    x = ufl.SpatialCoordinate(domain)

    def total(form):
        return domain.comm.allreduce(fem.assemble_scalar(fem.form(form)))

    error = np.sqrt(total((solution - 1 + x[0] / 2)**2 * ufl.dx))
    check(error < 1e-4, f"FEniCSx on {domain.comm.size}: u is 1 - x/2, off by {error:.1e}")
    one = fem.Constant(domain, 1.0)
    ds = ufl.Measure("ds", domain=domain, subdomain_data=markers)
    for name, length in (("inlet", 1), ("wall", 4), ("outlet", 1)):
        found = total(one * ds(mesh.boundaries.number(name)))
        check(abs(found - length) < 1e-12, f"the {name} is {found:g} long")
    domain, regions, _ = two_rooms().to_dolfinx()
    dx = ufl.Measure("dx", domain=domain, subdomain_data=regions)
    for region, moment in ((4, 0.5), (9, 1.5)):
        found = total(ufl.SpatialCoordinate(domain)[0] * dx(region))
        check(abs(found - moment) < 1e-12, f"the region {region} has the moment {found:g}")


def freefem():
    with tempfile.TemporaryDirectory() as folder:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the names, which Medit's files do not have
            two_rooms().write(pathlib.Path(folder) / "rooms.mesh")
            channel().write(pathlib.Path(folder) / "channel.mesh")
        (pathlib.Path(folder) / "laplace.edp").write_text(block("FreeFem++", "freefem"))
        said = subprocess.run(["FreeFem++-nw", "-v", "0", "laplace.edp"], cwd=folder, capture_output=True,
                              text=True, check=True).stdout
        (pathlib.Path(folder) / "rooms.edp").write_text(ROOMS)
        rooms = subprocess.run(["FreeFem++-nw", "-v", "0", "rooms.edp"], cwd=folder, capture_output=True,
                               text=True, check=True).stdout
    found = [round(float(word), 9) for word in rooms.split()[-6:]]
    check(found == [0.5, 1.5, 3, 2, 1, 1], f"FreeFem++: moments of regions 4 and 9, lengths of markers: {found}")
    error, walls = map(float, re.search(r"error (\S+) walls (\S+)", said).groups())
    check(error < 1e-6, f"FreeFem++: u is 1 - x/2, off by {error:.1e}")
    check(abs(walls - 4) < 1e-5, f"the walls are {walls:g} long")


def solved(mesh, program):
    """What a program prints that reads mesh.mesh."""
    with tempfile.TemporaryDirectory() as folder:
        mesh.write(pathlib.Path(folder) / "mesh.mesh")
        (pathlib.Path(folder) / "program.edp").write_text(program)
        return subprocess.run(["FreeFem++-nw", "-v", "0", "program.edp"], cwd=folder, capture_output=True, text=True,
                              check=True).stdout


# Eigenvalues of Laplace's operator on a torus: 4 pi^2 (m^2 + n^2).
TORUS = """
mesh Th = readmesh("mesh.mesh");
fespace Vh(Th, P2, periodic=[[4, y], [2, y], [1, x], [3, x]]);
varf shifted(u, v) = int2d(Th)(dx(u)*dx(v) + dy(u)*dy(v) - 20*u*v);
varf mass(u, v) = int2d(Th)(u*v);
matrix A = shifted(Vh, Vh, solver=sparsesolver), B = mass(Vh, Vh, solver=CG, eps=1e-20);
real[int] values(9);
Vh[int] vectors(9);
EigenValue(A, B, sym=true, sigma=20, value=values, vector=vectors, tol=1e-10);
for (int i = 0; i < 9; ++i) cout << values[i] << " ";
"""

# The conductivity of a square array of disks that conduct perfectly; u is x + w, and 0.5 on the disk.
DISKS = """
mesh Th = readmesh("mesh.mesh");
fespace Vh(Th, P2, periodic=[[4, y], [2, y], [1, x], [3, x]]);
Vh w, v;
solve laplace(w, v) = int2d(Th)(dx(w)*dx(v) + dy(w)*dy(v)) + int2d(Th)(dx(v)) + on(5, w=0.5 - x);
cout << int2d(Th)((1 + dx(w))^2 + dy(w)^2);
"""

# Flow around a cylinder, the case 2D-1 of M. Schaefer and S. Turek, "Benchmark computations of laminar flow around a
# cylinder", 1996: drag and lift by the residual of the momentum.
CYLINDER = """
mesh Th = readmesh("mesh.mesh");
fespace Xh(Th, P2);
fespace Mh(Th, P1);
Xh u, v, du, dv, s, t, near;
Mh p, dp, q;
real nu = 1e-3;
func inflow = 1.2*y*(0.41 - y)/0.41^2;
solve stokes([u, v, p], [s, t, q], solver=sparsesolver) =
  int2d(Th)(nu*(dx(u)*dx(s) + dy(u)*dy(s) + dx(v)*dx(t) + dy(v)*dy(t)) - p*(dx(s) + dy(t)) - q*(dx(u) + dy(v)))
  + on(1, 5, u=0, v=0) + on(4, u=inflow, v=0);
for (int i = 0; i < 7; ++i) {
  solve newton([du, dv, dp], [s, t, q], solver=sparsesolver) =
    int2d(Th)(nu*(dx(du)*dx(s) + dy(du)*dy(s) + dx(dv)*dx(t) + dy(dv)*dy(t))
      + (du*dx(u) + dv*dy(u) + u*dx(du) + v*dy(du))*s + (du*dx(v) + dv*dy(v) + u*dx(dv) + v*dy(dv))*t
      - dp*(dx(s) + dy(t)) - q*(dx(du) + dy(dv)))
    - int2d(Th)((u*dx(u) + v*dy(u))*s + (u*dx(v) + v*dy(v))*t) + on(1, 5, du=0, dv=0) + on(4, du=inflow, dv=0);
  u = du; v = dv; p = dp;
}
solve extension(near, s) = int2d(Th)(near*s) + on(5, near=1) + on(1, 2, 4, near=0);
cout.precision(10);
cout << -500*int2d(Th)(nu*(dx(u)*dx(near) + dy(u)*dy(near)) + (u*dx(u) + v*dy(u))*near - p*dx(near)) << " "
     << -500*int2d(Th)(nu*(dx(v)*dx(near) + dy(v)*dy(near)) + (u*dx(v) + v*dy(v))*near - p*dy(near));
"""


def with_disk(corners, markers, x, y, area, sides):
    """A quadrilateral with a hole, a regular polygon of the area, marker 5."""
    import weft

    radius = math.sqrt(area / (0.5 * sides * math.sin(2 * math.pi / sides)))
    disk = [(x + radius * math.cos(2 * math.pi * k / sides), y + radius * math.sin(2 * math.pi * k / sides))
            for k in range(sides)]
    edges = [(k, (k + 1) % 4) for k in range(4)] + [(4 + k, 4 + (k + 1) % sides) for k in range(sides)]
    return weft.Domain(corners + disk, edges, markers + [5] * sides, holes=[(x, y)])


def cells():
    import weft

    corners, sides = [(0, 0), (1, 0), (1, 1), (0, 1)], [(4, 2), (1, 3)]
    square = weft.Domain(corners, [(0, 1), (1, 2), (2, 3), (3, 0)], [1, 2, 3, 4])
    with weft.local() as client:
        found = list(map(float, solved(client.mesh(square, edge=0.08, periodic=sides), TORUS).split()))
        disks = client.mesh(with_disk(corners, [1, 2, 3, 4], 0.5, 0.5, 0.5, 360), edge=0.03, periodic=sides)
    expected = [4 * math.pi**2 * n for n in (0, 1, 1, 1, 1, 2, 2, 2, 2)]
    check(all(abs(f - e) < 3e-4 * max(e, 1) for f, e in zip(found, expected)),
          "FreeFem++: eigenvalues of the torus " + ", ".join(f"{value:.3f}" for value in found))
    conductivity = float(solved(disks, DISKS))
    check(abs(conductivity / 3.080 - 1) < 1e-3, f"FreeFem++: disks on half of the plane conduct {conductivity:.4f}")


def flow():
    import weft

    channel = with_disk([(0, 0), (2.2, 0), (2.2, 0.41), (0, 0.41)], [1, 2, 1, 4], 0.2, 0.2, math.pi * 0.05**2, 64)
    with weft.local() as client:
        mesh = client.mesh(channel, edge="min(0.05, 0.006 + 0.15*(hypot(x - 0.2, y - 0.2) - 0.05))", min_angle=25,
                           layers={5: weft.Layers(first=0.002, ratio=1.3, rows=5)})
    drag, lift = map(float, solved(mesh, CYLINDER).split())
    check(abs(drag / 5.57953523384 - 1) < 1e-4 and abs(lift / 0.010618948146 - 1) < 0.02,
          f"FreeFem++: the cylinder with {mesh.summary.layers.triangles} of {mesh.summary.triangles} triangles in layers"
          f" has a drag of {drag:.5f} and a lift of {lift:.6f}; 5.57954 and 0.010619 are known")


def highest_pull(frd):
    """Of a file of CalculiX, the node with the highest stress in x: that stress and the node's coordinates."""
    section, places, stresses = "", {}, {}
    for line in frd.read_text().splitlines():
        if line.startswith((" -4", "    2C")):
            section = line[5:13].strip() if line.startswith(" -4") else "nodes"
        elif line.startswith(" -1") and section in ("nodes", "STRESS"):
            numbers = [float(line[at:at + 12]) for at in range(13, len(line), 12)]
            (places if section == "nodes" else stresses)[int(line[3:13])] = numbers
        elif line.startswith(" -3"):
            section = ""
    node = max(stresses, key=lambda number: stresses[number][0])
    return stresses[node][0], places[node]


def calculix():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["bash", "-ec", block("CalculiX", "sh") + "ccx pull > log"], cwd=folder, check=True)
        stress, (x, y, _) = highest_pull(pathlib.Path(folder) / "pull.frd")
    wide = 1 - 0.1  # the width beside the hole
    expected = 0.284 + 2/wide - 0.6*wide + 1.32*wide**2
    check(abs(stress/expected - 1) < 0.005 and abs(x) < 0.05 and y > 0.99,
          f"CalculiX: the stress at ({x:g}, {y:g}) is {stress:.3f} times the pull, and {expected:.3f} is expected")


def run_all():
    """Each in a process of its own: mpirun does not start from one that has MPI."""
    part = [sys.executable, "-B", __file__]
    mpirun = ["mpirun", *(["--allow-run-as-root"] if os.geteuid() == 0 else []), "--oversubscribe", "-n", "2"]
    for command in ([*part, "fenicsx"], [*mpirun, *part, "fenicsx"], [*part, "freefem"], [*part, "cells"],
                    [*part, "flow"], [*part, "calculix"]):
        subprocess.run(command, check=True)


if __name__ == "__main__":
    {"fenicsx": fenicsx, "freefem": freefem, "cells": cells, "flow": flow, "calculix": calculix,
     "": run_all}["".join(sys.argv[1:])]()
