"""Sentences on chains that are not met: by how much, the largest parts, and what is missing; nothing is tried out, or advised."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.chains.chain_advice import _write_least, advise_on_chain
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from archgen.views.short_figures import shorten_text
from tests.timing.random_systems import architecture
from tests.timing.sketches import sketch

SENSOR = "behaviour: periodic, period: 100 ms, wcet: 5 ms, bcet: 5 ms"
FIRED = "behaviour: event, wcet: 2 ms, bcet: 2 ms"


def advise(nodes: dict[str, str], wires: str, rest: str, deadline: str = "50 ms", through: str = "s, r") -> list[str]:
    """Return what is said of the chain `c`."""
    text = sketch(nodes, wires, f"{rest}\nchains: {{c: {{through: [{through}], deadline: {deadline}}}}}")
    model = architecture(text)
    analysis = analyse_architecture(model)
    advice = advise_on_chain(analysis, bound_all_chains(analysis, model)["c"])
    return list(advice or ())


@pytest.mark.parametrize(
    ("nodes", "deadline", "lateness", "largest", "first_step"),
    [
        (
            {"s @p": SENSOR, "r @p": FIRED},
            "50 ms",
            "It may take up to 107 ms, 57 ms longer than its deadline of 50 ms allows; nothing shows that it ever does.",
            "The largest parts: 100 ms that s lets it wait (samples the world every 100 ms at the latest); 7 ms in s, which needs 5 ms itself; the rest",
            "",
        ),
        (
            {"s @p": SENSOR, "r @p": "behaviour: periodic, period: 300 ms, wcet: 2 ms, bcet: 2 ms"},
            "50 ms",
            "It may take up to ",
            "The largest parts: 305 ms that r lets it wait (reads /g/s/out every 300 ms at the latest, which may wait 5 ms to be stored); 100 ms that s",
            "",
        ),
        (
            {"s @p": SENSOR, "r @p": FIRED},
            "3 ms",
            "It takes at least 7 ms, 4 ms longer than its deadline of 3 ms allows.",
            "The largest parts: 100 ms",
            "",
        ),
        (
            {"s @p": "behaviour: periodic, period: 4 ms, wcet: 5 ms", "r @p": FIRED},
            "50 ms",
            "It may take any time, whatever its deadline: more is to be done on p than can be.",
            "The largest part: 4 ms that s lets it wait",
            "Take work off p, where s (125 % of a core) and r (50 % of a core) need most.",
        ),
        (
            {"s @p": "behaviour: periodic, period: 10 ms, wcet: 1 ms", "r @q": "behaviour: event"},
            "50 ms",
            "What is known of it adds up to ",
            "The largest parts: 10 ms",
            "Measure the execution time of r and write it (`wcet:`)",
        ),
        (
            {"s @p": "behaviour: periodic, period: 10 ms, wcet: 1 ms", "r @q": "behaviour: event, wcet: 40 ms, throttle: 50 ms"},
            "20 ms",
            "It may take up to ",
            "The largest parts: 52 ms that r lets it wait (triggered by /g/s/out; keeps a smallest gap); 40 ms in r, all",
            "",
        ),
        (
            {"s @p": "behaviour: periodic, period: 10 ms, wcet: 1 ms", "r @q": "behaviour: event, response: 40 ms"},
            "20 ms",
            "It may take up to ",
            "The largest parts: 40 ms in r, as its `response` declares; 10 ms that s lets it wait",
            "",
        ),
        (
            {"s @p": "behaviour: periodic, period: 1 s, wcet: 1 ms", "r @q": "behaviour: event, wcet: 1 ms"},
            "2 s",
            "",
            "",
            "",
        ),
    ],
)  # fmt: skip
def test_the_sentences_follow_from_the_largest_part(
    nodes: dict[str, str], deadline: str, lateness: str, largest: str, first_step: str
) -> None:
    rest = "hosts: {p: {cores: 1}, q: {cores: 1}}\nlinks: {lan: {connects: [p, q], latency: 0 ms}}"
    said = advise(nodes, "s>r", rest, deadline)
    assert len(said) == (3 if lateness else 0)
    for sentence, expected in zip(said, (lateness, largest, first_step), strict=False):
        assert sentence.startswith(expected)
    # Nothing is advised that was not analysed.
    assert not first_step or said[2]
    assert first_step or not any(said[2:])


def test_what_is_known_stays_true_where_it_is_shown_with_fewer_digits() -> None:
    assert shorten_text(f"What is known of it adds up to {_write_least(Fraction(31_946_000_000))}") == (
        "What is known of it adds up to >= 31.9 s"
    )
    assert _write_least(Fraction(31_999_999_999)) == ">= 31.9 s"
    assert _write_least(Fraction(31_946_000_000)) == ">= 31.946 s"
