"""Cut a release: the version into the package, and what was `Unreleased` in CHANGELOG.md below it. `make release VERSION=1.2.3`.

With `--notes VERSION` nothing is written: what CHANGELOG.md says of that version is printed, as it is for a release. It ends
with 1 where the package has another version, so that a tag which does not fit releases nothing.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CHANGELOG, PACKAGE = "CHANGELOG.md", "archgen/__init__.py"
VERSION = re.compile(r'^__version__ = "(.+)"$', re.MULTILINE)
UNRELEASED = "## Unreleased\n"


def cut(root: Path, version: str) -> None:
    """Write a version into both files. Raise ValueError where there is nothing to release, or no such version."""
    if not re.fullmatch(r"\d+\.\d+\.\d+", version):
        msg = f"`{version}` is no version: three numbers, as in 1.2.3"
        raise ValueError(msg)
    changelog, package = ((root / name).read_text(encoding="utf-8") for name in (CHANGELOG, PACKAGE))
    if f"\n## {version}\n" in changelog or not read_section(changelog, "Unreleased"):
        msg = f"{CHANGELOG} has {version} already, or nothing below `Unreleased`"
        raise ValueError(msg)
    (root / CHANGELOG).write_text(changelog.replace(UNRELEASED, f"{UNRELEASED}\n## {version}\n", 1), encoding="utf-8")
    (root / PACKAGE).write_text(VERSION.sub(f'__version__ = "{version}"', package, count=1), encoding="utf-8")


def read_section(changelog: str, name: str) -> str:
    """Return what stands below a heading, empty where there is none."""
    _, _, rest = changelog.partition(f"\n## {name}\n")
    return re.split(r"^## ", rest, maxsplit=1, flags=re.MULTILINE)[0].strip()


def read_notes(root: Path, version: str) -> str:
    """Return the notes of the version that the package has. Raise ValueError where it has another, or there are none."""
    match = VERSION.search((root / PACKAGE).read_text(encoding="utf-8"))
    notes = read_section((root / CHANGELOG).read_text(encoding="utf-8"), version)
    if match is None or match[1] != version or not notes:
        msg = f"the package is {match[1] if match else 'nameless'}, not {version}, or {CHANGELOG} says nothing of it"
        raise ValueError(msg)
    return notes


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("version")
    parser.add_argument("--notes", action="store_true")
    arguments = parser.parse_args()
    try:
        if arguments.notes:
            print(read_notes(ROOT, arguments.version))
        else:
            cut(ROOT, arguments.version)
    except ValueError as error:
        sys.exit(str(error))
