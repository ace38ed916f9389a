"""Count the package's lines by what they are for, and write the table of docs/quality.md: `make size`."""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "quality.md"
CAPABILITIES: Mapping[str, tuple[str, ...]] = {
    "reading, linking, checking": (
        "checking",
        "link",
        "project",
        "derivation",
        "compose",
        "pipeline.py",
        "bringup",
        "frozen.py",
    ),
    "the language: YAML, schema, short forms": ("syntax", "schema", "language"),
    "the model, selectors": ("model", "diagnostics"),
    "rules and findings": ("analyses", "findings"),
    "timing, with its tables and printing": ("timing", "views/timing", "emit/terminal/timing_", "views/timing_"),
    "simulation of timing": ("simulation",),
    "comparison, review, merging, history": ("compare", "merge", "history", "views/changes", "views/agreement"),
    "importers": ("importers",),
    "views and workspaces of generators": ("views/generation", "views/uml", "emit/workspace"),
    "passes and rules of one's own": ("passes",),
    "pictures": ("views/graphs", "views/sequences", "emit/graphviz", "emit/fonts"),
    "site, explorer, search, preview": ("emit/site", "views/explorer", "views/search", "serve"),
    "Word and PDF report": ("emit/docx", "views/report"),
    "views that all outputs share": ("views",),
    "data, terminal, other formats": ("emit",),
    "start, editing, git, forges": ("start", "edit", "git", "forge"),
    "verbs and products": ("cli", "products", "api.py", "cache", "resources.py", "__init__.py", "__main__.py"),
}
"""What each part is for, by the beginnings of its files' paths; the longest beginning counts."""
GENERATED = frozenset({"language/language_tables.py"})
"""Files that nobody writes."""


class Size(NamedTuple):
    """The files of a capability, and their lines."""

    files: int
    lines: int


def measure_sizes() -> dict[str, Size]:
    """Return the size of each capability. Raise ValueError for a file that is of none."""
    sizes = dict.fromkeys(CAPABILITIES, Size(0, 0))
    for path in sorted((ROOT / "archgen").rglob("*.py")):
        name = path.relative_to(ROOT / "archgen").as_posix()
        if name not in GENERATED:
            capability = find_capability(name)
            size = sizes[capability]
            sizes[capability] = Size(size.files + 1, size.lines + len(path.read_bytes().splitlines()))
    return sizes


def find_capability(name: str) -> str:
    """Return what a file of the package is for. Raise ValueError where no capability has it."""
    beginnings = [
        (len(beginning), capability)
        for capability, places in CAPABILITIES.items()
        for beginning in places
        if name == beginning
        or name.startswith((f"{beginning}/", beginning if beginning.endswith("_") else f"{beginning}/"))
    ]
    if not beginnings:
        message = f"archgen/{name} belongs to no capability in tools/capability_sizes.py"
        raise ValueError(message)
    return max(beginnings)[1]


def write_table(sizes: Mapping[str, Size]) -> str:
    """Return the table, the largest first."""
    rows = sorted(sizes.items(), key=lambda item: -item[1].lines)
    total = Size(sum(each.files for each in sizes.values()), sum(each.lines for each in sizes.values()))
    lines = [f"| {name} | {size.files:,} | {size.lines:,} |" for name, size in [*rows, ("**all**", total)]]
    return "\n".join(["| what it is for | files | lines |", "|---|---|---|", *lines])


def renew_page(page: str, table: str) -> str:
    """Return the page with the table between its marks."""
    return re.sub(
        r"(?s)(<!-- sizes -->\n).*?(\n<!-- end of sizes -->)", lambda match: f"{match[1]}{table}{match[2]}", page
    )


def main() -> int:
    """Print the table, and renew that of the page."""
    table = write_table(measure_sizes())
    sys.stdout.write(f"{table}\n")
    PAGE.write_text(renew_page(PAGE.read_text(encoding="utf-8"), table), encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
