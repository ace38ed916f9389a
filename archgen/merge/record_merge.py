"""Merge what two branches know of the last import: of what they say differently nothing is known any more.

So the next import takes nothing away there, and people are not asked about files that nobody edits.
"""

from __future__ import annotations

from typing import Any

from archgen.merge.slice_merge import SliceVersions, merge_slices
from archgen.merge.slice_reading import read_tree, to_texts
from archgen.syntax.yaml_writer import write_yaml

RECORD_FOLDER = ".archgen/imported"
"""What the last import said, below the project's folder, a file for each slice: base of the merge with what the next one says."""
ELSEWHERE_FOLDER = ".archgen/said_elsewhere"
"""What it said and other files of the project say, too, so that a slice leaves it out: each difference is told once."""

SOURCE_FOLDER = ".archgen/imported_from"
"""From which files a slice comes, and the digest of what they held."""


def is_record(path: str) -> bool:
    """Whether a file of a repository is a record of an import."""
    return any(f"/{folder}/" in f"/{path}" for folder in (RECORD_FOLDER, ELSEWHERE_FOLDER, SOURCE_FOLDER))


def merge_records(versions: SliceVersions) -> str:
    """Return what two versions of a record say together. Of one that cannot be read nothing is known."""
    merged = merge_slices(versions)
    if isinstance(merged, str):
        return merged
    lines = versions.ours.splitlines(keepends=True)
    header = "".join(lines[: next((number for number, line in enumerate(lines) if line[:1] != "#"), len(lines))])
    roots = [read_tree(text) for text in (versions.base, versions.ours, versions.theirs)]
    sides = [to_texts(root) for root in roots if root is not None]
    if len(sides) < len(roots):
        return f"{header}{{}}\n"
    while not isinstance(merged, str):
        path = merged.conflict_path
        forgotten = [_forget(side, path) for side in sides]
        if not any(forgotten):
            return f"{header}{{}}\n"
        merged = merge_slices(SliceVersions(*(header + write_yaml(side) for side in sides)))
    return merged


def _forget(data: Any, path: tuple[str, ...]) -> bool:  # noqa: ANN401 - plain data
    """Take out what stands at a path, or what it leads through that has no keys; return whether something did."""
    for number, key in enumerate(path, 1):
        if not isinstance(data, dict) or key not in data:
            return False
        if number == len(path) or not isinstance(data[key], dict):
            del data[key]
            return True
        data = data[key]
    return False
