"""Write docs/modules.md: the table of contents of the two largest parts of the package, from the docstrings of their modules."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "modules.md"
FOLDERS = ("timing", "timing/load", "views")
"""Folders of archgen whose modules are listed; of a folder in one of them, what its own docstring says."""
_HEAD = """\
# What stands where in timing and views

Written by `make pages` from the docstrings of the modules: [CONTRIBUTING](../CONTRIBUTING.md) says how the rooms lie above one another.
"""


def make_page() -> str:
    """Return the page."""
    return "\n".join([_HEAD, *(line for folder in FOLDERS for line in _list_lines(folder))])


def _list_lines(folder: str) -> Iterator[str]:
    place = ROOT / "archgen" / folder
    yield f"## `archgen/{folder}/`"
    yield ""
    yield read_summary(place / "__init__.py")
    yield ""
    yield "| module | what it is for |"
    yield "|---|---|"
    for path in sorted(place.iterdir()):
        if path.is_dir() and (path / "__init__.py").is_file():
            yield f"| `{path.name}/` | {_escape(read_summary(path / '__init__.py'))} |"
        elif path.suffix == ".py" and path.name != "__init__.py":
            yield f"| `{path.stem}` | {_escape(read_summary(path))} |"
    yield ""


def read_summary(path: Path) -> str:
    """Return the first sentence of a module's docstring."""
    docstring = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return " ".join(docstring.partition("\n\n")[0].split())


def _escape(text: str) -> str:
    return text.replace("|", "\\|")


def main() -> int:
    """Write the page."""
    PAGE.write_text(make_page(), encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
