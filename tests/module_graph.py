"""Which modules lead to which, by imports: of archgen and of its tests."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tests.running import ROOT

_FROM_IMPORT = re.compile(r"^ *from ((?:archgen|tests)[\w.]*) import (?:\(([^)]*)\)|(.*))", re.MULTILINE)
_FUNCTION = re.compile(r"^ *def ", re.MULTILINE)
_ATTRIBUTE = re.compile(r"\b(\w+)\.(\w+)")


@dataclass(frozen=True)
class SourceFile:
    """What a Python file imports: what each name stands for (`module` or `module.name`), and whether it has functions.

    Read by patterns: ruff writes imports in one way, and Python's own parser takes five times as long for 700 files.
    """

    text: str
    imported: Mapping[str, str]
    has_functions: bool


@cache
def read_source(path: Path) -> SourceFile:
    """Return what a file imports."""
    text = path.read_text(encoding="utf-8")
    imported: dict[str, str] = {}
    for module, in_brackets, in_line in _FROM_IMPORT.findall(text):
        for part in (in_brackets or in_line).split(","):
            name, _, alias = part.partition("#")[0].strip().partition(" as ")
            imported[alias or name] = f"{module}.{name}"
    return SourceFile(text, imported, _FUNCTION.search(text) is not None)


@cache
def list_modules() -> dict[str, Path]:
    """Return the file of each module of archgen and of the tests."""
    folders = (ROOT / "archgen", *(folder for folder in (ROOT / "tests").iterdir() if folder.name != "judges"))
    files = [file for folder in folders for file in ([folder] if folder.suffix == ".py" else folder.rglob("*.py"))]
    # What backends of plug-ins copy into workspaces is none of archgen's modules.
    files = [file for file in files if "backends" not in file.relative_to(ROOT).parts]
    return {".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): file for file in files}


def _resolve_name(name: str) -> str | None:
    """Return the module of archgen or of the tests in which `package.name` is defined."""
    modules = list_modules()
    if name in modules:
        return name
    module, _, own_name = name.rpartition(".")
    if module not in modules:
        return None
    # A package hands on what it imports: the module behind it counts.
    behind = read_source(modules[module]).imported.get(own_name)
    return (_resolve_name(behind) or module) if behind and behind != name else module


@cache
def find_imports(module: str) -> frozenset[str]:
    """Return the modules that a module imports, those that it uses through a package (`git.find_repository`) too."""
    source = read_source(list_modules()[module])
    names = {*source.imported.values()}
    names |= {
        f"{source.imported[name]}.{part}" for name, part in _ATTRIBUTE.findall(source.text) if name in source.imported
    }
    return frozenset(found for name in names if (found := _resolve_name(name)))


@cache
def _list_next(module: str) -> frozenset[str]:
    """Return the modules that a module leads to: by imports, by fixtures, by a process, by the name of a verb, by a plug-in."""
    from archgen.cli import VERBS, verb_module

    found = set(find_imports(module))
    if module == "archgen.cli":
        found |= {verb_module(verb) for verb in VERBS}
    if module == "archgen.installed_plugins":
        found |= {name for name in list_modules() if name.startswith("archgen.plugins.")}
    if module == "tests.running":
        found.add("archgen.__main__")
    if is_test(module):
        found |= {name for name in list_modules() if name.endswith("conftest") and module.startswith(name[:-8])}
    return frozenset(found)


def is_test(module: str) -> bool:
    """Whether a module holds tests."""
    return module.startswith("tests.") and module.rpartition(".")[2].startswith("test_")


def find_reachable(module: str) -> set[str]:
    """Return all modules that a module leads to, itself included."""
    reached, pending = {module}, [module]
    while pending:
        new = _list_next(pending.pop()) - reached
        reached |= new
        pending += new
    return reached
