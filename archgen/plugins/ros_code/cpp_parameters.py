"""Which parameters of a program generate_parameter_library declares, and which its node declares itself.

The library turns names into members of structs, puts texts between quotes as they are, and wants a value for each at the start.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from archgen.plugin.generating import CPP_KEYWORDS

_MEMBER_NAME = re.compile(r"[a-z](?:_?[a-z0-9])*\Z", re.ASCII)
_TAKEN_NAMES = CPP_KEYWORDS | {
    # Macros of the C library, of compilers and of Qt.
    *("assert", "emit", "errno", "foreach", "i386", "linux", "major", "makedev", "minor", "signals", "slots"),
    *("stderr", "stdin", "stdout", "unix"),
    # Structs of the library's own.
    *("params", "stack_params"),
}
_PLAIN_TEXT = re.compile(r"(?!.*\?\?)[ !#-\[\]-~]*\Z", re.ASCII)


def choose_library_parameters(parameters: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Tell each parameter whether the library declares it (`is_in_library`), and return what the library gets.

    `library_rows` are its groups and parameters from top to bottom, each with its `depth`; a group has no `parameter`.
    """
    names = {str(each["name"]) for each in parameters}
    odd_structs = _find_odd_structs(names)
    tree: dict[str, Any] = {}
    for parameter in parameters:
        *groups, own_name = str(parameter["name"]).split(".")
        paths = {".".join(groups[: depth + 1]) for depth in range(len(groups))}
        parameter["is_in_library"] = (
            all(_MEMBER_NAME.match(each) and each not in _TAKEN_NAMES for each in (*groups, own_name))
            and not paths & (names | odd_structs)
            and _has_library_values(parameter)
        )
        if parameter["is_in_library"]:
            branch = tree
            for group in groups:
                branch = branch.setdefault(group, {})
            branch[own_name] = _Leaf(parameter)
    return {"library_rows": list(_list_rows(tree, 0))}


class _Leaf:
    def __init__(self, parameter: dict[str, Any]) -> None:
        self.parameter = parameter


def _list_rows(branch: Mapping[str, Any], depth: int) -> Iterator[dict[str, Any]]:
    for name, each in branch.items():
        if isinstance(each, _Leaf):
            yield {"depth": depth, "name": name, "parameter": each.parameter}
        else:
            yield {"depth": depth, "name": name, "parameter": None}
            yield from _list_rows(each, depth + 1)


def _find_odd_structs(names: set[str]) -> set[str]:
    """Return the groups whose struct another group beside them has: `a1_b` and `a1b` both give `A1B`."""
    groups = {name.rsplit(".", depth)[0] for name in names for depth in range(1, name.count(".") + 1)}
    structs = {
        group: (group.rpartition(".")[0], group.rpartition(".")[2].title().replace("_", "")) for group in sorted(groups)
    }
    counts = Counter(structs.values())
    return {group for group, struct in structs.items() if counts[struct] > 1}


def _has_library_values(parameter: Mapping[str, Any]) -> bool:
    """Whether the library can take a parameter's default, or demand a value, and check its choices."""
    if parameter["default"] is None and not parameter["is_given"]:
        return False
    if parameter["choices"] and parameter["type"].startswith("bool"):
        return False
    default = parameter["default"]
    values = [*(default if isinstance(default, list) else [default]), *parameter["choices"], parameter["lowest"]]
    # The least number has no literal in C++.
    return all(_PLAIN_TEXT.match(each) if isinstance(each, str) else each != -(2**63) for each in values)
