"""Lines of a recording, one at a time: however long, whatever bytes; oddities are counted by kind."""

from __future__ import annotations

import io

from archgen.diagnostics.diagnostic import Severity
from archgen.plugins.recordings.recorded_figures import MAX_LINE_BYTES, Oddities, OddityText, RecordingSource


def _read(data: bytes) -> list[tuple[int, str]]:
    return list(RecordingSource("r", io.BytesIO(data)).read_lines())


def test_lines_are_numbered_and_lose_their_ends() -> None:
    assert _read(b"\xef\xbb\xbfa\r\n\nb\xff") == [(1, "a"), (2, ""), (3, "b\ufffd")]


def test_a_line_that_is_too_long_is_one_line() -> None:
    lines = _read(b"a" * (3 * MAX_LINE_BYTES) + b"\nb\n" + b"c" * MAX_LINE_BYTES + b"\nd")
    assert [number for number, _ in lines] == [1, 2, 3, 4]
    assert (lines[1], lines[3]) == ((2, "b"), (4, "d"))


def test_oddities_of_one_kind_are_one_finding_at_the_first() -> None:
    oddities = Oddities(RecordingSource("r", io.BytesIO()))
    oddities.note("slip", 7)
    oddities.note("slip", 9, 2000)
    found = list(oddities.diagnose({"slip": OddityText("{count} slip{s}", severity=Severity.NOTE)}))
    assert [(str(d.span), d.message) for d in found] == [("r:7:1", "2,001 slips")]
