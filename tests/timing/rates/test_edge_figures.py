"""Producers and consumers: loss, rereads, beat and queue of each kind of reader."""

from __future__ import annotations

import pytest

from archgen.timing.run_analysis import analyse_architecture, analyse_for_chains
from tests.timing.printed import show
from tests.timing.random_systems import architecture
from tests.timing.sketches import analyse_sketch, list_edges


def test_readers_that_poll() -> None:
    """Reads / sent: 10 of 100 Hz lose 9 in 10, 100 of 40 Hz read 2.5 times. The beat is 1 / |fast - n slow|: 30 and 101 Hz slip by
    |101 - 3 x 30| = 11 Hz. A queue holds what comes in a gap and a response.
    """
    analysis = analyse_sketch(
        {
            "fast": "rate: 101 Hz, wcet: 0 ms, bcet: 0 ms",
            "thirty": "rate: 30 Hz, wcet: 0 ms, bcet: 0 ms",
            "same": "period: 10 ms, wcet: 1 ms",
            "ten": "period: 100 ms, wcet: 3 ms",
            "hundred": "period: 10 ms, wcet: 0 ms, bcet: 0 ms",
            "forty": "period: 25 ms, wcet: 0 ms, bcet: 0 ms",
            "dark": "",
            "start": "behaviour: once",
            "sometimes": "period: 10 ms, wcet: 0 ms, outputs: {out: {conditional: true}}",
            "rare": "period: 40 ms, wcet: 1 ms",
            "never": "trigger: {all: [never]}, wcet: 1 ms",
            "heavy @pc": "period: 10 ms, wcet: 11 ms",
        },
        "fast>thirty thirty>fast hundred>same hundred>ten forty>hundred dark>ten start>ten sometimes>rare never>ten never>never hundred>dark hundred>start heavy>ten hundred>heavy",
        "hosts: {pc: {cores: 1}}",
    )
    assert list_edges(analysis) == [
        "fast>thirty: loss 71/101, rereads 1, beat 1000/11, queue 4",
        "thirty>fast: loss 0, rereads 101/30, beat 1000/11, queue 1",
        "hundred>same: loss 0, rereads 1, beat 0, queue 2",
        "hundred>ten: loss 9/10, rereads 1, beat 0, queue 11",
        "hundred>dark: loss 0, rereads 1, beat 0, queue none ?dark",
        "hundred>start: loss 1, rereads 1, beat 0, queue none ?start [unbounded]",
        "hundred>heavy: loss 0, rereads 1, beat 0, queue none ?hundred,heavy [no link joins their hosts]",
        "dark>ten: loss 9/10, rereads 1, beat 0, queue none ?dark",
        "start>ten: loss 0, rereads 1, beat 0, queue 1",
        "never>ten: loss 0 [never fires], rereads 1 [never fires], beat 0, queue 0",
        "never>never: loss 0, rereads 1, beat 0, queue 0",
        "heavy>ten: loss 9/10, rereads 1, beat 0, queue none [unbounded]",
        "forty>hundred: loss 0, rereads 5/2, beat 50, queue 1",
        "sometimes>rare: loss 3/4 [conditional: between none and this], rereads 1 [conditional: between none and this], beat 0, queue 5",
    ]


def test_equal_rates_lose_nothing_as_far_as_they_are_sure() -> None:
    """100 Hz read at 100 Hz. Where one of both is only an upper bound, the figures rest on what it assumes."""
    analysis = analyse_sketch(
        {
            "sure": "period: 10 ms, wcet: 0 ms, bcet: 0 ms",
            "rare": "period: 10 ms, wcet: 0 ms, bcet: 0 ms, outputs: {out: {conditional: true}}",
            "poll": "period: 10 ms, wcet: 0 ms",
            "both": "trigger: {all: [rare, sure]}, wcet: 0 ms",
        },
        "sure>poll rare>poll sure>both rare>both",
    )
    assert list_edges(analysis) == [
        "sure>poll: loss 0, rereads 1, beat 0, queue 1",
        "sure>both: loss 0 [conditional: between none and this], rereads 1 [conditional: between none and this], beat 0, queue none [unbounded; assuming a dedicated core]",
        "rare>poll: loss 0 [conditional: between none and this], rereads 1 [conditional: between none and this], beat 0, queue 1",
        "rare>both: loss 0 [conditional: between none and this], rereads 1 [conditional: between none and this], beat 0, queue none [unbounded; assuming a dedicated core]",
    ]


