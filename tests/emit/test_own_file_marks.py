"""By which marks archgen knows its own files again, and what it takes for somebody else's."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from archgen.emit.own_file_marks import PACKED_HEADER, explain_refusal, name_written_format


@pytest.mark.parametrize(
    ("head", "name"),
    [
        (PACKED_HEADER + "archgen: 1\n", "packed project"),
        ("archgen: 1\n", "project"),
        ("# yaml-language-server: x\n\n# A robot.\narchgen: 1\n", "project"),
        ("archgen_resolved: 1\n", "resolved model"),
        ("groups: {}\n", None),
        ("", None),
        ("PK\x03\x04", None),
        ("no changes\n", "plain comparison"),
        ("no changes in what could be read\n", "plain comparison"),
        ("a\n2 changes (1 removed, 1 changed), 1 new finding; concerns x\n", "plain comparison"),
        ("warning: 2 breaking changes for a, b\n", "plain comparison"),
        ("12 changes of mind\n", None),
        ("no changes were made\n", None),
    ],
)
def test_a_mark_at_the_edge_names_the_format(head: str, name: str | None) -> None:
    assert name_written_format(io.BytesIO(head.encode())) == name


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        (b"", b"new", ""),
        (b"old", b"new", ""),
        ("é".encode() * 4000, b"new", ""),
        (b"\xe9", b"new", "is no text file"),
        (b"a\0", b"new", "is no text file"),
        (b"archgen: 1\n", b"new", "is a project"),
        (b"old", b"archgen_resolved: 1\n", "is no resolved model that archgen wrote"),
        (b"archgen_resolved: 1\nold: 1\n", b"archgen_resolved: 1\n", ""),
    ],
)
def test_only_the_same_kind_of_file_is_replaced(tmp_path: Path, old: bytes, new: bytes, reason: str) -> None:
    file = tmp_path / "file"
    file.write_bytes(old)
    assert explain_refusal(file, new) == (f"{file} {reason}" if reason else "")
