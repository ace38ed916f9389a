"""Three sides of a slice: what becomes of a key that the source and people changed, what is told, and the text."""

from __future__ import annotations

import pytest

from archgen.edit.earlier_import import read_slice_content
from archgen.edit.import_merge import ImportChange, ImportSides, merge_import

NODE = "nodes: {a: {package: p, arguments: [-v], remaps: {x: /x}}}\n"


@pytest.mark.parametrize(
    ("mine", "now", "merged", "told"),
    [
        (
            NODE.replace("[-v]", "[-v, -q]"),
            NODE.replace("[-v]", "[-w]"),
            "-v, -q",
            "it was `-v` and is `-w` now; `-v, -q` of the slice stays",
        ),
        (
            NODE.replace("[-v]", "[-v, -q]"),
            NODE.replace("[-v]", "[-w, -v]"),
            "-w, -v, -q",
            "changed: nodes.a.arguments: from `-v` to `-w, -v`",
        ),
        (
            NODE.replace(", arguments: [-v]", ""),
            NODE.replace("[-v]", "[-w]"),
            "",
            "people took it out, and it stays out",
        ),
        (
            NODE.replace("/x", "/y"),
            NODE.replace(", remaps: {x: /x}", ""),
            "-v",
            "not said any more, but people wrote there, which stays: nodes.a.remaps",
        ),
        (NODE.replace("/x", "/y"), "{}\n", "", "not said any more, but people wrote there, which stays: nodes"),
        # Only struck out: nothing of theirs is in it.
        (NODE.replace(", arguments: [-v]", ""), "{}\n", None, "removed: nodes"),
        ("{}\n", NODE.replace("[-v]", "[-w]"), None, "people took it out, and it stays out"),
    ],
)
def test_both_sides_change_one_thing(mine: str, now: str, merged: str | None, told: str) -> None:
    merge, updated = merge_import("s.yaml", ImportSides(NODE, mine, now, read_slice_content("s.yaml", now).data))
    assert [told in change.describe() for change in merge.changes] == [True]
    node = merge.data["nodes"]["a"] if merge.data else None
    assert merged == (node and ", ".join(node.get("arguments", [])))
    assert read_slice_content("s.yaml", updated.text).data == merge.data


def test_long_values_are_told_where_they_differ() -> None:
    before, now = (f"`{'word, ' * 30}{end}, {'more, ' * 30}`" for end in ("first", "second"))
    change = ImportChange("changed", ("nodes", "a", "command"), before, now)
    old, new = (f"`... d, word, word, {end}, more" for end in ("first", "second"))
    told = change.describe()
    assert told.startswith(f"changed: nodes.a.command: from {old}")
    assert f" ...` to {new}" in told
    assert len(told) < 250


def test_fields_stand_in_the_order_that_both_sides_say() -> None:
    base = "types: {T: {fields: {a: int32, c: int32}}}\n"
    mine, now = (base.replace("c:", f"{name}: int32, c:") for name in ("b", "d"))
    conflict, _ = merge_import("s.yaml", ImportSides(base, mine, now, read_slice_content("s.yaml", now).data))
    assert [change.kind for change in conflict.changes] == ["conflict"]
    assert list(conflict.data["types"]["T"]["fields"]) == ["a", "b", "c"]
    now = base.replace("c: int32", "c: int32, d: int32")
    merge, updated = merge_import("s.yaml", ImportSides(base, mine, now, read_slice_content("s.yaml", now).data))
    assert list(merge.data["types"]["T"]["fields"]) == ["a", "b", "c", "d"]
    assert updated.text == "types: {T: {fields: {a: int32, b: int32, c: int32, d: int32}}}\n"
