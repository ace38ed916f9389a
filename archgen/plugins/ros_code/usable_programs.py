"""Which programs can be generated at all: their packages and executables are names of folders, files and modules."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from archgen.plugin.findings import Diagnostic, Label
from archgen.plugin.generating import NOT_GENERATED, make_identifier_in
from archgen.plugin.model import Node

_PACKAGE = re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z", re.ASCII)
_EXECUTABLE = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]*\Z", re.ASCII)
_MAX_NAME = 100
_LANGUAGES = {"python": "Python", "cpp": "C++"}


def drop_unusable(
    programs: Mapping[tuple[str, str], Sequence[Node]], language: str
) -> tuple[dict[tuple[str, str], Sequence[Node]], list[Diagnostic]]:
    """Return the programs, by package and executable, whose names can be written, and a finding for each name that cannot."""
    usable: dict[tuple[str, str], Sequence[Node]] = {}
    findings: dict[tuple[str, ...], Diagnostic] = {}
    first_packages: dict[str, tuple[str, Node]] = {}
    for (package, executable), nodes in programs.items():
        node = nodes[0]
        twin, twin_node = first_packages.setdefault(package.casefold(), (package, node))
        fault = _explain_bad_package(package, language)
        if fault:
            findings.setdefault((package,), _diagnose_program(f"the package `{package}` is left out: {fault}", node))
        elif twin != package:
            message = f"the package `{package}` is left out: on many systems it is the folder of `{twin}`"
            findings.setdefault((package,), _diagnose_program(message, node, twin_node))
        elif len(executable) > _MAX_NAME or not _EXECUTABLE.match(executable):
            message = f"the program `{executable}` of `{node.id}` is left out: no file is called so that ROS runs"
            findings[package, executable] = _diagnose_program(message, node)
        else:
            usable[package, executable] = nodes
    return usable, list(findings.values())


def _explain_bad_package(package: str, language: str) -> str:
    """Return why a package cannot have a name, as the end of a sentence; empty where it can."""
    if not _PACKAGE.match(package):
        return "packages have names of letters (a to z), digits and `_`"
    if len(package) > _MAX_NAME:
        return f"its name has more than {_MAX_NAME} letters"
    if make_identifier_in(language, package) == f"{package}_":
        return f"its name is a word of {_LANGUAGES[language]}"
    return ""


def _diagnose_program(message: str, node: Node, first: Node | None = None) -> Diagnostic:
    labels = (Label(first.at, "the first one"),) if first else ()
    help_line = "give the node another `package` or `executable`"
    severity = NOT_GENERATED.severity
    return Diagnostic(NOT_GENERATED.name, message, node.at, severity, labels=labels, help=help_line, element=node.id)
