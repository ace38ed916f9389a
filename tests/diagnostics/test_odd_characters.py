"""Blanks, quotes and dashes of word processors, where they stand and where they do no harm."""

from __future__ import annotations

import pytest

from archgen.diagnostics.odd_characters import find_misplaced_character, find_odd_character, name_character
from tests.judged_projects import check_text

_ROBOT = """\
groups:
  sensing:
    title: Sensing
    components:
      camera:
        title: Camera
        requirements: [Works at night]
        outputs: {image: sensor_msgs/msg/Image}
        timing: {rate: 30 Hz}
      screen: {inputs: {image: camera.image}}
nodes: {camera: camera, screen: screen}
"""


@pytest.mark.parametrize(
    ("text", "slip", "place", "character", "help_line"),
    [
        ("        title: Camera", "\u00a0       title: Camera", "6:1", "a no-break blank (U+00A0)", "write a plain blank in its place"),
        ("        title: Camera", "      \u202f title: Camera", "6:7", "a narrow no-break blank (U+202F)", "write a plain blank in its place"),
        ("  sensing:", "\u3000\u3000sensing:", "2:1", "a wide blank (U+3000)", "write `sensing`"),
        ("title: Camera", "title: “Camera: left”", "6:16", "a typographic quote (U+201C)", 'write a plain quote, `"`, in its place'),
        ("[Works at night]", "\n        \u2013 R-1", "8:9", "an en dash (U+2013)", "write `-` in its place"),
        ("title: Sensing", "title\uff1a Sensing", "3:10", "a wide colon (U+FF1A)", "write `:` in its place"),
        ("        title: Camera", "        title:\u00a0Camera", "6:15", "a no-break blank (U+00A0)", "write a plain blank in its place"),
        ("{rate: 30 Hz", "{rate:\u00a030 Hz", "9:18", "a no-break blank (U+00A0)", "write `rate: 30 Hz`"),
        ("30 Hz", "30\u00a0Hz", "9:26", "a no-break blank (U+00A0)", "write `30 Hz`"),
        ("title: Sensing", "tit\u200ble: Sensing", "3:8", "a zero-width blank (U+200B)", "write `title`"),
    ],
)  # fmt: skip
def test_a_character_that_is_none_of_yaml_is_named_where_it_stands(
    text: str, slip: str, place: str, character: str, help_line: str
) -> None:
    assert text in _ROBOT
    errors = [d for d in check_text(_ROBOT.replace(text, slip, 1)) if d.severity == "error"]
    assert [f"{d.span.line}:{d.span.column}" for d in errors] == [place]
    assert errors[0].message.startswith(character)
    assert errors[0].help == help_line


@pytest.mark.parametrize(
    "title", ["Caméra \u2013 90 % à 1 m", "„Wall-E“", "L\u2019œil", "“Eve” \u2014 the other one", "30 %"]
)
def test_text_of_people_may_hold_them(title: str) -> None:
    assert not [d for d in check_text(_ROBOT.replace("title: Camera", f"title: {title}")) if d.severity != "note"]


def test_characters_are_found_and_named() -> None:
    assert find_odd_character("plain text: 1") is None
    assert find_odd_character("a\u00a0b") == 1
    assert find_misplaced_character("title: a \u2013 b") is None
    assert find_misplaced_character("  \u2013 b") == 2
    assert name_character("\u2014") == "an em dash (U+2014)"
