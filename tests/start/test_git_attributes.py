"""The line of the merge driver in .gitattributes."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.start.project_plan import add_attribute

BOTH = "*.yaml merge=archgen\n*.yml merge=archgen\n"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("", BOTH),
        ("# x", "# x\n" + BOTH),
        ("*.md text\r\n", "*.md text\r\n*.yaml merge=archgen\r\n*.yml merge=archgen\r\n"),
        (BOTH.replace(" merge", " text merge") + "*.md text\n", None),
        (BOTH + "*.yaml eol=lf\n", None),
        ("*.yaml merge=archgen\n", BOTH),
        # Of several lines the last one counts.
        (BOTH + "*.yaml -merge\n", BOTH + "*.yaml -merge\n*.yaml merge=archgen\n"),
        ("# *.yaml merge=archgen\n", "# *.yaml merge=archgen\n" + BOTH),
        ("a.yaml merge=archgen\n", "a.yaml merge=archgen\n" + BOTH),
    ],
)
def test_the_line_stands_once_behind_what_is_there(tmp_path: Path, before: str, after: str | None) -> None:
    file = tmp_path / ".gitattributes"
    file.write_bytes(before.encode())
    assert add_attribute(tmp_path) is (after is not None)
    assert file.read_bytes().decode() == (before if after is None else after)
