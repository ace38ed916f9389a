"""The figures of interfaces between partners, and when two of them say the same."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from archgen.compare.comparison import FigureChange, FigureKey, TravelPath, WireNames
from archgen.compare.interface_figures import FigureReader, concerns_nobody, is_close_value, is_same_figure, is_smaller
from archgen.diagnostics.source_span import Span
from archgen.model.node import Qos
from archgen.model.partner_interfaces import find_all_interfaces
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_architecture
from tests.compare.conftest import Checked
from tests.timing.printed import show

TEN, UNKNOWN = TimingValue(Fraction(10)), TimingValue(None)


def read_value(text: str) -> TimingValue:
    """Read `10`, `<=10`, `10?` (what is missing of it), `?`, `?a` (unknown because of a)."""
    if text.startswith("?"):
        return TimingValue(None, complete=False, missing=tuple(text[1:]))
    value = TimingValue(Fraction(text.strip("<=?")), complete=not text.endswith("?"))
    return replace(value, side="at most") if text.startswith("<=") else value


def _in_ms(value: TimingValue) -> TimingValue:
    return replace(value, value=None if value.value is None else value.value * 10**6)


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        ("10", "10", "close same age"),
        ("10000", "10010", "close same age"),
        ("1000", "1005", "close age"),
        ("1000", "1006", "age"),
        ("1005", "1000", "close age smaller"),
        ("1006", "1000", "age smaller"),
        ("200", "199", "close age smaller"),
        ("1/2", "1", ""),
        ("100", "95", "age smaller"),
        ("100", "94", "smaller"),
        ("-1000", "-1005", "close age smaller"),
        ("0", "0", "close same age"),
        ("10", "<=10", ""),
        ("10", "10?", ""),
        ("10?", "9", ""),
        ("10", "9?", ""),
        ("10?", "9?", ""),
        ("?", "?", "close same age"),
        ("?", "10", ""),
        ("10", "?", ""),
    ],
)
def test_values_that_say_the_same(before: str, after: str, expected: str) -> None:
    sides = read_value(before), read_value(after)
    judged = {
        "close": is_close_value(*sides),
        "same": is_same_figure("rate", *sides),
        "age": is_same_figure("age on arrival", *map(_in_ms, sides)),
        "smaller": is_smaller(*sides),
    }
    assert " ".join(name for name, is_true in judged.items() if is_true) == expected


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        (None, None, True),
        (None, UNKNOWN, True),
        (UNKNOWN, None, True),
        (None, TEN, False),
        (TEN, None, False),
        (None, WireNames("topic", ("/a",)), False),
        (WireNames("topic", ("/a",)), WireNames("topic", ("/a",)), True),
        (TravelPath(("a",), ("b",), ()), TravelPath(("a",), ("b",), ("lan",)), False),
        (Qos(profile="default"), Qos(profile="sensor", written=True, at=Span.of_file("a")), True),
        (Qos(depth=1), Qos(depth=2), False),
        (Qos(depth=1), Qos(depth=1), True),
        (Qos(), TEN, False),
    ],
)
def test_other_figures_that_say_the_same(before: object, after: object, expected: bool) -> None:  # noqa: FBT001
    assert is_same_figure("x", before, after) is expected  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "before", "after", "expected"),
    [
        ("rate", TEN, TEN, True),
        ("rate", TEN, TimingValue(Fraction(9)), False),
        ("largest gap", TEN, TimingValue(Fraction(9)), True),
        ("largest gap", TEN, TimingValue(Fraction(11)), False),
        ("answers within", TEN, TimingValue(Fraction(9)), True),
        ("age on arrival", TEN, TimingValue(Fraction(9)), True),
        ("largest gap", TEN, None, False),
        ("largest gap", None, TEN, False),
        ("QoS asked", Qos(), Qos(), False),
    ],
)
def test_what_is_small_or_sooner_concerns_nobody(name: str, before: object, after: object, expected: bool) -> None:  # noqa: FBT001
    assert concerns_nobody(FigureChange(FigureKey(name), before, after)) is expected  # type: ignore[arg-type]


ROBOT = """\
partners: {p: P, q: Q}
ros: {distro: jazzy}
groups:
  g:
    owner: p
    components:
      a: {timing: {rate: 10 Hz, wcet: 1 ms}, outputs: {x: T}}
      s: {timing: {behaviour: on_demand, wcet: 3 ms}, outputs: {ask: {type: S}}}
      e: {timing: {rate: 2 Hz}, outputs: {y: T}}
      m: {outputs: {force: {type: T, medium: physical}}}
  h:
    owner: q
    components:
      b: {timing: {trigger: [x], wcet: 1 ms}, inputs: {x: a.x, y: e.y, ask: s.ask, force: m.force}}
