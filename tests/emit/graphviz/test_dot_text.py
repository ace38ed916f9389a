"""Text in DOT: nothing that anybody writes gets out of its place."""

from __future__ import annotations

import pytest

from archgen.emit.graphviz.dot_text import clean_label_text, escape_label, quote_value, safe_address, wrap_text


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Object\tRecognition \n now", "Object Recognition now"),
        ("a\x00b\x1bc\x7f\x9b", "abc"),
        ("right\u202eleft\u2066", "rightleft"),
        ("half \ud800 of a pair", "half  of a pair"),
        ("\ufdd0\uffff", ""),
        ("Grüße an 机器人 🤖", "Grüße an 机器人 🤖"),
        ("x" * 500, "x" * 399 + "…"),
    ],
)
def test_clean(text: str, expected: str) -> None:
    assert clean_label_text(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (r"\N & <b>", "&#92;N &amp; &lt;b&gt;"),
        ('"', "&quot;"),
        ("&lt;", "&amp;lt;"),
        ("", "\u00a0"),
    ],
)
def test_html(text: str, expected: str) -> None:
    assert escape_label(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('say "no"', r'"say \"no\""'),
        ("back\\slash", r'"back\\slash"'),
        ("a &amp; b", '"a &amp;amp; b"'),
        ("two\nlines", r'"two\nlines"'),
        ('"]; x [label="', r'"\"]; x [label=\""'),
    ],
)
def test_quoted(text: str, expected: str) -> None:
    assert quote_value(text) == expected


@pytest.mark.parametrize(
    ("href", "expected"),
    [
        ("#component:a.b", "#component:a.b"),
        ("groups/a.html#x:y", "groups/a.html#x:y"),
        ("https://example.org/a b", "https://example.org/a%20b"),
        ("javascript:alert(1)", ""),
        ("java\x00script:alert(1)", ""),
        (" JAVASCRIPT:alert(1)", ""),
        ("data:text/html,x", ""),
        ("file:///etc/passwd", ""),
    ],
)
def test_address(href: str, expected: str) -> None:
    assert safe_address(href) == expected


@pytest.mark.parametrize(
    ("text", "width", "expected"),
    [
        ("Battery and Fault Monitor", 18, ("Battery and Fault", "Monitor")),
        ("/human_state/activity_recognition/result", 30, ("/human_state", "/activity_recognition/result")),
        ("Donaudampfschifffahrtsgesellschaft", 18, ("Donaudampfschifffa", "hrtsgesellschaft")),
        ("a b c d e f g h", 1, ("a b", "c d", "e f", "g h")),
        ("", 18, ("",)),
    ],
)
def test_wrapped(text: str, width: int, expected: tuple[str, ...]) -> None:
    assert wrap_text(text, width) == expected
