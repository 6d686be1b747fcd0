# SPDX-License-Identifier: Apache-2.0
"""Runs the examples of docs/solvers.md with FEniCSx, FreeFem++ and CalculiX, and FEniCSx on two processes, too; for
tests/deep.sh, which installs them.

    solve.py [PART]     PART: fenicsx, freefem or calculix; default: all of it
"""

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
    for command in ([*part, "fenicsx"], [*mpirun, *part, "fenicsx"], [*part, "freefem"], [*part, "calculix"]):
        subprocess.run(command, check=True)


if __name__ == "__main__":
    {"fenicsx": fenicsx, "freefem": freefem, "calculix": calculix, "": run_all}["".join(sys.argv[1:])]()