types: {T: {message: std_msgs/msg/Int8, size: 1 kB}, S: {message: std_srvs/srv/Trigger, size: 20 B}}
nodes:
  na: {implements: a, host: pc, publishes: {x: {qos: {depth: 3}}}}
  ns: {implements: s, host: pc}
  nb: {implements: b, host: arm}
  ne: {implements: e}
hosts: {pc: {cores: 1}, arm: {cores: 1}}
links: {lan: {connects: [pc, arm], bandwidth: 1 Mbit/s}}
"""
SECOND = ROBOT.replace("na: {", "na: {timing: {rate: 10 Hz, wcet: 1 ms}, ").replace(
    "  ns:",
    "  na2: {implements: a, host: pc, timing: {rate: 5 Hz, wcet: 2 ms}, publishes: {x: {qos: {depth: 4}}}}\n  ns:",
)


def list_figures(checked: Checked, text: str, *, is_analysed: bool = True) -> list[str]:
    """Return the figures of all interfaces: `id: name[ of node]=figure, ...`; times in ns."""
    architecture = checked(text)
    reader = FigureReader(architecture, analyse_architecture(architecture) if is_analysed else None)
    return [
        f"{interface.key}: "
        + ", ".join(
            f"{' of '.join(filter(None, key))}={_show(figure)}"
            for key, figure in reader.read_figures(interface).items()
        )
        for interface in find_all_interfaces(architecture)
    ]


def _show(figure: object) -> str:
    if isinstance(figure, TimingValue):
        return show(figure)
    if isinstance(figure, Qos):
        return f"depth {figure.depth}"
    assert isinstance(figure, TravelPath)
    return f"{' '.join(figure.senders)}-{' '.join(figure.links)}-{' '.join(figure.receivers)}"


def test_figures_of_a_topic_a_service_and_what_has_no_host(checked: Checked) -> None:
    assert list_figures(checked, ROBOT) == [
        "g.a.x: rate of na=10, largest gap of na=104000000, size=1000, traffic=10000, age on arrival=12320000, QoS offered of na=depth 3, QoS asked of nb=depth 10, hosts=pc-lan-arm",
        "g.s.ask: answers within of ns=4000000, size of a request=20, size of an answer=20, age on arrival=none ?, hosts=pc-lan-arm",
        "g.e.y: rate of ne=2, largest gap of ne=>= 500000000 ?ne, size=1000, traffic=2000, age on arrival=none ?, QoS offered of ne=depth 10, QoS asked of nb=depth 10",
        "g.m.force: ",
    ]


def test_several_nodes_have_figures_of_their_own(checked: Checked) -> None:
    assert list_figures(checked, SECOND)[:1] == [
        "g.a.x: rate of na=10, largest gap of na=109000000, rate of na2=5, largest gap of na2=209000000, size=1000, traffic=15000, age on arrival=25640000, QoS offered of na=depth 3, QoS offered of na2=depth 4, QoS asked of nb=depth 10, hosts=pc-lan-arm",
    ]


def test_without_an_analysis_there_are_hosts_and_qos(checked: Checked) -> None:
    assert list_figures(checked, ROBOT, is_analysed=False) == [
        "g.a.x: QoS offered of na=depth 3, QoS asked of nb=depth 10, hosts=pc--arm",
        "g.s.ask: hosts=pc--arm",
        "g.e.y: QoS offered of ne=depth 10, QoS asked of nb=depth 10",
        "g.m.force: ",
    ]


def test_ros_1_has_no_qos(checked: Checked) -> None:
    assert list_figures(checked, ROBOT.replace("jazzy", "noetic"), is_analysed=False) == [
        "g.a.x: hosts=pc--arm",
        "g.s.ask: hosts=pc--arm",
        "g.e.y: ",
        "g.m.force: ",
    ]
