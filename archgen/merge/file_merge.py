"""Merge three versions of a file as git's merge drivers do: by what the slices say, else by lines with git's markers.

Merge what two branches know of the last import: of what they say differently nothing is known any more.

So the next import takes nothing away there, and people are not asked about files that nobody edits.
"""

from __future__ import annotations

from typing import Any

from archgen.frozen import dataclass
from archgen.git.object_reader import merge_lines
from archgen.merge.change_transfer import read_tree, to_texts
from archgen.merge.slice_merge import SliceVersions, UnmergedSlice, merge_slices
from archgen.merge.tree_merge import FIELD_ORDER
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


@dataclass(frozen=True, slots=True)
class FileMerge:
    """The merged content. `problem` says what a person has to settle in it, None for nothing; `conflict_path` are the keys
    that lead to what both sides changed, none where only the text is in the way.
    """

    content: bytes
    problem: str | None = None
    conflict_path: tuple[str, ...] = ()


def merge_contents(base: bytes, ours: bytes, theirs: bytes, marker_size: int = 7, path: str = "") -> FileMerge:
    """Merge three contents of a file, whose path says whether it is a record of an import. Raise `git.GitError` for binary files."""
    try:
        versions = SliceVersions(base.decode(), ours.decode(), theirs.decode())
        merged_slice = merge_records(versions) if is_record(path) else merge_slices(versions)
    except UnicodeDecodeError:
        merged_slice = UnmergedSlice()
    if isinstance(merged_slice, str):
        return FileMerge(merged_slice.encode())
    line_merge = merge_lines(base, ours, theirs, marker_size=marker_size)
    if line_merge.conflict_count:
        return FileMerge(line_merge.content, _describe_conflict(merged_slice), merged_slice.conflict_path)
    # git merges lines that say different things of one element, such as two sentences of one description: as it would
    # without this driver. But where both sides can be said together, lines that say anything else are wrong.
    if merged_slice.is_settled:
        return FileMerge(line_merge.content, "its lines merge, but the result does not say what both sides say")
    if merged_slice.rename_conflict:
        return FileMerge(line_merge.content, f"{merged_slice.rename_conflict}, and git takes the lines of both")
    # One id at two places with two contents: lines of both sides merge into a key that is there twice.
    if merged_slice.conflict_path and not (read_tree(line_merge.content.decode()) is not None):
        return FileMerge(line_merge.content, f"{_describe_conflict(merged_slice)}, and git takes the lines of both")
    return FileMerge(line_merge.content)


def _describe_conflict(merged_slice: UnmergedSlice) -> str:
    if merged_slice.rename_conflict:
        return merged_slice.rename_conflict
    *holder_keys, last_key = merged_slice.conflict_path or ("",)
    if last_key == FIELD_ORDER:
        return f"both sides added to `{'.'.join(holder_keys)}` at one place, where order is that of the message"
    if merged_slice.conflict_path:
        return f"both sides changed `{'.'.join(merged_slice.conflict_path)}`"
    return "both sides changed the same lines"
