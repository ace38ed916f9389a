"""A small stand-in for timing in the tests of views: an analysis made by hand of an architecture, of every sort of figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from archgen.model.architecture import Architecture
from archgen.model.node import Node
from archgen.timing.analysis import (
    Analysis,
    ChainResult,
    ChainTerm,
    EdgeFit,
    EventPace,
    HostLoad,
    LinkLoad,
    Reason,
    ResponseTime,
    TopicLoad,
)
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue
from archgen.timing.system.timing_system import Activity, Arc, TimingSystem
from archgen.views.graphs.element_boxes import list_node_flows
from archgen.views.timing import timing_lookup as timed_module
from archgen.views.timing.timing_lookup import TimingLookup

MS = 10**6


def exact(value: Fraction | int) -> TimingValue:
    """Make a figure that is known."""
    return TimingValue(Fraction(value))


def analysis_of(figures: Mapping[str, tuple[int | None, int | None]], fed: Sequence[tuple[str, str]] = ()) -> Analysis:
    """Make an analysis of activities (id: period and wcet in ns), each fired by those that feed it."""
    arcs = tuple(Arc(tail, f"{tail}.out", head, f"{head}.in", f"/{tail}", "topic") for tail, head in fed)
    made = {
        name: Activity(
            name,
            name,
            None,
            "periodic" if period else "event",
            period=period,
            wcet=wcet,
            triggers=(f"{name}.in",) if any(head == name for _, head in fed) else (),
        )
        for name, (period, wcet) in figures.items()
    }
    system = _system(made, arcs)
    responses = {name: _response(each) for name, each in made.items()}
    return Analysis(system, _paces(system), {}, responses, {}, {}, {}, ())


def _system(activities: Mapping[str, Activity], arcs: tuple[Arc, ...]) -> TimingSystem:
    into = {name: tuple(arc for arc in arcs if arc.target == name) for name in activities}
    out_of = {name: tuple(arc for arc in arcs if arc.source == name) for name in activities}
    return TimingSystem(Fraction(1), activities, arcs, into, out_of)


def timed(architecture: Architecture) -> TimingLookup:
    """Give every node an activity: what was written, and down the topics what follows by a first guess."""
    activities = {node.id: _activity(node) for node in architecture.nodes.values()}
    arcs = tuple(
        Arc(run.tail, f"{run.topic.name}", run.head, f"{run.topic.name}", run.topic.name, run.topic.flow)
        for run in list_node_flows(architecture)
    )
    fed = _system(activities, arcs).arcs_into
    system = _system({name: _triggered(each, fed[name]) for name, each in activities.items()}, arcs)
    paces = _paces(system)
    responses = {name: _response(each) for name, each in system.activities.items()}
    analysis = Analysis(
        system,
        paces,
        {(arc.source, arc.output): paces[arc.source] for arc in arcs},
        responses,
        _hosts(architecture, system, paces),
        {
            link: LinkLoad(exact(2_500_000), exact(Fraction(1, 50)), exact(1500), exact(12000), ())
            for link in architecture.links
        },
        {
            name: TopicLoad(exact(1200), exact(12000), exact(24000))
            if at % 2
            else TopicLoad(UNKNOWN_VALUE, UNKNOWN_VALUE, UNKNOWN_VALUE)
            for at, name in enumerate(architecture.topics)
        },
        tuple(EdgeFit(arc, exact(0), exact(1), UNKNOWN_VALUE, exact(1)) for arc in arcs[:3]),
    )
    return timed_module.make_timing_lookup(analysis, (chain(each, analysis) for each in _ways(architecture)))


def _activity(node: Node) -> Activity:
    written = next(iter(node.timing.values()), None)
    period = None
    if written and written.period:
        period = int(written.period.value)
    elif written and written.rate:
        period = int(10**9 / written.rate.value)
    behaviour = written.behaviour if written else None
    return Activity(
        node.id,
        node.id,
        None,
        behaviour,
        period=period,
        wcet=int(written.wcet.value) if written and written.wcet else None,
        bcet=int(written.bcet.value) if written and written.bcet else None,
        host=node.host,
        at=node.at,
    )


def _triggered(activity: Activity, into: tuple[Arc, ...]) -> Activity:
    keys = tuple(dict.fromkeys(arc.input for arc in into)) if activity.behaviour == "event" else ()
    return Activity(
        activity.id,
        activity.node,
        activity.component,
        activity.behaviour,
        period=activity.period,
        wcet=activity.wcet,
        bcet=activity.bcet,
        triggers=keys,
        host=activity.host,
        at=activity.at,
    )


def _paces(system: TimingSystem) -> dict[str, EventPace]:
    found = {
        name: EventPace(each.behaviour, exact(Fraction(10**9, each.period)), exact(each.period), inferred=False)
        if each.period
        else EventPace(each.behaviour, reasons=(Reason("nothing is written"),))
        for name, each in system.activities.items()
    }
    for _ in range(6):
        for name, each in system.activities.items():
            rates = [found[arc.source].rate.value for arc in system.arcs_into[name]] if each.triggers else []
            known = [rate for rate in rates if rate]
            if known and each.behaviour == "event":
                side = "exact" if len(known) == len(rates) else "at least"
                rate = TimingValue(sum(known, Fraction(0)), side == "exact", side=side)  # type: ignore[arg-type]
                found[name] = EventPace("event", rate, exact(10**9 / max(known)))
    return found


def _response(activity: Activity) -> ResponseTime:
    if activity.wcet is None:
        return ResponseTime(UNKNOWN_VALUE, TimingValue(None, complete=False, missing=(activity.id,)), "unknown")
    return ResponseTime(
        exact(activity.bcet or 0), exact(activity.wcet), "dedicated", (Reason("assuming a core of its own"),)
    )


def _hosts(architecture: Architecture, system: TimingSystem, paces: dict[str, EventPace]) -> dict[str, HostLoad]:
    found = {}
    for host in architecture.hosts.values():
        parts = []
        missing = []
        for name, each in system.activities.items():
            rate = paces[name].rate.value
            if each.host == host.id and each.wcet is not None and rate:
                parts.append((name, exact(rate * each.wcet / 10**9)))
            elif each.host == host.id:
                parts.append((name, UNKNOWN_VALUE))
                missing.append(name)
        total = sum((value.value for _, value in parts if value.value), Fraction(0))
        load = TimingValue(total, not missing, tuple(missing), side="at least" if missing else "exact")
        over = total >= (host.cores or 1)
        found[host.id] = HostLoad(
            load,
            host.cores or 1,
            exact(Fraction(7, 10)),
            "overload" if over else "undecided" if missing else "schedulable",
            tuple(parts),
        )
    return found


def _ways(architecture: Architecture) -> list[tuple[str, tuple[str, ...], int | None]]:
    found = []
    for each in architecture.chains.values():
        through: list[str] = []
        for point in each.through:
            nodes = [
                node.id
                for node in architecture.nodes.values()
                if node.id == point.id or any(point.id.startswith(c) for c in node.implements)
            ]
            through += nodes[:1]
        found.append((each.id, tuple(through), int(each.deadline.value) if each.deadline else None))
    return found


def chain(way: tuple[str, tuple[str, ...], int | None], analysis: Analysis) -> ChainResult:
    """Sum up a chain, as if every step waited for a whole gap."""
    name, through, deadline = way
    terms = tuple(
        ChainTerm(
            each,
            analysis.paces[each].gap if analysis.paces[each].behaviour == "periodic" else exact(0),
            analysis.responses[each].worst,
            exact(0) if at == 0 else exact(300_000),
            "it reads its newest input once a period"
            if analysis.paces[each].behaviour == "periodic"
            else "fired by its input",
            analysis.system.activities[each].at,
        )
        for at, each in enumerate(through)
    )
    values = [value for term in terms for value in (term.sampling, term.response, term.link)]
    missing = tuple(dict.fromkeys(t.activity for t in terms if t.sampling.value is None or t.response.value is None))
    total = sum((value.value for value in values if value.value is not None), Fraction(0))
    bound = TimingValue(total, not missing, missing, side="at least" if missing else "exact")
    late = deadline is not None and total > deadline
    verdict = "not proven" if late and not missing else "met" if deadline and not missing else "open"
    best = exact(sum((analysis.responses[each].best.value or 0 for each in through), Fraction(0)))
    return ChainResult(
        name,
        through,
        terms,
        bound,
        best,
        bound,
        bound,
        exact(deadline) if deadline else None,
        verdict,  # type: ignore[arg-type]
    )
