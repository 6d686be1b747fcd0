#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a program under a seccomp profile in the format of OCI and Docker.

    seccomp_profile.py PROFILE PROGRAM [ARGUMENT...]

Docker and Kubernetes load the same file through the same library, libseccomp. no_new_privs is set, so
that needs no right. Exits with CANNOT_LOAD if the kernel takes no filter.
"""
import json
import os
import sys

import seccomp

CANNOT_LOAD = 125

ARCHITECTURES = {"SCMP_ARCH_X86_64": seccomp.Arch.X86_64, "SCMP_ARCH_AARCH64": seccomp.Arch.AARCH64}
COMPARISONS = {"SCMP_CMP_EQ": seccomp.EQ, "SCMP_CMP_MASKED_EQ": seccomp.MASKED_EQ}


def action_of(name: str, error: int) -> int:
    return {"SCMP_ACT_ALLOW": seccomp.ALLOW, "SCMP_ACT_ERRNO": seccomp.ERRNO(error)}[name]


def condition_of(argument: dict) -> seccomp.Arg:
    return seccomp.Arg(argument["index"], COMPARISONS[argument["op"]], argument["value"],
                       argument.get("valueTwo", 0))


def load(path: str) -> None:
    """Puts this process, and what it starts, under the profile. Raises RuntimeError or OSError."""
    with open(path) as file:
        profile = json.load(file)
    filter_ = seccomp.SyscallFilter(
        action_of(profile["defaultAction"], profile["defaultErrnoRet"]))
    for name in profile["architectures"]:
        if not filter_.exist_arch(ARCHITECTURES[name]):
            filter_.add_arch(ARCHITECTURES[name])
    for rule in profile["syscalls"]:
        action = action_of(rule["action"], rule.get("errnoRet", profile["defaultErrnoRet"]))
        conditions = [condition_of(argument) for argument in rule.get("args", [])]
        for name in rule["names"]:
            filter_.add_rule(action, name, *conditions)
    filter_.load()


def main() -> None:
    profile, *command = sys.argv[1:]
    try:
        load(profile)
    except (RuntimeError, OSError) as error:
        print(f"no filter can be loaded: {error}", file=sys.stderr)
        sys.exit(CANNOT_LOAD)
    os.execv(command[0], command)


if __name__ == "__main__":
    main()
