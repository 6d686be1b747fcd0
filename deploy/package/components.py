# SPDX-License-Identifier: Apache-2.0
"""What the programs of a build are made of: the shared libraries that they load, the headers and
archives that were compiled into them, and the Debian packages from which these came.

wheels.py carries the libraries and the licences, bill_of_materials.py lists the packages.
"""
import dataclasses
import pathlib
import re
import subprocess


def output_of(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True,
                          text=True).stdout


def linked_with(file):
    """The shared libraries that the loader brings along with a program or library: name to path."""
    found = {}
    for line in output_of("ldd", file).splitlines():
        if words := re.match(r"\s*(\S+) => (\S+)", line):
            if words[2] == "not":
                raise FileNotFoundError(f"{file} needs {words[1]}, which is nowhere")
            found[words[1]] = pathlib.Path(words[2])
    return found


def loaded_by(program):
    """The shared libraries that a program of a build loads, directly or not, at its start or when it
    needs them: name to path. Which it loads later the build has noted: loader/CMakeLists.txt. GDAL is
    not among these, because packages only suggest it."""
    found = linked_with(program)
    noted = program.parent / "loaded_later" / program.name
    for name in noted.read_text().split() if noted.exists() else []:
        known = re.search(rf"^\s*{re.escape(name)} .* => (\S+)$", output_of("/sbin/ldconfig", "-p"), re.M)
        if not known:
            raise FileNotFoundError(f"{program} loads {name}, which is nowhere")
        found |= {name: pathlib.Path(known[1])} | linked_with(known[1])
    return found


def compiled_into(build, program):
    """The headers and archives outside of the tree that ninja made `program` of, in `build`."""
    inputs = output_of("ninja", "-C", build, "-t", "inputs", program).splitlines()
    objects = [path for path in inputs if path.endswith(".o")]
    headers = re.findall("^    (.*)", output_of("ninja", "-C", build, "-t", "deps", *objects), re.M)
    if not headers:
        raise FileNotFoundError(f"{build}: ninja does not know what {program} was compiled from")
    archives = [path for path in inputs if path.endswith(".a")]
    return {pathlib.Path(path) for path in headers + archives if path.startswith("/usr/")}


@dataclasses.dataclass(frozen=True, order=True)
class Package:
    """A package of Debian that is installed."""
    name: str
    version: str
    architecture: str
    source: str
    source_version: str
    homepage: str

    @property
    def copyright(self):
        return pathlib.Path("/usr/share/doc", self.name, "copyright")

    def common_licences(self):
        """The texts that its copyright file refers to, in Debian's folder of common licences."""
        text = self.copyright.read_text(errors="replace")
        names = re.findall(r"/usr/share/common-licenses/([\w.+-]*\w)", text)
        paths = {pathlib.Path("/usr/share/common-licenses", name) for name in names}
        return {path for path in paths if path.is_file()}


_FIELDS = ("Package", "Version", "Architecture", "source:Package", "source:Version", "Homepage")


def packages_of(files):
    """The packages that installed the files; raises LookupError if one came from no package."""
    # Packages name the folder that /lib is a link to, or the link.
    spellings = {}
    for file in files:
        real = str(pathlib.Path(file).resolve())
        spellings[real] = real
        spellings[real.removeprefix("/usr")] = real
    found = subprocess.run(["dpkg-query", "--search", *spellings], capture_output=True, text=True,
                           env={"LC_ALL": "C", "PATH": "/usr/bin:/bin"}).stdout
    owners = {}
    for line in found.splitlines():
        packages, _, path = line.partition(": ")
        if path in spellings:
            owners[spellings[path]] = packages.split(", ")[0]
    if missing := set(spellings.values()) - set(owners):
        raise LookupError(f"of no package: {', '.join(sorted(missing))}")
    form = "".join("${%s}\t" % field for field in _FIELDS) + "\n"
    lines = output_of("dpkg-query", "--show", f"--showformat={form}",
                      *sorted(set(owners.values()))).splitlines()
    return {Package(*line.split("\t")[:len(_FIELDS)]) for line in lines}
