#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the completions of weft and weftd for bash, zsh and fish, from their --help.

    deploy/package/completions.py BUILD OUT

BUILD is the folder of weftd and weft. OUT gets bash/weft and bash/weftd, zsh/_weft and zsh/_weftd,
fish/weft.fish and fish/weftd.fish. They complete commands, flags, the words that a flag takes, and
files by the extensions that the help lists.
"""
import pathlib
import re
import sys

import program_help

LICENCE = "# SPDX-License-Identifier: Apache-2.0"


class Program:
    """A program, its own flags, and those of its commands."""

    def __init__(self, path):
        self.name = path.name
        self.own = program_help.parse(program_help.help_of(path))
        self.commands = {row.names[0]: (row.text, program_help.parse(
            program_help.help_of(path, row.names[0]))) for row in self.own.commands}


# bash: a function that knows for each command its flags, and for each flag what it takes. The word
# before decides; `=` is a word of its own there.

def bash_values(row):
    """The call that completes the value of a flag, or a positional."""
    if row.kind() == "choice":
        return f'_weft_words "{" ".join(row.choices())}"'
    if row.kind() == "file":
        return f'_weft_files "{"|".join(row.extensions())}"'
    return "_weft_files -" if row.kind() == "folder" else ":"


def bash_case(prefix, help_):
    """The branches of a `case` on COMMAND:PREVIOUS-WORD, then the one on any other word of it."""
    lines = []
    for row in help_.all_flags():
        if row.kind() != "nothing":
            pattern = " | ".join(f'"{prefix}:{name}"' for name in row.names)
            lines.append(f"    {pattern}) {bash_values(row)} ;;")
    flags = " ".join(name for row in help_.all_flags() for name in row.names if name != "-h")
    positional = bash_values(help_.positionals[0]) if help_.positionals else ":"
    lines += [f'    "{prefix}":*)', f'      _weft_flags "{flags}" || {positional}', "      ;;"]
    return lines


BASH = r"""_weft_words() { mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current"); }
# Succeeds if the word is a flag.
_weft_flags() {
  [[ $current == -* ]] && _weft_words "$1"
}
# Files with one of the extensions, as "poly|csv", and folders; "": all files; "-": folders alone.
_weft_files() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(
    shopt -s extglob
    case $1 in
      "") compgen -f -- "$current" ;;
      -) compgen -d -- "$current" ;;
      *) compgen -f -X "!*.@($1)" -- "$current"; compgen -d -- "$current" ;;
    esac
  )
}
"""


def bash(program):
    function = f"_{program.name}"
    lines = [LICENCE, f"# Completion of {program.name} for bash.", BASH.rstrip(),
             f"{function}() {{",
             "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}",
             "  local command=",
             "  COMPREPLY=()",
             "  # --flag=value is three words.",
             '  [[ $current != "=" ]] || current=',
             '  [[ $previous != "=" ]] || previous=${COMP_WORDS[COMP_CWORD - 2]}']
    if program.commands:
        lines += ["  ((COMP_CWORD == 1)) || command=${COMP_WORDS[1]}"]
    lines += ['  case "$command:$previous" in']
    for name, (_, help_) in program.commands.items():
        lines += bash_case(name, help_)
    own = bash_case("", program.own)
    if program.commands:
        own[-2] = own[-2].removesuffix(":") + f'_weft_words "{" ".join(program.commands)}"'
    lines += own + ["  esac", "}", f"complete -F {function} {program.name}"]
    return "\n".join(lines) + "\n"


# zsh: _arguments, with the text of each flag beside it.

def zsh_text(text):
    """In single quotes, in brackets."""
    return re.sub(r"([\[\]\\:])", r"\\\1", text).replace("'", "'\\''")


def zsh_action(row):
    if row.kind() == "choice":
        return f"({' '.join(row.choices())})"
    if row.kind() == "file":
        kinds = row.extensions()
        return f'_files -g "*.({"|".join(kinds)})"' if kinds else "_files"
    return "_files -/" if row.kind() == "folder" else " "


def zsh_arguments(help_):
    specs = []
    for row in help_.all_flags():
        exclusive = "*" if row.repeated else f"({' '.join(row.names)})"
        value = f":{zsh_text(row.value)}:{zsh_action(row)}" if row.value else ""
        for name in row.names:
            equals = "=" if row.value and name.startswith("--") else "+" if row.value else ""
            specs.append(f"'{exclusive}{name}{equals}[{zsh_text(row.text)}]{value}'")
    for row in help_.positionals:
        many = "*" if row.repeated else ""
        specs.append(f"'{many}:{row.names[0]}:{zsh_action(row)}'")
    return specs


def zsh(program):
    def arguments(specs, indent):
        joint = " \\\n" + indent + "  "
        return indent + "_arguments -s" + joint + joint.join(specs)

    lines = [f"#compdef {program.name}", LICENCE]
    if not program.commands:
        return "\n".join(lines + [arguments(zsh_arguments(program.own), "")]) + "\n"
    lines += ["local curcontext=$curcontext state line", "typeset -A opt_args",
              arguments(zsh_arguments(program.own) + ["'1: :->command'", "'*:: :->arguments'"], ""),
              "case $state in", "  command)", "    local -a commands=("]
    lines += [f"      '{name}:{zsh_text(text)}'" for name, (text, _) in program.commands.items()]
    lines += ["    )", "    _describe command commands", "    ;;", "  arguments)",
              "    case $words[1] in"]
    for name, (_, help_) in program.commands.items():
        lines += [f"      {name})", arguments(zsh_arguments(help_), "        "), "        ;;"]
    return "\n".join(lines + ["    esac", "    ;;", "esac"]) + "\n"


# fish: one line for each flag of each command.

def fish_quoted(text):
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def fish_values(row):
    """The options of `complete` for the value of a flag, or a positional."""
    if row.kind() == "choice":
        return f"-x -a {fish_quoted(' '.join(row.choices()))}"
    if row.kind() == "folder":
        return "-x -a '(__fish_complete_directories)'"
    if row.kind() == "file":
        each = "; ".join(f"__fish_complete_suffix .{kind}" for kind in row.extensions())
        return f"-x -k -a {fish_quoted(f'({each})')}" if each else "-r -F"
    return "-x" if row.value else "-f"


def fish(program):
    lines = [LICENCE, f"# Completion of {program.name} for fish.", f"complete -c {program.name} -f"]

    def add(condition, help_):
        where = f" -n {fish_quoted(condition)}" if condition else ""
        for row in help_.all_flags():
            names = " ".join(f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}"
                             for name in row.names)
            lines.append(f"complete -c {program.name}{where} {names} {fish_values(row)} "
                         f"-d {fish_quoted(row.text)}")
        for row in help_.positionals[:1]:
            lines.append(f"complete -c {program.name}{where} {fish_values(row)}")

    add("__fish_use_subcommand" if program.commands else "", program.own)
    for name, (text, help_) in program.commands.items():
        lines.append(f"complete -c {program.name} -n __fish_use_subcommand -f -a {name} "
                     f"-d {fish_quoted(text)}")
        add(f"__fish_seen_subcommand_from {name}", help_)
    return "\n".join(lines) + "\n"


def main():
    build, out = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    for name in ("weft", "weftd"):
        program = Program(build / name)
        for file, text in ((f"bash/{name}", bash(program)), (f"zsh/_{name}", zsh(program)),
                           (f"fish/{name}.fish", fish(program))):
            (out / file).parent.mkdir(parents=True, exist_ok=True)
            (out / file).write_text(text)


if __name__ == "__main__":
    main()
