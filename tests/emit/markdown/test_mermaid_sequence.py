"""Sequences as Mermaid diagrams."""

from __future__ import annotations

from archgen.emit.markdown.mermaid_chart import write_sequence_diagram
from archgen.views.picture_shapes import Lifeline, SequenceChart, SequenceMessage


def test_no_text_of_the_model_is_a_word_of_mermaid() -> None:
    chart = SequenceChart(
        "sequences/UC-1",
        "Water",
        (Lifeline("end", "actor"), Lifeline("participant p0 as <b>")),
        (
            SequenceMessage(1, 0, 1, "wrap: asks;\n  end", "Voice\n\n5 ms", "data"),
            SequenceMessage(2, 1, 0, "word " * 20, "", "service"),
        ),
    )
    assert list(write_sequence_diagram(chart)) == [
        "sequenceDiagram",
        "  actor p0 as end",
        "  participant p1 as participant p0 as #60;b#62;",
        "  p0->>p1: 1 wrap#58; asks#59; end<br>Voice<br>5 ms",
        f"  p1-->>p0: {('2 ' + 'word ' * 20)[:59]}#8230;",
    ]
