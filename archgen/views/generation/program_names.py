"""Names that no package, program or class of generated code can have: what has one is left out, and said."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import Span
from archgen.model.code_names import make_identifier_in
from archgen.model.node import Node
from archgen.views.generation.cpp_programs import name_plugin
from archgen.views.generation.generation_context import tell_left_out

_PACKAGE_NAMES: Mapping[str, tuple[str, re.Pattern[str], str]] = {
    "cpp": ("C++", re.compile(r"[a-z][a-z0-9_-]*\Z", re.ASCII), "small letters, digits, `_` and `-`"),
    # A package of Python is imported by its name.
    "python": ("Python", re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z", re.ASCII), "letters, digits and `_`"),
}
_PROGRAM_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.+-]*\Z", re.ASCII)
_CLASS_NAME = re.compile(r"([A-Za-z_][A-Za-z0-9_]*)(?:::([A-Za-z_][A-Za-z0-9_]*))+\Z", re.ASCII)


def find_bad_names(
    package_name: str, program_name: str, nodes: Sequence[Node], place: Span, language: str
) -> tuple[Diagnostic, ...]:
    """Return what is wrong with the names of a program in `python` or `cpp`: with such names nothing can be built."""
    title, pattern, characters = _PACKAGE_NAMES.get(language, _PACKAGE_NAMES["cpp"])
    shown = f"the program of `{nodes[0].id}` is left out:"
    is_keyword = language == "python" and make_identifier_in("python", package_name) == f"{package_name}_"
    if not pattern.match(package_name) or is_keyword:
        message = f"{shown} no package of {title} can be called `{package_name}`"
        help_line = f"a package has {characters}, begins with a letter, and is no word of the language"
    elif not _PROGRAM_NAME.match(program_name):
        message = f"{shown} no program can be called `{program_name}`"
        help_line = "an `executable` has letters, digits, `_`, `-`, `.` and `+`"
    elif language == "cpp":
        return _find_bad_classes(package_name, program_name, nodes, place)
    else:
        return ()
    return (tell_left_out(message, place, element=nodes[0].id, help_line=help_line),)


def _find_bad_classes(
    package_name: str, program_name: str, nodes: Sequence[Node], place: Span
) -> tuple[Diagnostic, ...]:
    shown = f"the program of `{nodes[0].id}` is left out:"
    plugins = {name_plugin(each, package_name, program_name) for each in nodes}
    plugin = min(plugins)
    if len(plugins) > 1:
        shown_plugins = " and ".join(f"`{each}`" for each in sorted(plugins))
        message = f"{shown} its nodes have different classes, {shown_plugins}"
        help_line = "give the nodes of one class an `executable` of their own"
    elif not _CLASS_NAME.match(plugin) or any(make_identifier_in("cpp", part) != part for part in plugin.split("::")):
        message = f"{shown} no class of C++ can be called `{plugin}`"
        help_line = "a `plugin` is a namespace and a class: `robot_safety::ObstacleStop`"
    else:
        return ()
    return (tell_left_out(message, place, element=nodes[0].id, help_line=help_line),)