def test_what_only_is_read_is_no_part_of_what_a_throttle_leaves_out() -> None:
    """Of 100 Hz each third fires, for 25 > 2 x 10; the 200 Hz that are read along fire nothing."""
    analysis = analyse_sketch(
        {
            "a": "period: 10 ms, wcet: 0 ms, bcet: 0 ms",
            "b": "period: 5 ms, wcet: 0 ms, bcet: 0 ms",
            "r": "trigger: [a], throttle: 25 ms, wcet: 0 ms",
        },
        "a>r b>r",
    )
    assert [show(fit.loss) for fit in analysis.edges] == ["2/3", "5/6"]


def test_nothing_is_said_of_rates_without_a_bound() -> None:
    """A ring that runs for ever has no rate; neither has, to be compared, what reads it as often."""
    analysis = analyse_sketch(
        {"s": "period: 10 ms, wcet: 1 ms", "a": "wcet: 1 ms", "poll": "period: 20 ms, wcet: 1 ms"}, "s>a a>a a>poll"
    )
    assert [line for line in list_edges(analysis) if line.startswith("a>poll")] == [
        "a>poll: loss none [unbounded], rereads none [unbounded], beat none [unbounded], queue none ?a [a ring of triggers]"
    ]


@pytest.mark.parametrize(
    ("timing", "qos", "judged"),
    [
        # Rules look at queues that somebody asked for, where they are read in one go or message by message ...
        ("period: 20 ms", "depth: 5", "a"),
        ("period: 20 ms", "", ""),
        ("trigger: [a]", "depth: 5", "a"),
        ("trigger: [a]", "", ""),
        # (ten is what everybody has),
        ("period: 20 ms", "depth: 10", ""),
        ("period: 20 ms", "reliability: best_effort", ""),
        # ... not at those that are read along, or that only some other event empties.
        ("trigger: [b]", "depth: 5", ""),
        # All-of loses what has no partner, however long its queues are.
        ("trigger: {all: [a, b]}", "", "a b"),
        ("trigger: {all: [a, b]}", "depth: 5", "a b"),
        ("trigger: {all: [b]}", "", "b"),
        ("trigger: {all: [b]}", "depth: 5", "b"),
    ],
)
def test_rules_look_at_written_queues_and_at_all_of(timing: str, qos: str, judged: str) -> None:
    queue = qos and f", subscribes: {{a: {{qos: {{{qos}}}}}}}"
    text = f"""
groups: {{g: {{components: {{a: {{outputs: {{out: Data}}}}, b: {{outputs: {{out: Data}}}}, r: {{inputs: {{a: a.out, b: b.out}}}}}}}}}}
nodes:
  a: {{implements: a, timing: {{period: 10 ms}}}}
  b: {{implements: b, timing: {{period: 10 ms}}}}
  r: {{implements: r, timing: {{{timing}}}{queue}}}
types: {{Data: {{message: std_msgs/msg/String, size: 1 kB}}}}
"""
    model = architecture(text)
    assert " ".join(fit.arc.source for fit in analyse_for_chains(model).edges) == judged
    assert " ".join(fit.arc.source for fit in analyse_architecture(model).edges) == "a b"


@pytest.mark.parametrize(
    ("more", "wires", "loss"),
    [
        # What never fires loses nothing; of what comes without a bound, or is called without a bound, nothing is known.
        ({"s": "trigger: {all: [s]}"}, "s>s s>r", "0"),
        ({"s": "wcet: 0 ms", "t": "period: 10 ms"}, "t>s s>s s>r", "none [unbounded]"),
        (
            {"s": "period: 10 ms, wcet: 0 ms, bcet: 0 ms", "ring": "behaviour: event, wcet: 0 ms"},
            "s>ring ring>ring ring?r s>r",
            "none [what fires it is taken to come regularly; unbounded]",
        ),
    ],
)
def test_what_a_throttle_leaves_out_of_what_has_no_rate(more: dict[str, str], wires: str, loss: str) -> None:
    reader = {"r": "behaviour: event, trigger: [s], throttle: 25 ms, wcet: 0 ms"}
    edges = analyse_sketch({**more, **reader}, wires).edges
    assert [show(fit.loss) for fit in edges if (fit.arc.source, fit.arc.target) == ("s", "r")] == [loss]
