"""Two branches that both imported: their records merge without asking anybody, and where they differ nothing is known."""

from __future__ import annotations

import pytest

from archgen.merge.file_merge import is_record, merge_contents, merge_records
from archgen.merge.slice_merge import SliceVersions

HEADER = "# From r.launch.py by `archgen import launch`; with --merge it is brought up to date.\n"
BASE = HEADER + "nodes:\n  a:\n    namespace: /front\n    version: 1.10\n  b: {package: p}\n"


@pytest.mark.parametrize(
    ("ours", "theirs", "merged"),
    [
        (BASE.replace("/front", "/x"), BASE + "  c: {package: p}\n", BASE.replace("/front", "/x") + "  c: {package: p}\n"),
        # Both have another value: of this one nothing is known, of all others it is.
        (
            BASE.replace("/front", "/x"),
            BASE.replace("/front", "/y"),
            HEADER + "nodes:\n  a:\n    version: 1.10\n  b:\n    package: p\n",
        ),
        # One took out what the other one changed.
        (BASE.replace("  b: {package: p}\n", ""), BASE.replace("package: p", "package: q"), HEADER + "nodes:\n  a:\n    namespace: /front\n    version: 1.10\n"),
        (BASE, "<<<<<<< broken\n", HEADER + "{}\n"),
    ],
)  # fmt: skip
def test_records_merge(ours: str, theirs: str, merged: str) -> None:
    assert merge_records(SliceVersions(BASE, ours, theirs)) == merged


def test_the_path_says_that_a_file_is_a_record() -> None:
    base, ours, theirs = (BASE.replace("/front", name).encode() for name in ("/front", "/x", "/y"))
    assert merge_contents(base, ours, theirs, path="robot/.archgen/imported/a.yaml").problem is None
    assert merge_contents(base, ours, theirs, path="robot/a.yaml").problem == "both sides changed `nodes.a.namespace`"
    assert [
        is_record(path) for path in (".archgen/imported/a.yaml", ".archgen/said_elsewhere/a.yaml", "imported/a.yaml")
    ] == [
        True,
        True,
        False,
    ]
