"""Count the package's lines by what they are for, and write the table of docs/quality.md: `make size`."""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from functools import reduce
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
        "regular_files.py",
        "grouping.py",
    ),
    "the language: YAML, schema, short forms": ("syntax", "schema", "language"),
    "the model, selectors": ("model", "diagnostics"),
    "rules and findings": ("analyses", "findings"),
    "timing, with its tables and printing": ("timing", "views/timing", "emit/terminal/timing_", "views/timing_"),
    "simulation of timing": ("simulation",),
    "robots that exist, held against the design": ("conformance",),
    "comparison, review, merging, history": ("compare", "merge", "history", "views/changes", "views/agreement"),
    "importers, what plug-ins may use": ("importers", "plugin", "plugins/__init__.py", "installed_plugins.py"),
    "views and workspaces of generators": ("views/generation", "emit/workspace", "installed_backends.py"),
    "passes and rules of one's own": ("passes",),
    "pictures": ("views/graphs", "views/sequences", "emit/graphviz", "emit/fonts"),
    "site, explorer, search, preview": ("emit/site", "views/explorer", "views/search", "serve"),
    "editors": ("live", "lsp"),
    "Word and PDF report": ("emit/docx", "views/report"),
    "views that all outputs share": ("views",),
    "data, terminal, other formats": ("emit",),
    "start, editing, git, forges": ("start", "edit", "git", "forge"),
    "verbs and products": ("cli", "products", "api.py", "cache", "resources.py", "__init__.py", "__main__.py"),
}
"""What each part of the core is for, by the beginnings of its files' paths; the longest beginning counts."""
PLUGINS = "plugins"
"""The folder of the plug-ins that ship: each of its folders is one, and counted by itself."""


class Size(NamedTuple):
    """The files of a part, and their lines."""

    files: int
    lines: int

    def join(self, other: Size) -> Size:
        """Return the size of both."""
        return Size(self.files + other.files, self.lines + other.lines)


def measure_sizes() -> dict[str, Size]:
    """Return the size of each capability of the core, and of each plug-in. Raise ValueError for a file that is of none."""
    sizes = dict.fromkeys(CAPABILITIES, Size(0, 0))
    for path in sorted((ROOT / "archgen").rglob("*.py")):
        name = path.relative_to(ROOT / "archgen").as_posix()
        # What backends of plug-ins copy into workspaces is none of archgen's code.
        if "/backends/" not in name:
            capability = find_capability(name)
            size = Size(1, len(path.read_bytes().splitlines()))
            sizes[capability] = sizes.get(capability, Size(0, 0)).join(size)
    return sizes


def find_capability(name: str) -> str:
    """Return what a file of the package is for, or its plug-in. Raise ValueError where no capability has it."""
    top, _, rest = name.partition("/")
    if top == PLUGINS and "/" in rest:
        return f"plug-in `{rest.partition('/')[0]}`"
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
    """Return the table: the core with its parts, the plug-ins, and all; in each the largest first."""
    rows = []
    for title, is_core in (("**the core**", True), ("**the plug-ins**", False)):
        parts = [(name, size) for name, size in sizes.items() if (name in CAPABILITIES) == is_core]
        total = reduce(Size.join, (size for _, size in parts), Size(0, 0))
        rows += [(title, total), *sorted(parts, key=lambda item: -item[1].lines)]
    rows.append(("**all**", reduce(Size.join, sizes.values(), Size(0, 0))))
    lines = [f"| {name} | {size.files:,} | {size.lines:,} |" for name, size in rows]
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
