"""What readers of the live site are told."""

from __future__ import annotations

import json

from archgen.serve.live_site import LiveStatus


def test_the_status_is_one_line_of_json_that_any_page_may_hold() -> None:
    text = LiveStatus(version="é1", shown_since="14:02:11", further_errors=2, is_outdated=True).to_json()
    assert text.isascii()
    assert "\n" not in text
    assert json.loads(text) == {
        "version": "é1",
        "since": "14:02:11",
        "errors": [],
        "further": 2,
        "outdated": True,
    }
