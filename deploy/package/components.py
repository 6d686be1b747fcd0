# SPDX-License-Identifier: Apache-2.0
"""What the programs of a build are made of: the shared libraries that they load, the headers and
archives that were compiled into them, and the Debian packages from which these came.

wheels.py carries the libraries and the licences, bill_of_materials.py lists the packages. If the build is one
for arm64 from another machine, they are those of its sysroot: `root` is that, or / otherwise.
"""
import dataclasses
import pathlib
import re
import subprocess


def output_of(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True,
                          text=True).stdout


def root_of(build):
    """Where the libraries are that a build was linked with."""
    cache = (build / "CMakeCache.txt").read_text()
    sysroot = re.search(r"^WEFT_SYSROOT:\w+=(.+)", cache, re.M)
    return pathlib.Path(sysroot[1] if sysroot else "/").resolve()


def linked_with(file, root):
    """The shared libraries that the loader brings along with a program or library: name to path."""
    loader = ["ldd"] if root == pathlib.Path("/") else [
        "qemu-aarch64-static", "-L", root, root / "lib/ld-linux-aarch64.so.1", "--list"]
    found = {}
    for line in output_of(*loader, file).splitlines():
        if words := re.match(r"\s*(\S+) => (\S+)", line):
            if words[2] == "not":
                raise FileNotFoundError(f"{file} needs {words[1]}, which is nowhere")
            found[words[1]] = root / words[2].removeprefix(str(root)).lstrip("/")
    return found


def known_to_the_loader(name, root):
    """The path of a shared library; None if there is none of the name."""
    if root != pathlib.Path("/"):
        paths = [root / folder / "aarch64-linux-gnu" / name for folder in ("lib", "usr/lib")]
        return next((path for path in paths if path.exists()), None)
    known = re.search(rf"^\s*{re.escape(name)} .* => (\S+)$", output_of("/sbin/ldconfig", "-p"), re.M)
    return pathlib.Path(known[1]) if known else None


def loaded_by(program):
    """The shared libraries that a program of a build loads, directly or not, at its start or when it
    needs them: name to path. Which it loads later the build has noted: loader/CMakeLists.txt. GDAL is
    not among these, because packages only suggest it."""
    root = root_of(program.parent)
    found = linked_with(program, root)
    noted = program.parent / "loaded_later" / program.name
    for name in noted.read_text().split() if noted.exists() else []:
        known = known_to_the_loader(name, root)
        if not known:
            raise FileNotFoundError(f"{program} loads {name}, which is nowhere")
        found |= {name: known} | linked_with(known, root)
    return found


def compiled_into(build, program):
    """The headers and archives outside of the tree that ninja made `program` of, in `build`. If that is of a
    sysroot, the compiler's own headers are still this machine's."""
    inputs = output_of("ninja", "-C", build, "-t", "inputs", program).splitlines()
    objects = [path for path in inputs if path.endswith(".o")]
    headers = re.findall("^    (.*)", output_of("ninja", "-C", build, "-t", "deps", *objects), re.M)
    if not headers:
        raise FileNotFoundError(f"{build}: ninja does not know what {program} was compiled from")
    archives = [path for path in inputs if path.endswith(".a")]
    paths = {(build / path).resolve() for path in headers + archives}
    return {path for path in paths if path.is_relative_to(root_of(build) / "usr") or path.is_relative_to("/usr")}


@dataclasses.dataclass(frozen=True, order=True)
class Package:
    """A package of Debian that is installed."""
    name: str
    version: str
    architecture: str
    source: str
    source_version: str
    homepage: str
    root: pathlib.Path

    @property
    def copyright(self):
        return self.root / "usr/share/doc" / self.name / "copyright"

    def common_licences(self):
        """The texts that its copyright file refers to, in Debian's folder of common licences."""
        text = self.copyright.read_text(errors="replace")
        names = re.findall(r"/usr/share/common-licenses/([\w.+-]*\w)", text)
        paths = {pathlib.Path("/usr/share/common-licenses", name) for name in names}
        return {path for path in paths if path.is_file()}


_FIELDS = ("Package", "Version", "Architecture", "source:Package", "source:Version", "Homepage")


def packages_of(files, root=pathlib.Path("/")):
    """The packages that installed the files, in `root` or, if they are not there, on this machine; raises
    LookupError if one came from no package."""
    elsewhere = {file for file in files if not pathlib.Path(file).is_relative_to(root)}
    if elsewhere:
        return packages_of(set(files) - elsewhere, root) | packages_of(elsewhere)
    # Packages name the folder that /lib is a link to, or the link.
    spellings = {}
    for file in files:
        real = "/" + str(pathlib.Path(file).resolve().relative_to(root))
        spellings[real] = real
        spellings[real.removeprefix("/usr")] = real
    query = ["dpkg-query", f"--admindir={root / 'var/lib/dpkg'}"]
    found = subprocess.run([*query, "--search", *spellings], capture_output=True, text=True,
                           env={"LC_ALL": "C", "PATH": "/usr/bin:/bin"}).stdout
    owners = {}
    for line in found.splitlines():
        packages, _, path = line.partition(": ")
        if path in spellings:
            owners[spellings[path]] = packages.split(", ")[0]
    if missing := set(spellings.values()) - set(owners):
        raise LookupError(f"of no package: {', '.join(sorted(missing))}")
    form = "".join("${%s}\t" % field for field in _FIELDS) + "\n"
    lines = output_of(*query, "--show", f"--showformat={form}", *sorted(set(owners.values()))).splitlines()
    return {Package(*line.split("\t")[:len(_FIELDS)], root) for line in lines}
