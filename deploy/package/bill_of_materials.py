#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the software bill of materials of a build, as CycloneDX 1.6 JSON:

    deploy/package/bill_of_materials.py BUILD OUT

BUILD is a folder in which weft and weftd were built. The bill lists, with what depends on it,
    Debian's packages of the libraries that the programs load, and of the headers and archives that
        were compiled into them, by dpkg's database of this machine, or of the sysroot if BUILD is for arm64;
    the packages that weft for Python requires;
    npm's packages of each lockfile in the tree; tools and examples, which nothing that is released
        contains, have the scope `excluded`.
Its time is SOURCE_DATE_EPOCH, if that is set. deploy/check-bill.mjs checks it against the schema.
"""
import base64
import datetime
import json
import os
import pathlib
import re
import sys
import time
import tomllib
import urllib.parse
import uuid

import components

ROOT = pathlib.Path(__file__).resolve().parents[2]
UNRELEASED = ("client/examples/",)  # folders whose packages are in nothing that is released


def licences_of(package):
    """The short names in its copyright file, if that can be read by machines (DEP 5)."""
    text = package.copyright.read_text(errors="replace")
    if not re.match(r"Format(-Specification)?:", text):
        return []
    names = {name.strip().rstrip(",") for line in re.findall(r"^License:[ \t]*(\S.*)", text, re.M)
             for name in re.split(r"\s+(?:and|or)\s+", line)}
    return [{"license": {"name": name}} for name in sorted(names - {""})]


def of_debian(package):
    version = urllib.parse.quote(package.version, safe="")
    purl = (f"pkg:deb/debian/{urllib.parse.quote(package.name, safe='')}@{version}"
            f"?arch={package.architecture}&distro=bookworm")
    component = {
        "type": "library", "bom-ref": purl, "name": package.name, "version": package.version,
        "purl": purl,
        "properties": [{"name": "debian:source", "value": f"{package.source} {package.source_version}"}]}
    if licences := licences_of(package):
        component["licenses"] = licences
    if package.homepage:
        component["externalReferences"] = [{"type": "website", "url": package.homepage}]
    return component


def of_python(requirement):
    name = re.match(r"[\w.-]+", requirement)[0]
    return {"type": "library", "bom-ref": f"pkg:pypi/{name}", "name": name, "purl": f"pkg:pypi/{name}",
            "properties": [{"name": "python:requirement", "value": requirement}]}


def of_npm(name, entry, released):
    version = entry["version"]
    purl = f"pkg:npm/{urllib.parse.quote(name, safe='/')}@{urllib.parse.quote(version, safe='')}"
    component = {"type": "library", "bom-ref": purl, "name": name, "version": version, "purl": purl,
                 "scope": "required" if released else "excluded"}
    if entry.get("integrity", "").startswith("sha512-"):
        digest = base64.b64decode(entry["integrity"].removeprefix("sha512-")).hex()
        component["hashes"] = [{"alg": "SHA-512", "content": digest}]
    if isinstance(entry.get("license"), str):
        component["licenses"] = [{"license": {"name": entry["license"]}}]
    return component


def npm_components():
    """By reference. A package that any lockfile has as released is released."""
    found = {}
    listed = components.output_of("git", "-C", ROOT, "ls-files", "--", "*package-lock.json")
    for lockfile in listed.splitlines():
        lock = json.loads((ROOT / lockfile).read_text())
        for path, entry in lock["packages"].items():
            if not path:
                continue
            released = not entry.get("dev") and not lockfile.startswith(UNRELEASED)
            component = of_npm(path.rpartition("node_modules/")[2], entry, released)
            if released or component["bom-ref"] not in found:
                found[component["bom-ref"]] = component
    return found


def linked(build, kind, name, file, version):
    """The component of a program or library, and those of the packages that it is made of."""
    parts = components.packages_of({*components.loaded_by(build / file).values(),
                                    *components.compiled_into(build, file)}, components.root_of(build))
    return {"type": kind, "bom-ref": name, "name": name, "version": version,
            "licenses": [{"license": {"id": "Apache-2.0"}}]}, [of_debian(part) for part in sorted(parts)]


def bill(build):
    cache = (build / "CMakeCache.txt").read_text()
    version = re.search(r"^CMAKE_PROJECT_VERSION:\w+=(.+)", cache, re.M)[1]
    all_components, dependencies = {}, {}

    def add(owner, parts):
        all_components[owner["bom-ref"]] = owner
        all_components.update({part["bom-ref"]: part for part in parts})
        dependencies[owner["bom-ref"]] = sorted(part["bom-ref"] for part in parts)

    for name in ("weft", "weftd"):
        add(*linked(build, "application", name, name, version))
    add(*linked(build, "library", "libweft0", "libweft.so.0", version))
    project = tomllib.loads((ROOT / "client/python/pyproject.toml").read_text())["project"]
    add({"type": "library", "bom-ref": "python3-weft", "name": project["name"], "version": version,
         "licenses": [{"license": {"id": "Apache-2.0"}}]}, list(map(of_python, project["dependencies"])))
    whole = ["libweft0", "python3-weft", "weft", "weftd"]
    npm = npm_components()
    all_components.update(npm)
    whole += [ref for ref, each in npm.items() if each["scope"] == "required"]
    now = int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))
    made = datetime.datetime.fromtimestamp(now, datetime.timezone.utc)
    contents = {
        "$schema": "http://cyclonedx.org/schema/bom-1.6.schema.json",
        "bomFormat": "CycloneDX", "specVersion": "1.6", "version": 1,
        "metadata": {
            "timestamp": made.strftime("%Y-%m-%dT%H:%M:%SZ"),
            "component": {"type": "application", "bom-ref": "release", "name": "weft",
                          "version": version, "licenses": [{"license": {"id": "Apache-2.0"}}]}},
        "components": [all_components[ref] for ref in sorted(all_components)],
        "dependencies": [{"ref": ref, "dependsOn": on} for ref, on in sorted(
            {**dependencies, "release": sorted(whole)}.items())]}
    # A name of its own for each content.
    name = uuid.uuid5(uuid.NAMESPACE_OID, json.dumps(contents, sort_keys=True))
    return {**contents, "serialNumber": f"urn:uuid:{name}"}


def main():
    build, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    out.write_text(json.dumps(bill(build), indent=1) + "\n")


if __name__ == "__main__":
    main()
