"""What takes no time waits all the same: where one busy period ends as the next begins, it may wait for both."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.property_sizes import try_some
from tests.timing.exceeded import exceeded
from tests.timing.random_styles import random_style_text
from tests.timing.random_systems import random_text
from tests.timing.random_threads import random_threads_text
from tests.timing.random_zeros import take_no_time
from tests.timing.sketches import analyse_sketch, list_chains, read_sketch, sketch

MS = 10**6
BUSY = {"x @h": "period: 2 ms, wcet: 1 ms", "y @h": "period: 10 ms, wcet: 1 ms"}
"""Both are done after 2 ms, and x comes again at that very instant; after 3 ms nothing is left."""


@pytest.mark.parametrize(
    ("nodes", "wires", "host", "response"),
    [
        ({**BUSY, "z @h": "period: 8 ms, wcet: 0 ms"}, "", "cores: 1", 3),
        ({**BUSY, "z @h": "period: 8 ms, wcet: 1 us"}, "", "cores: 1", 3.001),
        # Fired inside the core; each cascade is whole.
        ({**BUSY, "s @h": "period: 8 ms, wcet: 0 ms", "z @h": "wcet: 0 ms"}, "s>z", "cores: 1", 3),
        (
            {
                "x @h": "period: 2 ms, wcet: 1 ms, priority: 9",
                "y @h": "period: 10 ms, wcet: 1 ms, priority: 5",
                "z @h": "period: 8 ms, wcet: 0 ms, priority: 2",
            },
            "",
            "cores: 1",
            3,
        ),
        # Whatever comes last is done; nothing says that z has had its turn by then.
        (
            {"x @h": "period: 2 ms, wcet: 2 ms, priority: 9", "z @h": "period: 8 ms, wcet: 0 ms, priority: 2"},
            "",
            "cores: 1",
            None,
        ),
        # The deadline of x is before that of z, and that of y is after it.
        ({**BUSY, "z @h": "period: 8 ms, wcet: 0 ms"}, "", "cores: 1, scheduling: edf", 1),
        ({"x @h": "period: 2 ms, wcet: 2 ms", "z @h": "period: 8 ms, wcet: 0 ms"}, "", "cores: 1", None),
        # On its own, at once.
        ({"z @h": "period: 8 ms, wcet: 0 ms"}, "", "cores: 1", 0),
    ],
)
def test_what_takes_no_time_waits_until_nothing_else_does(
    nodes: dict[str, str], wires: str, host: str, response: float | None
) -> None:
    analysis = analyse_sketch(nodes, wires, f"hosts: {{h: {{{host}}}}}")
    worst = analysis.responses["z"].worst.value
    assert (None if worst is None else float(worst / MS)) == response
    assert exceeded(sketch(nodes, wires, f"hosts: {{h: {{{host}}}}}"))[0] == []


@pytest.mark.parametrize(
    ("other_wcet", "wait"),
    [("1 ms", ", which may wait 3 ms to be stored"), ("999 us", ", which may wait 1.999 ms to be stored")],
)
def test_a_message_waits_to_be_stored_where_one_busy_period_follows_another(other_wcet: str, wait: str) -> None:
    nodes = {
        "x @h": "period: 2 ms, wcet: 1 ms",
        "y @h": f"period: 20 ms, wcet: {other_wcet}",
        "src": "period: 20 ms, wcet: 1 ms",
        "z @h": "period: 20 ms, wcet: 0 ms",
    }
    rest = "hosts: {h: {cores: 1}, far: {cores: 1}}\nlinks: {lan: {connects: [h, far], latency: 0 ms}}\nchains: {c: {through: [src, z]}}"
    nodes = {"src @far" if head == "src" else head: timing for head, timing in nodes.items()}
    lines = list_chains(analyse_sketch(nodes, "src>z", rest), read_sketch(nodes, "src>z", rest))
    assert [line for line in lines if "stored" in line and wait in line], lines


def test_what_another_source_of_an_input_completes_may_be_older() -> None:
    """`slow` and `quick` write one input: `quick` and `other` fire `all2` again with what `slow` sent last."""
    nodes = {
        "slow @h": "period: 100 ms, wcet: 0 ms, bcet: 0 ms",
        "quick @h": "period: 10 ms, wcet: 0 ms, bcet: 0 ms",
        "other @h": "period: 10 ms, wcet: 0 ms, bcet: 0 ms",
    }
    text = sketch(nodes, "", "hosts: {h: {cores: 1}}\nchains: {c: {through: [g.slow, g.all2]}}")
    reader = "      all2: {inputs: {both: [g.slow.out, g.quick.out], other: g.other.out}, outputs: {out: Data}}\nnodes:\n  all2: {implements: g.all2, host: h, timing: {trigger: all, wcet: 0 ms}}\n"
    assert exceeded(text.replace("nodes:\n", reader))[0] == []


@pytest.mark.parametrize("make_text", [random_text, random_style_text, random_threads_text])
@pytest.mark.parametrize("first", try_some(range(0, 300, 10), 1, 10))
def test_no_simulation_exceeds_a_bound_where_some_take_no_time(make_text: Callable[[int], str], first: int) -> None:
    found = {
        seed: exceeded(take_no_time(make_text(seed), seed), seconds=1, seeds=4) for seed in range(first, first + 10)
    }
    assert {seed: wrong for seed, (wrong, _) in found.items() if wrong} == {}
    assert sum(held for _, held in found.values()) > 40
