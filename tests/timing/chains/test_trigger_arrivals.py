"""What arrives at triggers: what they let wait, what else fires a reader, and how old a sample is when it is used."""

from __future__ import annotations

import pytest

from archgen.timing.chains.step_delays import StepDelays
from archgen.timing.chains.trigger_arrivals import TriggerArrivals
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.printed import show_ms
from tests.timing.random_systems import architecture
from tests.timing.sketches import analyse_sketch

SOURCES = {
    "a": "period: 10 ms, wcet: 1 ms, bcet: 1 ms",
    "loose": "period: 10 ms, jitter: 2 ms, wcet: 1 ms, bcet: 1 ms",
    "slow": "period: 30 ms, wcet: 1 ms, bcet: 1 ms",
    "dark": "period: 10 ms",
    "start": "behaviour: once, wcet: 1 ms",
}


@pytest.mark.parametrize(
    ("timing", "wires", "wait"),
    [
        ("", "a>r", "0"),
        ("jitter: 4 ms", "a>r", "4"),
        ("period: 7 ms, jitter: 4 ms", "a>r", "0"),
        # Every third waits for two more, and starts late by its jitter.
        ("every: 3", "a>r", "20"),
        ("every: 3, jitter: 4 ms", "a>r", "24"),
        # What comes most often fires any-of; what comes most seldom fires all-of.
        ("every: 2", "a>r slow>r", "10"),
        ("trigger: {all: [a, slow]}, every: 2", "a>r slow>r", "30"),
        # What is sent once and kept is always there, and brings nothing any more.
        ("trigger: {all: [slow, start]}, every: 2", "slow>r start>r", "30"),
        ("every: 2", "slow>r start>r", "30"),
        # A throttle's time, and n gaps; what waits came the smallest gap after the last firing.
        ("throttle: 25 ms", "a>r", "25"),
        ("throttle: 25 ms, every: 2", "a>r", "35"),
        ("throttle: 25 ms, jitter: 4 ms", "a>r", "29"),
        # 12 = 10 + 2 is the largest gap, 8 = 10 - 2 the smallest one: 12 + 25 - 8.
        ("throttle: 25 ms", "loose>r", "29"),
        # Of two streams nobody knows how close they come: 10 + 25.
        ("throttle: 25 ms", "a>r slow>r", "35"),
        # Without an execution time it is not known how late `dark` sends: 10 and 10 + 25 are the least.
        ("every: 2", "dark>r", ">= 10 ?dark"),
        ("throttle: 25 ms", "dark>r", ">= 35 ?dark"),
        # Something outside may come at any time, or never: it is no bound, and does not take away that of another.
        ("behaviour: event, trigger: [sky], every: 2", "sky>r", ">= none ?r"),
        ("trigger: [sky, a], every: 2", "sky>r a>r", "10"),
        ("trigger: {all: [sky, a]}, every: 2", "sky>r a>r", ">= none ?r"),
    ],
)
def test_how_long_a_trigger_waits_for_its_reader_to_fire(timing: str, wires: str, wait: str) -> None:
    analysis = analyse_sketch({**SOURCES, "r": timing and f"{timing}, wcet: 1 ms"}, wires)
    assert show_ms(TriggerArrivals(analysis).thinning_wait(analysis.system.activities["r"])) == wait


@pytest.mark.parametrize(
    ("latency", "wait"),
    [
        # 3 between best and worst: gaps between 10 - 3 and 10 + 3, so that 13 + 25 - 7.
        ("{best: 1 ms, worst: 4 ms}", "31"),
        ("{worst: 3 ms}", "31"),
        ("3 ms", "25"),
        # 10 between them: two may come at once, 20 + 25 - 0; and so with 11: 21 + 25.
        ("{best: 1 ms, worst: 11 ms}", "45"),
        ("{best: 1 ms, worst: 12 ms}", "46"),
        # Between best and unknown there may be any time: 10 + 25 is the least.
        ("{best: 1 ms}", ">= 35 ?lan"),
    ],
)
def test_a_link_spreads_what_arrives_at_a_throttle(latency: str, wait: str) -> None:
    hosts = f"hosts: {{p: {{cores: 1}}, q: {{cores: 1}}}}\nlinks: {{lan: {{connects: [p, q], latency: {latency}}}}}"
    analysis = analyse_sketch({"a @p": SOURCES["a"], "r @q": "throttle: 25 ms, wcet: 1 ms"}, "a>r", hosts)
    assert show_ms(TriggerArrivals(analysis).thinning_wait(analysis.system.activities["r"])) == wait


