"""Print each fact about the component types that ship beside the line it was read from, from clones of the repositories.

CLONES is a folder with a clone of each repository as OWNER/NAME, or OWNER+NAME, bare or not. What a source names and no
clone has (a commit, a file, a line) is told, and makes it fail; a repository that is not there is left out.
"""

from __future__ import annotations

import subprocess
import sys
from functools import cache
from pathlib import Path

from archgen.model.known_interfaces import KNOWN_DISTROS
from archgen.project.shipped_sources import ShippedSource, read_shipped_sources

_USAGE = "usage: show_ros_sources.py CLONES [TYPE...]"


def find_clone(clones: Path, source: ShippedSource) -> Path | None:
    """Return the clone of a source's repository; None where there is none."""
    owner, name = source.address.split("/")[-2:]
    folders = [clones / owner / name, clones / f"{owner}+{name}", clones / f"{owner}+{name}" / "repo"]
    return next((folder for folder in folders if (folder / ".git").exists() or (folder / "HEAD").exists()), None)


@cache
def read_lines(clone: Path, commit: str, file: str) -> list[str] | None:
    """Return the lines of a file at a commit; None where the clone has no such file."""
    command = ["git", "-C", str(clone), "show", f"{commit}:{file}"]
    shown = subprocess.run(command, capture_output=True, check=False)
    return shown.stdout.decode("utf-8", "replace").splitlines() if shown.returncode == 0 else None


def show_source(clone: Path, title: str, source: ShippedSource) -> int:
    """Print the facts of a source with their lines, and return how many of them are not where it says."""
    missing = 0
    for file, facts in source.files.items():
        lines = read_lines(clone, source.commit, file)
        for fact, line in facts.items():
            if lines is None or line > len(lines) or not lines[line - 1].strip():
                missing += 1
                print(f"{title} {fact}: not at {source.format_link(file, line)}", file=sys.stderr)
            else:
                print(f"{title} {fact}: {file}:{line}: {lines[line - 1].strip()}")
    return missing


def main(words: list[str]) -> int:
    """Print what the words ask for, and return 1 if something is not where a source says, 2 for wrong words."""
    if not words or not Path(words[0]).is_dir():
        print(_USAGE, file=sys.stderr)
        return 2
    clones, names, missing = Path(words[0]), set(words[1:]), 0
    for distro in KNOWN_DISTROS:
        for name, sources in read_shipped_sources(distro).items():
            for source in sources:
                clone = find_clone(clones, source) if not names or name in names else None
                if clone is not None:
                    missing += show_source(clone, f"{distro} {name}", source)
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
