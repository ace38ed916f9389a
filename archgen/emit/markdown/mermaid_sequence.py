"""Write a sequence as a Mermaid sequence diagram, for a wiki."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.emit.markdown.mermaid_chart import escape_mermaid
from archgen.views.chart_shapes import Lifeline, SequenceChart, SequenceMessage

_MAX_LENGTH = 60
_ARROWS = {"service": "-->>", "action": "-->>", "broken": "-x"}


def write_sequence_diagram(chart: SequenceChart) -> Iterator[str]:
    """Yield the lines of a sequence diagram. Who takes part is `p0`, `p1`: no text of the model is a name or a word of Mermaid."""
    yield "sequenceDiagram"
    yield from (f"  {_write_lifeline(at, lifeline)}" for at, lifeline in enumerate(chart.lifelines))
    yield from (f"  {_write_message(message)}" for message in chart.messages)


def _write_lifeline(at: int, lifeline: Lifeline) -> str:
    word = "actor" if lifeline.kind == "actor" else "participant"
    return f"{word} p{at} as {_escape_text(lifeline.title)}"


def _write_message(message: SequenceMessage) -> str:
    arrow = _ARROWS.get(message.style, "->>")
    details = [part for part in message.detail.split("\n") if part]
    # The number comes first, so that no text can begin with a word that Mermaid knows.
    words = "<br>".join([_escape_text(f"{message.number} {message.text}"), *map(_escape_text, details)])
    return f"p{message.tail}{arrow}p{message.head}: {words}"


def _escape_text(text: str) -> str:
    line = " ".join(text.split())
    line = line if len(line) <= _MAX_LENGTH else f"{line[: _MAX_LENGTH - 1]}…"
    # A colon may begin a directive (`wrap:`).
    return escape_mermaid(line).replace(":", "#58;")