@pytest.mark.parametrize(
    ("timing", "wires", "age"),
    [
        # Fired by this alone, a sample is used at once; a clock may use it until the next one comes.
        ("", "a>r", "0"),
        ("period: 5 ms", "a>r", "10"),
        # Any-of: another trigger, a call or something outside sends on what came last.
        ("trigger: [a]", "a>r slow>r", "0"),
        ("", "a>r slow>r", "10"),
        ("trigger: [a, sky]", "a>r sky>r", "10"),
        ("behaviour: event", "a>r caller?r", "10"),
        # Something outside that is read, but does not fire, changes nothing.
        ("trigger: [a]", "a>r sky>r", "0"),
        ("jitter: 4 ms", "a>r", "4"),
        ("jitter: 4 ms", "a>r slow>r", "14"),
        # All-of: no older than the wait for the other trigger, nor than the gap of its output.
        ("trigger: {all: [a, loose]}", "a>r loose>r", "10"),
        ("trigger: {all: [a, slow]}", "a>r slow>r", "10"),
        ("trigger: {all: [a]}", "a>r", "0"),
        # What is sent once may come last, when a sample has waited for it.
        ("trigger: {all: [a, start]}", "a>r start>r", "10"),
        # A call finds the set that came last together: both add up, 10 + 30.
        ("behaviour: event, trigger: {all: [a, slow]}", "a>r slow>r caller?r", "40"),
    ],
)
def test_how_old_a_sample_is_when_it_is_used(timing: str, wires: str, age: str) -> None:
    nodes = {**SOURCES, "r": timing and f"{timing}, wcet: 1 ms", "caller": "period: 70 ms, wcet: 1 ms"}
    analysis = analyse_sketch(nodes, wires)
    arc = next(arc for arc in analysis.system.arcs if (arc.source, arc.target, arc.role) == ("a", "r", "data"))
    assert show_ms(StepDelays.of_analysis(analysis).holding_age(arc)) == age


@pytest.mark.parametrize(
    ("places", "links", "names"),
    [
        (("@p", "@q"), "lan: {connects: [p, q], latency: {best: 1 ms}}", ("lan",)),
        (("@p", "@q"), "", ("p - q",)),
        (("@p", ""), "", ("r",)),
        (("", "@q"), "", ("a",)),
    ],
)
def test_what_is_missing_where_a_latency_is_unknown(places: tuple[str, str], links: str, names: tuple[str]) -> None:
    hosts = f"hosts: {{p: {{cores: 1}}, q: {{cores: 1}}}}\nlinks: {{{links}}}"
    a, r = (f"{name} {place}".strip() for name, place in zip("ar", places, strict=True))
    analysis = analyse_sketch({a: SOURCES["a"], r: "wcet: 1 ms"}, "a>r", hosts)
    assert TriggerArrivals(analysis).missing_link_names(analysis.system.arcs[0]) == names


@pytest.mark.parametrize(
    "wires",
    [
        "a>r",
        "a>r slow>r",  # an input of its own
        "a>r caller?r",  # a call is no message
    ],
)
def test_one_source_has_its_input_to_itself(wires: str) -> None:
    nodes = {**SOURCES, "r": "", "caller": "period: 70 ms, wcet: 1 ms"}
    arrivals = TriggerArrivals(analyse_sketch(nodes, wires))
    arc = next(arc for arc in arrivals.analysis.system.arcs if (arc.source, arc.target) == ("a", "r"))
    assert not arrivals.shares_input(arc)


def test_two_sources_of_one_input_share_it() -> None:
    both = architecture(
        "groups: {g: {components: {a: {outputs: {x: std_msgs/msg/String}}, b: {outputs: {x: std_msgs/msg/String}}, "
        "r: {inputs: {x: [a.x, b.x], y: a.x}}}}}"
    )
    arrivals = TriggerArrivals(analyse_architecture(both))
    shares = {(arc.source, arc.input): arrivals.shares_input(arc) for arc in arrivals.analysis.system.arcs}
    assert {key: shares[key] for key in sorted(shares)} == {
        ("a", "g.r.x"): True,
        ("a", "g.r.y"): False,
        ("b", "g.r.x"): True,
    }
