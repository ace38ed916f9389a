"""Rates, gaps and rings: every behaviour of the table, with the inputs beside the figures."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import pytest

from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_architecture

MS = 10**6
Derived = Callable[[str], Architecture]
_TWO = """
groups:
  g:
    components:
      a: {{outputs: {{out: std_msgs/msg/Empty}}}}
      b: {{outputs: {{out: std_msgs/msg/Empty}}}}
      c: {{inputs: {{one: a.out, two: b.out}}, outputs: {{out: std_msgs/msg/Empty}}}}
nodes:
  a: {{implements: a, timing: {{{a}}}}}
  b: {{implements: b, timing: {{{b}}}}}
  c: {{implements: c, timing: {{{c}}}}}
"""
_20 = "period: 20 ms, wcet: 1 ms, bcet: 1 ms"
_50 = "period: 50 ms, wcet: 1 ms, bcet: 1 ms"


def of_two(derived: Derived, c: str, a: str = _20, b: str = _50) -> Analysis:
    return analyse_architecture(derived(_TWO.format(a=a, b=b, c=c)))


def figures(value: TimingValue) -> tuple[Fraction | None, str, bool]:
    return value.value, value.side, value.complete


@pytest.mark.parametrize(
    ("timing", "rate", "gap"),
    [
        ("behaviour: event", 70, 20),  # any is what is meant where nothing is said
        ("trigger: any", 70, 20),
        ("trigger: all", 20, 50),
        ("trigger: [one]", 50, 20),
        ("trigger: [two]", 20, 50),
        ("trigger: {all: [one, two]}", 20, 50),
        ("trigger: [one], every: 3", Fraction(50, 3), 60),
        ("trigger: [one], throttle: 30 ms", 25, 50),  # each second of 20 ms; less than 30 + 20
        ("trigger: [one], throttle: 40 ms", 25, 60),
        ("period: 40 ms", 25, 40),
        ("rate: 25 Hz, jitter: 3 ms", 25, 43),
    ],
)
def test_one_behaviour_after_the_other(derived: Derived, timing: str, rate: Fraction, gap: int) -> None:
    pace = of_two(derived, timing).paces["c"]
    assert figures(pace.rate) == (rate, "exact", True)
    assert figures(pace.gap) == (gap * MS, "exact", True)


def test_an_output_comes_later_by_the_responses_spread(derived: Derived) -> None:
    found = of_two(derived, "trigger: [one], wcet: 7 ms, bcet: 2 ms", a="period: 20 ms, wcet: 4 ms, bcet: 1 ms")
    assert found.outputs["a", "g.a.out"].gap.value == 23 * MS
    assert found.outputs["c", "g.c.out"].gap.value == 28 * MS
    assert found.paces["c"].jitter.value == 3 * MS


def test_a_missing_execution_time_leaves_the_gap_open(derived: Derived) -> None:
    gap = of_two(derived, "trigger: [one]", a="period: 20 ms").paces["c"].gap
    assert (gap.value, gap.side, gap.missing) == (20 * MS, "at least", ("a",))


def test_any_of_with_an_unknown_input(derived: Derived) -> None:
    pace = of_two(derived, "trigger: any", b="wcet: 1 ms").paces["c"]
    assert (pace.rate.value, pace.rate.side, pace.rate.missing) == (50, "at least", ("b",))
    assert figures(pace.gap) == (20 * MS, "exact", True)


def test_all_of_with_an_unknown_input(derived: Derived) -> None:
    pace = of_two(derived, "trigger: all", b="wcet: 1 ms").paces["c"]
    assert (pace.rate.value, pace.rate.side, pace.rate.missing) == (50, "at most", ("b",))
    assert (pace.gap.value, pace.gap.missing) == (None, ("b",))


def test_what_is_sent_once_is_always_there(derived: Derived) -> None:
    assert of_two(derived, "trigger: all", b="behaviour: once").paces["c"].rate.value == 50
    any_of = of_two(derived, "trigger: any", b="behaviour: once").paces["c"]
    assert (any_of.rate.value, any_of.gap.value) == (50, 20 * MS)


def test_a_conditional_output_may_never_come(derived: Derived) -> None:
    conditional = _20 + ", outputs: {out: {conditional: true}}"
    pace = of_two(derived, "trigger: [one]", a=conditional).paces["c"]
    assert (pace.rate.value, pace.rate.side) == (50, "at most")
    assert (pace.gap.value, pace.gap.assumptions) == (None, ("unbounded",))
    promised = _20 + ", outputs: {out: {conditional: true, max_gap: 2 s}}"
    assert of_two(derived, "trigger: [one]", a=promised).paces["c"].gap.value == 2000 * MS


def test_two_topics_of_one_source_are_told_apart(derived: Derived) -> None:
    text = """
groups:
  g:
    components:
      a: {outputs: {left: std_msgs/msg/Empty, right: std_msgs/msg/Empty}}
      b: {inputs: {both: a}}
nodes:
  a: {implements: a, timing: {rate: 10 Hz}}
  b: {implements: b}
