"""Three sentences on chains that are not met: what they say follows from the largest part, and nothing is tried out."""

from __future__ import annotations

import pytest

from archgen.timing.chains.chain_advice import advise_on_chain
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
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
            "Let s work more often (`period:`, now every 100 ms at the latest).",
        ),
        (
            {"s @p": SENSOR, "r @p": "behaviour: periodic, period: 300 ms, wcet: 2 ms, bcet: 2 ms"},
            "50 ms",
            "It may take up to ",
            "The largest parts: 305 ms that r lets it wait (reads /g/s/out every 300 ms at the latest, which may wait 5 ms to be stored); 100 ms that s",
            "Let r work more often (`period:`, now every 300 ms at the latest), or let what it reads fire it (`trigger:`).",
        ),
        (
            {"s @p": SENSOR, "r @p": FIRED},
            "3 ms",
            "It takes at least 7 ms, 4 ms longer than its deadline of 3 ms allows.",
            "The largest parts: 100 ms",
            "Let s work more often",
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
            "Let r drop less of what fires it (`throttle:`).",
        ),
        (
            {"s @p": "behaviour: periodic, period: 10 ms, wcet: 1 ms", "r @q": "behaviour: event, response: 40 ms"},
            "20 ms",
            "It may take up to ",
            "The largest parts: 40 ms in r, as its `response` declares; 10 ms that s lets it wait",
            "Shorten r, and what its `response:` declares.",
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


@pytest.mark.parametrize(
    ("reader", "cores", "first_step"),
    [
        ("wcet: 1 ms", 1, "Give r a priority above the others there (`priority:`), or move work off p (`host:`)."),
        ("wcet: 1 ms, core: 0", 2, "Give r a priority above the others there (`priority:`), or pin it to a core with less on it"),
        ("wcet: 1 ms, priority: 3", 1, "Give r a higher priority (`priority:`, now 3), or move work off p (`host:`)."),
        ("wcet: 25 ms", 1, "Shorten r (`wcet:`, 25 ms), measured if it is a guess: its own work is most of it."),
    ],
)  # fmt: skip
def test_who_waits_for_others_gets_a_priority_and_who_works_long_is_shortened(
    reader: str, cores: int, first_step: str
) -> None:
    nodes = {
        "s @q": "behaviour: event, period: 50 ms, wcet: 1 us",
        "r @p": f"behaviour: event, {reader}",
        "slow @p": f"behaviour: periodic, period: 1 s, wcet: {20 if 'wcet: 25' in reader else 80} ms, core: 0, priority: 5",
    }
    rest = f"hosts: {{p: {{cores: {cores}}}, q: {{cores: 1}}}}\nlinks: {{lan: {{connects: [p, q], latency: 0 ms}}}}"
    said = advise(nodes, "x>s s>r", rest, "1 ms")
    assert said[2].startswith(first_step)
    assert said[1].startswith("The largest part")


@pytest.mark.parametrize(
    ("place", "reader", "cores", "first_step"),
    [
        ("@p", "", 1, "Give r a higher priority than the others there (`priority:`), or move work off p (`host:`), so that what"),
        ("@p", ", core: 0", 2, "Give r a higher priority than the others there (`priority:`), or a core of its own (`core:`), so"),
        ("@p", "", 2, "Give r a core of its own (`core:`), or a priority above the others there (`priority:`), so that what it"),
        ("+box", "", 1, "Let fewer callbacks share a thread with r (a container of its own, or more `threads:`), so that what"),
    ],
)  # fmt: skip
def test_where_most_of_a_wait_is_for_being_stored_that_is_what_to_change(
    place: str, reader: str, cores: int, first_step: str
) -> None:
    slow = "behaviour: periodic, period: 1 s, wcet: 300 ms"
    nodes = {
        "s @q": "behaviour: periodic, period: 20 ms, wcet: 1 ms",
        f"r {place}": f"behaviour: periodic, period: 40 ms, wcet: 1 ms{reader}",
        f"slow {place}": f"{slow}{reader}",
    }
    if cores > 1 and not reader:
        nodes |= {"more @p": slow, "most @p": slow}
    rest = f"hosts: {{p: {{cores: {cores}}}, q: {{cores: 1}}}}\nlinks: {{lan: {{connects: [p, q], latency: 0 ms}}}}"
    box = "\ncontainers: {box: {host: p, threads: 1}}" if place == "+box" else ""
    said = advise(nodes, "s>r", f"{rest}{box}", "2 ms")
    assert "that r lets it wait (reads /g/s/out every 40 ms at the latest, which may wait " in said[1].partition(";")[0]
    assert said[2].startswith(first_step)
    assert said[2].endswith("is stored sooner; `stored: at_once` only where nothing has to store it.")


def test_a_run_on_several_cores_that_others_hold_up_needs_cores_of_its_own() -> None:
    nodes = {"s @q": "period: 500 ms, wcet: 1 ms", "a @p": "wcet: 20 ms", "r @p": "wcet: 10 ms"}
    nodes |= {f"o{number} @p": "period: 500 ms, wcet: 100 ms" for number in range(6)}
    rest = "hosts: {p: {cores: 2}, q: {cores: 1}}\nlinks: {lan: {connects: [p, q], latency: 0 ms}}"
    said = advise(nodes, "s>a a>r", rest, "2 ms", "a, r")
    assert said[1].startswith("The largest parts: 375 ms in a, which needs 20 ms itself; the rest is other work on p")
    assert said[2] == (
        "Give a and r, which run one after the other, cores of p with little else on them (`core:`), "
        "or a priority above the others there (`priority:`)."
    )
