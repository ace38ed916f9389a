"""What became of the fields of a message: one line of input, one sentence."""

from __future__ import annotations

import pytest

from archgen.compare.comparison import Change
from archgen.compare.key_phrases import describe_key_change


@pytest.mark.parametrize(
    ("before", "after", "sentence"),
    [
        ("float32 radius", "float64 radius", "`radius` is `float64` instead of `float32`"),
        ("int8 a, float32 altitude", "int8 a, float32 height", "`altitude` is called `height` now"),
        ("int8 a, int8 b", "int16 a, int8 c", "`a` is `int16` instead of `int8`, `b` is called `c` now"),
        ("int8 a, int8 b", "int8 c, int8 a", "fields `int8 b` → `int8 c`"),
        ("int8 a", "int16 b", "fields `int8 a` → `int16 b`"),
        ("int8 a", "int8 a, int8 b", "fields `int8 b` added"),
        ("int8 a, int8 b", "int8 a", "fields `int8 b` removed"),
        ("int8 a, ---, int8 a", "int8 a, ---, int16 a", "`a` is `int16` instead of `int8`"),
        ("int8 a, ---", "---, int8 a", "fields `int8 a` → `int8 a`"),
        ("int8 a, int8 b", "int8 b, int8 a", "fields are now `int8 b` and `int8 a`, in this order"),
    ],
)
def test_fields_are_told_by_what_became_of_them(before: str, after: str, sentence: str) -> None:
    change = Change(
        "changed", "message", "m_msgs/msg/M", key="fields", before=before.split(", "), after=after.split(", ")
    )
    assert describe_key_change(change) == f"message `m_msgs/msg/M`: {sentence}"
