"""Activities, arcs and results as plain values: defaults, and what takes part in equality."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.diagnostics.source_span import Span
from archgen.timing.analysis import ChainTerm, EventPace, Reason
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue
from archgen.timing.system.system_builder import build_system
from archgen.timing.system.timing_system import Activity, Arc, TimingSystem, group_arcs, is_selective_arc
from tests.timing.sketches import read_sketch

HERE = Span("a.yaml", 3, 4, 3, 9)


def _arc(source: str, target: str, at: Span = HERE) -> Arc:
    return Arc(source, "out", target, "in", "/t", "topic", at=at, queue_at=at)


def test_places_take_no_part_in_equality_and_are_not_shown() -> None:
    moved = Span("b.yaml", 7, 1, 7, 2)
    assert _arc("a", "b") == _arc("a", "b", moved)
    first, second = (Activity("a", "a", None, None, at=at, places={"wcet": at}) for at in (HERE, moved))
    assert first == second
    assert Reason("why", HERE) == Reason("why", moved)
    terms = [ChainTerm("a", UNKNOWN_VALUE, UNKNOWN_VALUE, UNKNOWN_VALUE, "why", at) for at in (HERE, moved)]
    assert terms[0] == terms[1]
    for shown in (_arc("a", "b"), first, Reason("why", HERE), terms[0]):
        assert "Span" not in repr(shown)


def test_what_nobody_writes_of_an_activity() -> None:
    activity = Activity("a", "a", None, None)
    assert (activity.jitter, activity.every, activity.throttle, activity.mode) == (0, 1, 0, "any")
    assert not activity.behaviour_inferred
    assert (activity.period, activity.wcet, activity.bcet, activity.response) == (None, None, None, None)
    assert (activity.priority, activity.host, activity.container, activity.core) == (None, None, None, None)


def test_what_nobody_writes_of_an_arc() -> None:
    arc = _arc("a", "b")
    assert (arc.role, arc.link, arc.best, arc.worst) == ("data", None, 0, 0)
    assert (arc.depth, arc.size, arc.optional, arc.depth_written) == (None, None, False, False)


def test_arcs_are_grouped_in_order() -> None:
    arcs = (_arc("a", "b"), _arc("a", "c"), _arc("b", "c"))
    assert group_arcs((arc.source, arc) for arc in arcs) == {"a": arcs[:2], "b": arcs[2:]}
    assert TimingSystem(Fraction(1), {}, (), {}, {}).queued_links == frozenset()


def test_a_reason_is_put_into_words_when_it_is_asked() -> None:
    arguments = ("cam", 3, Fraction(1_500_000), TimingValue(Fraction(20)))
    assert Reason("{0} {1} {2} {3}", HERE, arguments).text == "cam 3 1.5 ms 20 Hz"
    assert Reason("{0} stays").text == "{0} stays"
    assert EventPace(None).inferred


@pytest.mark.parametrize(
    ("wires", "timing", "selective"),
    [
        # Fewer than one call in each activation may be none in this one.
        ("a?s", "calls: {s: 0.5}", "request"),
        ("a?s", "calls: {s: 1}", ""),
        ("a?s", "", ""),
        # A server that somebody else calls as well answers this one not each time; nor does one that has a clock.
        ("a?s b?s", "", "answer"),
        ("a?k", "", "answer"),
        # What a server only reads does not activate it; what fires it does.
        ("a?s b>s", "", ""),
        ("a?e b>e", "", "answer"),
        # A condition without a promise.
        ("a>b", "outputs: {out: {conditional: true}}", "data"),
        ("a>b", "outputs: {out: {conditional: true, max_gap: 1 s}}", ""),
        ("a>b", "", ""),
    ],
)
def test_what_an_activation_may_not_send(wires: str, timing: str, selective: str) -> None:
    nodes = {
        "a": f"period: 10 ms{timing and ', '}{timing}",
        "b": "period: 20 ms",
        "s": "wcet: 1 ms",
        "k": "period: 5 ms",
        "e": "behaviour: event, wcet: 1 ms",
    }
    system, _ = build_system(read_sketch(nodes, wires))
    found = [arc.role for arc in system.arcs if "a" in {arc.source, arc.target} and is_selective_arc(system, arc)]
    assert " ".join(found) == selective
