"""Count what each generator consists of: its templates, and the Python that makes its views. docs/quality.md shows it."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from archgen.emit.backend_manifests import Backend, find_backends
from archgen.installed_plugins import list_shipped_facts
from archgen.views.generation import CORE_VIEWS, find_view_maker

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "quality.md"
HEADING = "## How large the generators are"
_VIEWS = ROOT / "archgen" / "views" / "generation"
_OFFERED = "archgen.plugin."
_TABLE = re.compile(rf"(?<=^{re.escape(HEADING)}\n\n)(?:\|.*\n)*", re.MULTILINE)


def renew_table(page: str) -> str:
    """Return the text of the page with the numbers of now."""
    backends, _ = find_backends(ROOT / "tools")
    generators = [each for _, each in sorted(backends.items()) if each.makes == "workspace"]
    rows = [_describe(each) for each in generators]
    head = "| generator | templates | lines, mean | modules of its views | lines, mean | passes |\n|---|---|---|---|---|---|\n"
    return _TABLE.sub(lambda _: head + "".join(rows), page, count=1)


def _describe(generator: Backend) -> str:
    templates = sorted(path for path in (generator.folder / "templates").rglob("*") if path.is_file())
    modules = sorted(set[Path]().union(*(_find_modules(view) for view in generator.views if find_view_maker(view))))
    counts = " | ".join(f"{len(files)} | {_count_mean(files)}" for files in (templates, modules))
    return f"| `{generator.id}` | {counts} | {', '.join(generator.passes)} |\n"


def _count_mean(files: list[Path]) -> str:
    """Return how many lines files have in the mean, without empty ones."""
    lines = [sum(1 for line in file.read_text(encoding="utf-8").splitlines() if line.strip()) for file in files]
    return f"{sum(lines) / len(lines):.1f}" if lines else ""


@cache
def _find_modules(view: str) -> set[Path]:
    """Return the modules that a view for generators is made with: the one that makes it, and what that imports of its kind."""
    targets = {name: target for _, name, target in list_shipped_facts("views")}
    if view in targets:
        waiting = [_find_file(targets[view].partition(":")[0])]
    else:
        tree = ast.parse((_VIEWS / "__init__.py").read_text(encoding="utf-8"))
        maker = CORE_VIEWS[view].__name__
        function = next(each for each in tree.body if isinstance(each, ast.FunctionDef) and each.name == maker)
        waiting = list(_list_imported(function))
    found: set[Path] = set()
    while waiting:
        file = waiting.pop()
        if file not in found:
            found.add(file)
            waiting += _read_imports(file)
    return found


@cache
def _read_imports(file: Path) -> set[Path]:
    return _list_imported(ast.parse(file.read_text(encoding="utf-8")))


def _list_imported(tree: ast.AST) -> set[Path]:
    """Return the modules of plug-ins and of the core's own views for generators that are imported, through `archgen.plugin`, too."""
    found: set[Path] = set()
    for node in ast.walk(tree):
        if not isinstance(node, ast.ImportFrom) or node.module is None:
            continue
        for alias in node.names:
            is_offered = node.module.startswith(_OFFERED)
            module = _read_offered_names(node.module).get(alias.name, "") if is_offered else node.module
            if module.startswith(("archgen.plugins.", "archgen.views.generation")):
                found |= {file for name in (f"{module}.{alias.name}", module) if (file := _find_file(name)).is_file()}
    return found


@cache
def _read_offered_names(module: str) -> Mapping[str, str]:
    """Return where each name comes from that a module of `archgen.plugin` offers."""
    tree = ast.parse(_find_file(module).read_text(encoding="utf-8"))
    imports = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
    return {alias.name: node.module or "" for node in imports for alias in node.names}


def _find_file(module: str) -> Path:
    return ROOT / f"{module.replace('.', '/')}.py"
