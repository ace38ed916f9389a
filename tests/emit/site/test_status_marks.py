"""Each state has a form of its own: an icon, a class and the word."""

from __future__ import annotations

import re
from typing import get_args

from archgen.emit.site import html_text
from archgen.views.shapes import Status


def test_each_state_has_an_icon_and_a_class_without_blanks() -> None:
    chips = [html_text.write_chip(status, "word") for status in get_args(Status)]
    assert len({re.search(r'class="chip ([^" ]+)"', chip) is not None for chip in chips}) == 1
    # An error is crossed like a missed deadline, a warning is not like a note.
    assert len({html_text.write_icon(status) for status in get_args(Status)}) == len(chips) - 1


def test_a_mark_is_told_to_screen_readers() -> None:
    assert html_text.write_mark("open") == (
        '<span class="mark open"><span class="spoken"> (something is open)</span></span>'
    )
