"""The line of the merge driver in .gitattributes."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.start.merge_driver_setup import add_attribute


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("", "*.yaml merge=archgen\n"),
        ("# x", "# x\n*.yaml merge=archgen\n"),
        ("*.md text\r\n", "*.md text\r\n*.yaml merge=archgen\r\n"),
        ("*.yaml text merge=archgen\n*.md text\n", None),
        ("*.yaml merge=archgen\n*.yaml eol=lf\n", None),
        # Of several lines the last one counts.
        ("*.yaml merge=archgen\n*.yaml -merge\n", "*.yaml merge=archgen\n*.yaml -merge\n*.yaml merge=archgen\n"),
        ("# *.yaml merge=archgen\n", "# *.yaml merge=archgen\n*.yaml merge=archgen\n"),
        ("a.yaml merge=archgen\n", "a.yaml merge=archgen\n*.yaml merge=archgen\n"),
    ],
)
def test_the_line_stands_once_behind_what_is_there(tmp_path: Path, before: str, after: str | None) -> None:
    file = tmp_path / ".gitattributes"
    file.write_bytes(before.encode())
    assert add_attribute(tmp_path) is (after is not None)
    assert file.read_bytes().decode() == (before if after is None else after)
