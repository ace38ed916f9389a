"""Write into docs/plugins.md what the plug-ins that ship and the modules of archgen.plugin say of themselves."""

from __future__ import annotations

import importlib
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from archgen.installed_plugins import SHIPPED_PACKAGE, list_shipped_plugins

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "plugins.md"
_NO_PARTS = frozenset({"api", "page"})


def renew_page(page: str) -> str:
    """Return the page with both tables as they are now."""
    for mark, lines in (("shipped", _list_plugins()), ("subjects", _list_subjects())):
        table = "\n".join(lines)
        page = re.sub(rf"(?s)(<!-- {mark} -->\n).*?(<!-- end of {mark} -->)", rf"\g<1>{table}\n\g<2>", page)
    return page


def _list_plugins() -> Iterator[str]:
    yield "| plug-in | what it is for | what it brings | page |"
    yield "|---|---|---|---|"
    for name, facts in list_shipped_plugins().items():
        module = importlib.import_module(f"{SHIPPED_PACKAGE}.{name}")
        brought = {kind: list(facts[kind]) for kind in facts if kind not in _NO_PARTS}
        folder = ROOT / "archgen" / "plugins" / name / "backends"
        brought["backends"] = sorted(file.parent.name for file in folder.glob("*/backend.yaml"))
        parts = "; ".join(
            f"{kind}: {', '.join(f'`{each}`' for each in names)}" for kind, names in brought.items() if names
        )
        page = facts["page"].removeprefix("docs/")
        yield f"| `{name}` | {(module.__doc__ or '').strip()} | {parts} | [{page}]({page}) |"


def _list_subjects() -> Iterator[str]:
    yield "| module | what it is for |"
    yield "|---|---|"
    for subject in list_subjects():
        module = importlib.import_module(f"archgen.plugin.{subject}")
        yield f"| `archgen.plugin.{subject}` | {(module.__doc__ or '').strip()} |"


def list_subjects() -> list[str]:
    """Return the modules of archgen.plugin."""
    return sorted(file.stem for file in (ROOT / "archgen" / "plugin").glob("*.py") if file.stem != "__init__")


def main() -> int:
    """Write the page."""
    PAGE.write_text(renew_page(PAGE.read_text(encoding="utf-8")), encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
