"""The tokens of AADL: long ones take memory in proportion to the file."""

from __future__ import annotations

import tracemalloc
from itertools import islice

from archgen.plugins.aadl.token_cursor import scan_tokens


def test_a_long_text_is_read_without_a_note_for_each_of_its_characters() -> None:
    text = f'"{"a" * 2_000_000}"'
    tracemalloc.start()
    tokens = list(islice(scan_tokens(text), 1))
    peak_bytes = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(tokens[0].text) == len(text)
    assert peak_bytes < 10 * len(text)
