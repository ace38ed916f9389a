"""The unit in which durations are whole numbers."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from archgen.model.architecture import Architecture
from archgen.model.declared_timing import Timing
from archgen.model.quantity import Quantity
from archgen.timing.figures.tick_unit import TickUnit, choose_tick_unit, written_period
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.random_systems import architecture

_PROJECT = """
groups: {{g: {{components: {{a: {{outputs: {{out: std_msgs/msg/Empty}}}}, b: {{inputs: {{i: a.out}}}}}}}}}}
nodes:
  a: {{implements: a, host: p, container: box, timing: {{{a}}}}}
  b: {{implements: b, host: q, timing: {{period: 100 ms}}}}
containers: {{box: {{{box}}}}}
hosts: {{p: {{{p}}}, q: {{}}}}
links: {{lan: {{connects: [p, q], {link}}}}}
"""


@pytest.mark.parametrize(
    ("a", "link", "tick"),
    [
        ("", "latency: 0 ms", 10**8),
        ("period: 40 ms", "latency: 0 ms", 2 * 10**7),
        ("jitter: 30 ms", "latency: 0 ms", 10**7),
        ("wcet: 3 ms", "latency: 0 ms", 10**6),
        ("bcet: 3 ms, wcet: 5 ms", "latency: 0 ms", 10**6),
        ("throttle: 25 ms", "latency: 0 ms", 25 * 10**6),
        ("response: 250 us", "latency: 0 ms", 250_000),
        ("outputs: {out: {conditional: true, max_gap: 150 ms}}", "latency: 0 ms", 5 * 10**7),
        ("rate: 30 Hz", "latency: 0 ms", Fraction(10**8, 3)),
        ("", "latency: {best: 1 us, worst: 1 ms}", 1000),
        ("", "latency: {best: 10 ms, worst: 15 ms}", 5 * 10**6),
        ("", "latency: 0 ms, bandwidth: 8 Mbit/s", 1000),  # a byte takes 1 us
        ("", "latency: 0 ms, bandwidth: 24 Mbit/s", Fraction(1000, 3)),
    ],
)
def test_the_unit_measures_all_durations(a: str, link: str, tick: Fraction) -> None:
    unit = choose_tick_unit(architecture(_PROJECT.format(a=a, link=link, box="threads: 1", p="cores: 1")))
    assert (unit.tick, unit.exact) == (tick, True)


@pytest.mark.parametrize(
    ("box", "p", "divisor"),
    [
        ("threads: 1", "cores: 3", 3),
        ("threads: 2", "cores: 3", 6),
        ("threads: 2", "cores: 4", 4),
        ("threads: 5", "", 5),
    ],
)
def test_the_unit_can_be_divided_by_cores_and_threads(box: str, p: str, divisor: int) -> None:
    unit = choose_tick_unit(architecture(_PROJECT.format(a="", link="latency: 0 ms", box=box, p=p)))
    assert unit.tick == Fraction(10**8, divisor)


def test_a_project_without_durations_has_a_unit_too() -> None:
    text = "groups: {g: {components: {a: {outputs: {out: std_msgs/msg/Empty}}}}}\n"
    assert choose_tick_unit(architecture(text)) == TickUnit(Fraction(1))


def test_without_a_common_unit_durations_are_rounded_up() -> None:
    unit = TickUnit(Fraction(3), exact=False)
    assert [unit.ns_to_ticks(Fraction(ns)) for ns in (0, 1, 3, 4)] == [0, 1, 1, 2]
    assert unit.ns_to_ticks(Fraction(7, 2)) == 2
    assert unit.quantity_to_ticks(None) is None
    assert unit.quantity_to_ticks(Quantity(Fraction(6), "6 ns")) == 2


def _quantity(number: int) -> Quantity:
    return Quantity(Fraction(number), str(number))


def test_a_period_is_written_as_such_or_as_a_rate() -> None:
    assert written_period(Timing()) is None
    assert written_period(Timing(period=_quantity(5))) == 5
    assert written_period(Timing(rate=_quantity(50))) == 20_000_000
    assert written_period(Timing(period=_quantity(0))) is None
    assert written_period(Timing(rate=_quantity(0))) is None
    assert written_period(Timing(rate=_quantity(-1))) is None
    assert written_period(Timing(period=_quantity(0), rate=_quantity(50))) == 20_000_000
    assert written_period(Timing(rate=_quantity(1))) == 10**9


def _with_rates(*rates: int) -> Architecture:
    """Return elements with these rates in Hz, however many digits they have."""
    parts = ", ".join(
        f"c{place}: {{outputs: {{out: std_msgs/msg/Empty}}, timing: {{rate: 1 Hz}}}}" for place in range(len(rates))
    )
    model = architecture(f"groups: {{g: {{components: {{{parts}}}}}}}\n")
    nodes = {
        name: replace(node, timing={key: replace(timing, rate=_quantity(rate)) for key, timing in node.timing.items()})
        for (name, node), rate in zip(model.nodes.items(), rates, strict=True)
    }
    return replace(model, nodes=nodes)


def test_rates_of_absurd_precision_have_no_common_unit() -> None:
    """4095 bits of both periods' denominator and one of the single core are 4096; one more is too much."""
    first = 2**2048 + 1
    for second, exact in ((2**2046 + 1, True), (2**2047 + 1, False)):
        unit = choose_tick_unit(_with_rates(first, second))
        assert unit.exact is exact
        assert exact or unit.tick == Fraction(1, 2**64)
    assert [note.text for note in analyse_architecture(_with_rates(first, 2**2048 + 3)).notes] == [
        "the rates have no common measure of reasonable size: periods are rounded up"
    ]
    assert analyse_architecture(_with_rates(10, 20)).notes == ()


@pytest.mark.parametrize(
    ("timing", "period"),
    [
        (Timing(period=Quantity(Fraction(1), "1 ns")), 1),
        (Timing(period=Quantity(Fraction(0), "0 ns")), None),
        (Timing(rate=Quantity(Fraction(1), "1 Hz")), 10**9),
        (Timing(rate=Quantity(Fraction(1, 2), "0.5 Hz")), 2 * 10**9),
        (Timing(rate=Quantity(Fraction(0), "0 Hz")), None),
        (Timing(period=Quantity(Fraction(0), "0 ns"), rate=Quantity(Fraction(1), "1 Hz")), 10**9),
        (Timing(period=Quantity(Fraction(5), "5 ns"), rate=Quantity(Fraction(1), "1 Hz")), 5),
        (Timing(), None),
    ],
)
def test_a_period_is_written_as_one_or_as_a_rate(timing: Timing, period: int | None) -> None:
    assert written_period(timing) == period
