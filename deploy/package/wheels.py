#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the packages of weft for Python:

    deploy/package/wheels.py BUILD OUT

BUILD is a folder in which weft, weftd and libweft.so were built, by the preset `portable`, or
`portable-arm64`. OUT gets
    weftmesh-VERSION.tar.gz                                  the sources
    weftmesh-VERSION-py3-none-any.whl                        the package, which needs a server
    weftmesh-VERSION-py3-none-manylinux_2_36_MACHINE.whl     with weft, weftd and libweft.so, and what they load

The last one has no projections and no rasters but .asc: PROJ loads a library under the GPL (libjbig),
GDAL hundreds of megabytes. MACHINE is x86_64 or aarch64; the wheel runs on every Linux there with glibc
2.36: every file in it is checked against what manylinux_2_36 (PEP 600) lets a wheel expect of a system, as
the policy of auditwheel lists it. It expects less than that allows: glibc and the libraries of GCC, because small systems have no others.
With SOURCE_DATE_EPOCH the same build gives the same files, byte for byte.

Needs Debian's python3-pip, python3-setuptools, python3-wheel, protobuf-compiler and patchelf; for arm64 on
another machine what `deploy/install-deps.sh arm64` installs.
"""
import gzip
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile

import components
from components import output_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What the wheel does not carry, and the newest version of each kind of symbol in it.
OF_THE_SYSTEM = {"ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1", "libanl.so.1", "libc.so.6",
                 "libdl.so.2", "libgcc_s.so.1", "libm.so.6", "libmvec.so.1", "libpthread.so.0",
                 "libresolv.so.2", "librt.so.1", "libstdc++.so.6", "libutil.so.1"}
UNDER_THE_GPL = {"libjbig.so.0", "libreadline.so.8"}  # without an exception for what links them
NEWEST = {"CXXABI": (1, 3, 13), "GCC": (12, 0, 0), "GLIBC": (2, 36), "GLIBCXX": (3, 4, 30)}
LIBRARY = "libweft.so.0"
SCRIPTS = """[console_scripts]
weft = weft.__main__:main
weftd = weft.__main__:server
triangle-weft = weft.triangle:main
"""


def python(*words, cwd):
    done = subprocess.run([sys.executable, *map(str, words)], cwd=cwd, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"wheels.py: {' '.join(map(str, words))}:\n{done.stdout}{done.stderr}")


def only(folder, pattern):
    found, = folder.glob(pattern)
    return found


def set_times(archive):
    """Packs a .tar.gz again, with SOURCE_DATE_EPOCH as its time and as that of all that is in it."""
    epoch = int(os.environ["SOURCE_DATE_EPOCH"])
    with tarfile.open(archive) as tar:
        members = [(member, tar.extractfile(member)) for member in sorted(tar, key=lambda each: each.name)]
        packed = io.BytesIO()
        with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as again:
            for member, contents in members:
                member.mtime, member.uid, member.gid, member.uname, member.gname = epoch, 0, 0, "", ""
                member.pax_headers = {}
                again.addfile(member, contents)
    archive.write_bytes(gzip.compress(packed.getvalue(), mtime=epoch))


def build_pure(scratch, out):
    """The sources and the wheel without programs, from a copy: building leaves files behind."""
    clone = scratch / "clone"
    listed = output_of("git", "-C", ROOT, "ls-files", "--cached", "--others", "--exclude-standard",
                       "--", "proto", "client/python", "CMakeLists.txt", "LICENSE", "NOTICE")
    for name in listed.splitlines():
        (clone / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, clone / name)
    source = clone / "client/python"
    python("setup.py", "-q", "sdist", "-d", out, cwd=source)
    if "SOURCE_DATE_EPOCH" in os.environ:  # setuptools heeds it in wheels alone
        set_times(only(out, "*.tar.gz"))
    python("-m", "pip", "wheel", "--quiet", "--no-deps", "--no-index", "--no-build-isolation", "-w",
           out, source, cwd=scratch)
    return only(out, "*-py3-none-any.whl")


def is_expected(symbol):
    """Whether the system may be expected to have a version of symbols, such as GLIBC_2.34."""
    kind, _, version = symbol.partition("_")
    numbers = re.fullmatch(r"\d+(\.\d+)*", version)
    return kind in NEWEST and bool(numbers) and tuple(map(int, version.split("."))) <= NEWEST[kind]


def binutils(build):
    """What goes before the names of the tools for the programs of a build."""
    return "" if components.root_of(build) == pathlib.Path("/") else "aarch64-linux-gnu-"


def faults(folder, tools=""):
    """What of the programs and libraries in a folder, in bin/ and lib/, a wheel may not have."""
    carried = {path.name for path in (folder / "lib").iterdir()}
    for name in sorted(carried & UNDER_THE_GPL):
        yield f"{name} is under the GPL"
    for path in sorted([*(folder / "bin").iterdir(), *(folder / "lib").iterdir()]):
        headers = output_of(f"{tools}objdump", "-p", path)
        for name in re.findall(r"^  NEEDED +(\S+)", headers, re.M):
            if name not in carried | OF_THE_SYSTEM:
                yield f"{path.name} needs {name}, which the system need not have"
        for library, versions in re.findall(r"required from (\S+):\n((?:    0x.*\n)*)", headers):
            for symbol in re.findall(r" (\S+)$", versions, re.M):
                if library in OF_THE_SYSTEM and not is_expected(symbol):
                    yield f"{path.name} needs {symbol} of {library}"
        rpath = re.findall(r"^  RPATH +(\S+)", headers, re.M)
        if rpath != ["$ORIGIN/../lib" if path.parent.name == "bin" else "$ORIGIN"]:
            yield f"{path.name} looks for libraries in {rpath}"


def carry(build, folder):
    """Puts the programs into folder/bin, the library and what they load into folder/lib. Returns what
    was copied of the system."""
    for name in ("bin", "lib"):
        (folder / name).mkdir(parents=True)
    copied = {}
    for program in ("weft", "weftd"):
        shutil.copy(build / program, folder / "bin" / program)
        copied |= {name: path for name, path in components.loaded_by(build / program).items()
                   if name not in OF_THE_SYSTEM}
    library = build / LIBRARY
    copied |= {name: path for name, path in components.loaded_by(library).items()
               if name not in OF_THE_SYSTEM}
    for name, path in copied.items():
        shutil.copy(path, folder / "lib" / name)
    shutil.copy(library, folder / "lib" / LIBRARY)
    for path in [*(folder / "bin").iterdir(), *(folder / "lib").iterdir()]:
        path.chmod(0o755)
        subprocess.run([f"{binutils(build)}strip", "--strip-unneeded", path], check=True)
        # RPATH, not RUNPATH: it holds for what the libraries load, too, and goes before
        # LD_LIBRARY_PATH, which belongs to programs of the user.
        rpath = "$ORIGIN/../lib" if path.parent.name == "bin" else "$ORIGIN"
        subprocess.run(["patchelf", "--force-rpath", "--set-rpath", rpath, path], check=True)
    return set(copied.values())


def add_licences(folder, files, root):
    """The copyright file of each package that a file came from, and the texts that it refers to."""
    shutil.copytree(ROOT / "LICENSES", folder / "weft")
    (folder / "common-licenses").mkdir()
    for package in components.packages_of(files, root):
        (folder / package.name).mkdir()
        shutil.copy(package.copyright, folder / package.name)
        for text in package.common_licences():
            shutil.copy(text, folder / "common-licenses")


def build_platform(pure, build, scratch, out):
    """The wheel with programs, from that without."""
    python("-m", "wheel", "unpack", pure, "-d", scratch, cwd=scratch)
    wheel = only(scratch, "weftmesh-*")
    carried = wheel / "weft/carried"
    files = carry(build, carried)
    platform = f"manylinux_2_36_{'aarch64' if binutils(build) else os.uname().machine}"
    if found := list(faults(carried, binutils(build))):
        sys.exit("wheels.py: not " + platform + ":\n  " + "\n  ".join(found))
    for program in ("weft", "weftd"):
        files |= components.compiled_into(build, program)
    meta = only(wheel, "*.dist-info")
    add_licences(meta / "licenses", files, components.root_of(build))
    (meta / "entry_points.txt").write_text(SCRIPTS)
    tags = (meta / "WHEEL").read_text().replace("Root-Is-Purelib: true", "Root-Is-Purelib: false")
    (meta / "WHEEL").write_text(tags.replace("Tag: py3-none-any", f"Tag: py3-none-{platform}"))
    python("-m", "wheel", "pack", wheel, "-d", out, cwd=scratch)


def main():
    build, out = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    out.mkdir(parents=True, exist_ok=True)
    os.umask(0o022)
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        pure = build_pure(scratch, out)
        (scratch / "wheel").mkdir()
        build_platform(pure, build, scratch / "wheel", out)


if __name__ == "__main__":
    main()
