"""Analyses made by hand for tests of chains and ways: one line for each activity and arc, durations in ms."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from fractions import Fraction

from archgen.model.architecture import Architecture, Chain, ProjectInfo, Waypoint
from archgen.model.node import Node
from archgen.model.quantity import Quantity
from archgen.timing.analysis import Analysis, EventPace, ResponseTime
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue
from archgen.timing.system.timing_system import Activity, Arc, TimingSystem

MS = 10**6


def ms(count: float | Fraction) -> TimingValue:
    """Make a known duration."""
    return TimingValue(Fraction(count) * MS)


def missing(*names: str) -> TimingValue:
    """Make a figure that is not known."""
    return TimingValue(None, complete=False, missing=names)


def periodic(name: str, period: int, **keys: object) -> Activity:
    """Make a periodic activity, named like its node."""
    return Activity(name, name, None, "periodic", period=period * MS, host="pc", **keys)  # type: ignore[arg-type]


def event(name: str, *triggers: str, **keys: object) -> Activity:
    """Make an activity that its inputs trigger."""
    return Activity(name, name, None, "event", triggers=triggers, **keys)  # type: ignore[arg-type]


def arc(source: str, target: str, **keys: object) -> Arc:
    """Make an arc; output and input are called after both ends."""
    output, key, topic = f"{source}.out", f"{target}.{source}", f"/{source}"
    return Arc(source, output, target, key, topic, "topic", **keys)  # type: ignore[arg-type]


def analysis(
    activities: Sequence[Activity],
    arcs: Sequence[Arc],
    responses: Mapping[str, TimingValue | float],
    gaps: Mapping[str, TimingValue | float],
    out_gaps: Mapping[str, TimingValue | float] | None = None,
) -> Analysis:
    """Lay all together. Best and worst response are one; an output's gap is its activity's where nobody says otherwise."""
    into, out_of = defaultdict[str, list[Arc]](list), defaultdict[str, list[Arc]](list)
    for each in arcs:
        into[each.target].append(each)
        out_of[each.source].append(each)
    system = TimingSystem(
        Fraction(1),
        {a.id: a for a in activities},
        tuple(arcs),
        {key: tuple(row) for key, row in into.items()},
        {key: tuple(row) for key, row in out_of.items()},
    )
    known = {a.id: _value(gaps.get(a.id, UNKNOWN_VALUE)) for a in activities}
    paces = {a.id: EventPace(a.behaviour, gap=known[a.id]) for a in activities}
    sent = {a.id: _value((out_gaps or {}).get(a.id, known[a.id])) for a in activities}
    outputs = {(a.id, f"{a.id}.out"): EventPace(a.behaviour, gap=sent[a.id]) for a in activities}
    found = {key: _value(value) for key, value in responses.items()}
    tiers = {key: ResponseTime(value, value, "priorities") for key, value in found.items()}
    return Analysis(system, paces, outputs, tiers, {}, {}, {}, ())


def architecture(names: Sequence[str], *through: str, deadline: int | None = None) -> Architecture:
    """Make an architecture of nodes and one chain `c` through some of them."""
    points = tuple(Waypoint("node", name) for name in through)
    limit = Quantity(Fraction(deadline * MS), f"{deadline} ms") if deadline else None
    nodes = {name: Node(name, name) for name in names}
    return Architecture(ProjectInfo("p", "P"), nodes=nodes, chains={"c": Chain("c", "C", points, limit)})


def _value(given: TimingValue | float) -> TimingValue:
    return given if isinstance(given, TimingValue) else ms(given)