"""
    pace = analyse_architecture(derived(text)).paces["b"]
    assert pace.rate.value == 20
    assert [reason.text for reason in pace.reasons] == [
        "g.b.both brings 10 Hz from a on /g/a/left",
        "g.b.both brings 10 Hz from a on /g/a/right",
    ]


_SERVICE = """
groups:
  g:
    components:
      server: {outputs: {plan: nav_msgs/srv/GetPlan}}
      a: {inputs: {plan: server.plan}}
      b: {inputs: {plan: server.plan}}
nodes:
  server: {implements: server, timing: {wcet: 10 ms}}
  a: {implements: a, timing: {period: 100 ms, wcet: 5 ms, calls: {plan: 2}}}
  b: {implements: b, timing: {period: 200 ms, wcet: 5 ms}}
"""


def test_a_server_is_asked_as_often_as_its_callers_call(derived: Derived) -> None:
    found = analyse_architecture(derived(_SERVICE))
    pace = found.paces["server"]
    assert (pace.behaviour, pace.rate.value, pace.gap.value) == ("on_demand", 25, None)
    service = found.services["server"]
    assert (service.callers, service.worst.value) == (("a", "b"), 30 * MS)  # a may ask twice at once
    assert {name: value.value for name, value in service.synchronous_responses.items()} == {"a": 65 * MS, "b": 35 * MS}


def test_a_stated_rate_is_used_and_the_derived_one_kept(derived: Derived) -> None:
    found = of_two(derived, "behaviour: event, trigger: [one], rate: 10 Hz")
    assert (found.paces["c"].rate.value, found.paces["c"].inferred) == (10, False)
    assert found.derived["c"].rate.value == 50


_RING = """
groups:
  g:
    components:
      start: {{outputs: {{out: std_msgs/msg/Empty}}}}
      a: {{inputs: {{go: start.out, back: b.out}}, outputs: {{out: std_msgs/msg/Empty}}}}
      b: {{inputs: {{on: a.out}}, outputs: {{out: std_msgs/msg/Empty}}}}
nodes:
  start: {{implements: start, timing: {{period: 20 ms, wcet: 1 ms}}}}
  a: {{implements: a, timing: {{wcet: 1 ms, {a}}}}}
  b: {{implements: b, timing: {{wcet: 1 ms, {b}}}}}
"""


@pytest.mark.parametrize(
    ("a", "b", "endless", "deadlocked"),
    [
        ("behaviour: event", "behaviour: event", (("a", "b"),), ()),
        ("trigger: all", "behaviour: event", (), (("a", "b"),)),
        ("trigger: [go]", "behaviour: event", (), ()),
        ("behaviour: event", "period: 50 ms", (), ()),
        ("behaviour: event", "behaviour: event, every: 2", (), ()),
        ("behaviour: event", "behaviour: event, outputs: {out: {conditional: true}}", (), ()),
    ],
)
def test_rings(derived: Derived, a: str, b: str, endless: object, deadlocked: object) -> None:
    found = analyse_architecture(derived(_RING.format(a=a, b=b)))
    assert (found.endless, found.deadlocked) == (endless, deadlocked)


def test_all_of_waits_for_ever_for_an_input_that_nothing_feeds(derived: Derived) -> None:
    found = of_two(derived, "trigger: all")
    assert found.deadlocked == ()
    text = _TWO.format(a=_20, b=_50, c="trigger: all").replace("two: b.out", "two: ~")
    found = analyse_architecture(derived(text))
    assert found.deadlocked == (("c",),)
    assert found.paces["c"].rate.value == 0


def test_the_reasons_name_the_places(derived: Derived) -> None:
    pace = of_two(derived, "trigger: [one], every: 2").paces["c"]
    assert [f"{reason.text} ({reason.at.line})" for reason in pace.reasons] == [
        "g.c.one brings 50 Hz from a, at most 20 ms apart (7)",
        "one in 2 fires it (11)",
    ]


def test_a_node_of_two_components_has_two_activities(derived: Derived) -> None:
    text = (
        _TWO.format(a=_20, b=_50, c="trigger: [one]")
        .replace("  b: {implements: b, timing: {" + _50 + "}}\n", "")
        .replace("implements: a, timing: {" + _20 + "}", "implements: [a, b], timing: {" + _20 + "}")
    )
    found = analyse_architecture(derived(text))
    assert list(found.paces) == ["a.a", "a.b", "c"]
    assert found.paces["c"].rate.value == 50


def test_who_is_asked_publishes_for_it_too(derived: Derived) -> None:
    text = """
groups:
  g:
    components:
      eye: {outputs: {seen: {type: Seen}}, timing: {period: 20 ms}}
      mind: {inputs: {seen: eye.seen}, outputs: {told: {type: Seen}, serve: {type: Ask}}}
      asker: {inputs: {ask: mind.serve}, timing: {period: 50 ms}}
types: {Seen: {message: std_msgs/msg/Empty}, Ask: {message: std_srvs/srv/Empty}}
"""
    found = analyse_architecture(derived(text))
    mind = next(name for name in found.paces if "mind" in name)
    assert found.paces[mind].rate.value == 50 + 20
    assert found.outputs[mind, "g.mind.told"].rate.value == 50 + 20
