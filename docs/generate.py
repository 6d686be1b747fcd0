#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/api.md from the comments of proto/, and docs/flags.md from the help of the programs.

    docs/generate.py BUILD [--check]

BUILD is the folder of weftd and weft, such as build/release. With --check nothing is written: the
exit code is 1 if a page is not what it would be.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

from google.protobuf import descriptor_pb2

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "deploy/package"))
import program_help

FILES = ["mesh_service.proto", "job_service.proto"]
Field = descriptor_pb2.FieldDescriptorProto


def descriptors():
    with tempfile.NamedTemporaryFile() as out:
        subprocess.run(
            ["protoc", f"--proto_path={ROOT / 'proto'}", "--include_source_info",
             f"--descriptor_set_out={out.name}"] + [f"weft/v1/{name}" for name in FILES],
            check=True)
        return descriptor_pb2.FileDescriptorSet.FromString(pathlib.Path(out.name).read_bytes())


def anchor(name):
    return name.lower()


class Page:
    """One .proto file as Markdown."""

    def __init__(self, file):
        self.comments = {tuple(l.path): l.leading_comments for l in file.source_code_info.location}
        self.lines = []
        for i, service in enumerate(file.service):
            self.service(service, (6, i))
        for i, message in enumerate(file.message_type):
            self.message(message, (4, i))
        for i, enum in enumerate(file.enum_type):
            self.enum(enum, (5, i))

    def comment(self, path):
        """The paragraphs of a comment, each on a line."""
        text = self.comments.get(path, "")
        paragraphs = re.split(r"\n\s*\n", "\n".join(l.strip() for l in text.splitlines()))
        return [" ".join(p.split()) for p in paragraphs if p.strip()]

    def cell(self, path):
        return "<br>".join(self.comment(path)).replace("|", "\\|")

    def add(self, *lines):
        self.lines += lines

    def service(self, service, path):
        self.add(f"## {service.name}", "", *sum(([p, ""] for p in self.comment(path)), []))
        for i, method in enumerate(service.method):
            stream = "stream of " if method.server_streaming else ""
            self.add(f"### {service.name}.{method.name}", "",
                     f"{self.type_link(method.input_type)} → "
                     f"{stream}{self.type_link(method.output_type)}", "",
                     *sum(([p, ""] for p in self.comment(path + (2, i))), []))

    def message(self, message, path):
        self.add(f"## {message.name}", "", *sum(([p, ""] for p in self.comment(path)), []))
        if not message.field:
            return
        self.add("| field | type | meaning |", "|---|---|---|")
        for i, field in enumerate(message.field):
            many = "repeated " if field.label == Field.LABEL_REPEATED else ""
            maybe = "optional " if field.proto3_optional else ""
            self.add(f"| `{field.name}` = {field.number} | {many}{maybe}{self.type_of(field)} | "
                     f"{self.cell(path + (2, i))} |")
        self.add("")

    def enum(self, enum, path):
        self.add(f"## {enum.name}", "", *sum(([p, ""] for p in self.comment(path)), []))
        self.add("| value | meaning |", "|---|---|")
        for i, value in enumerate(enum.value):
            self.add(f"| `{value.name}` = {value.number} | {self.cell(path + (2, i))} |")
        self.add("")

    def type_of(self, field):
        if field.type_name:
            return self.type_link(field.type_name)
        return Field.Type.Name(field.type)[len("TYPE_"):].lower()

    @staticmethod
    def type_link(name):
        short = name.rsplit(".", 1)[-1]
        if name.startswith(".weft.v1."):
            return f"[{short}](#{anchor(short)})"
        return name.lstrip(".")


API = """# The protocol, `weft.v1`

Made from the comments of [`proto/weft/v1`](../proto/weft/v1) by `docs/generate.py`.

[Clients in Node and Go](../client/examples/README.md) are worked out. From a shell, by reflection, which
servers answer to callers that they let in (grpcurl 1.8.8 or later):

```sh
grpcurl -plaintext 127.0.0.1:7421 list
grpcurl -plaintext 127.0.0.1:7421 weft.v1.MeshService/GetServerInfo
grpcurl -plaintext -d '{"domain": {"points": [0,0, 1,0, 1,1, 0,1], "segments": [0,1, 1,2, 2,3, 3,0]},
  "size": {"constant": 0.01}}' 127.0.0.1:7421 weft.v1.MeshService/GenerateMesh
grpcurl -cacert ca.pem -H "authorization: Bearer $(cat token)" mesh.example.org:7421 \\
  weft.v1.MeshService/GetServerInfo
```

Debian 12 has no grpcurl, so no test runs these lines; [the same with `buf
curl`](../client/examples/README.md#from-a-shell) is run by one.
"""


def api():
    lines = API.splitlines() + [""]
    for file in descriptors().file:
        lines += Page(file).lines
    return "\n".join(lines).rstrip() + "\n"


def variables(text):
    return set(re.findall(r"\(Env:(\w+)\)", text))


def flags(build):
    weft, weftd = build / "weft", build / "weftd"
    commands = [row.names[0] for row in program_help.commands_of(weft)]
    lines = ["# Flags", "", "Printed by the programs; made by `docs/generate.py`.", ""]
    of_server = program_help.help_of(weftd)
    for title, text in [("weftd", of_server)] + [
            (f"weft {command}", program_help.help_of(weft, command)) for command in commands]:
        lines += [f"## {title}", "", "```", text, "```", ""]
        if text is not of_server and (shared := variables(of_server) & variables(text)):
            sys.exit(f"weftd and {title} both read {', '.join(sorted(shared))}")
    return "\n".join(lines).rstrip() + "\n"


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    stale = []
    for name, text in [("api.md", api()), ("flags.md", flags(build))]:
        page = ROOT / "docs" / name
        if page.exists() and page.read_text() == text:
            continue
        stale.append(name)
        if "--check" not in sys.argv:
            page.write_text(text)
    if "--check" in sys.argv and stale:
        sys.exit(f"docs: stale, run docs/generate.py: {', '.join(stale)}")


if __name__ == "__main__":
    main()
