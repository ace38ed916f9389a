"""Count what each generator consists of: its templates, and the Python that makes its views. docs/generation.md shows it."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from archgen.emit.backend_manifests import Backend, find_backends
from archgen.views.generation import GENERATION_VIEWS

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "generation.md"
HEADING = "## How large the generators are"
_VIEWS = ROOT / "archgen" / "views" / "generation"
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
    modules = sorted(set[Path]().union(*(_find_modules(view) for view in generator.views if view in GENERATION_VIEWS)))
    counts = " | ".join(f"{len(files)} | {_count_mean(files)}" for files in (templates, modules))
    return f"| `{generator.id}` | {counts} | {', '.join(generator.passes)} |\n"


def _count_mean(files: list[Path]) -> str:
    """Return how many lines files have in the mean, without empty ones."""
    lines = [sum(1 for line in file.read_text(encoding="utf-8").splitlines() if line.strip()) for file in files]
    return f"{sum(lines) / len(lines):.1f}" if lines else ""


def _find_modules(view: str) -> set[Path]:
    """Return the modules of views for generators that a view is made with: the one that makes it, and what that imports."""
    maker = GENERATION_VIEWS[view].__name__
    tree = ast.parse((_VIEWS / "__init__.py").read_text(encoding="utf-8"))
    function = next(each for each in tree.body if isinstance(each, ast.FunctionDef) and each.name == maker)
    found: set[Path] = set()
    waiting = list(_list_imported(function))
    while waiting:
        file = waiting.pop()
        if file not in found:
            found.add(file)
            waiting += _list_imported(ast.parse(file.read_text(encoding="utf-8")))
    return found


def _list_imported(tree: ast.AST) -> set[Path]:
    names = {
        f"{node.module}.{alias.name}"
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    parts = {
        name.removeprefix("archgen.views.generation.").split(".")[0] for name in names if ".views.generation." in name
    }
    return {_VIEWS / f"{part}.py" for part in parts if (_VIEWS / f"{part}.py").is_file()}
