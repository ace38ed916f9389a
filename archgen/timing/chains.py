"""End to end along chains: the safe bound (reaction time = data age), its terms, and the verdict on the deadline.

F = S0 + R0 + sum over later steps of (link worst + S_i + R_i)
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture, Chain, Waypoint
from archgen.timing import route, wording
from archgen.timing.analysis import Analysis, ChainResult, Term
from archgen.timing.network import Aim, Network
from archgen.timing.paths import Way, Ways, ways
from archgen.timing.sums import bounded, boundless, known
from archgen.timing.system import Arc
from archgen.timing.value import UNKNOWN, ZERO, Value

NO_WAY = Value(None, complete=False, assumptions=("no way leads through all elements",))


@dataclass(frozen=True, slots=True)
class Found:
    """One path between two elements: its activities, terms, and bound."""

    through: tuple[str, ...]
    terms: tuple[Term, ...]
    bound: Value


@dataclass(frozen=True, slots=True)
class Late:
    """A chain that may miss its deadline: its bound, and the terms."""

    chain: Chain
    bound: Value
    terms: tuple[Term, ...]


def chain(analysis: Analysis, architecture: Architecture, asked: Chain, network: Network | None = None) -> ChainResult:
    """Bound one chain. Pass a network to share its costs among many chains."""
    network = network or Network.of(analysis)
    points = route.points(analysis.system, architecture, asked.through)
    regions = route.chain_route(network, points)
    return _result(network, regions, asked)


def chains(analysis: Analysis, architecture: Architecture) -> dict[str, ChainResult]:
    """Bound all chains of an architecture, in order of appearance."""
    network = Network.of(analysis)
    return {asked.id: chain(analysis, architecture, asked, network) for asked in architecture.chains.values()}


def missed(analysis: Analysis, architecture: Architecture) -> Iterator[Late]:
    """Yield the chains that may miss their deadlines; their other figures are left out."""
    network = Network.of(analysis)
    for asked in architecture.chains.values():
        if asked.deadline is None or asked.unresolved:
            continue
        regions = route.chain_route(network, route.points(analysis.system, architecture, asked.through))
        # Only the bound: the three other aims would each cost a graph of their own, and rules need none of them.
        found = _ways(network, regions, "bound") if regions else None
        way = next(found.best(), None) if found else None
        if found is not None and way is not None:
            bound = _whole(network, found, way, "bound")
            if verdict(bound, Value(asked.deadline.value)) == "missed":
                yield Late(asked, bound, terms(network, way))


def between(
    network: Network, architecture: Architecture, source: Waypoint, target: Waypoint, aim: Aim = "bound"
) -> Ways | None:
    """Return all paths from one element to another, None where an element has no activity.

    Extremes, the next ones and their number can be asked of the answer. With the aim `best`, the quickest best case is
    first.
    """
    points = route.points(network.steps.analysis.system, architecture, (source, target))
    regions = route.free_route(network, points)
    return _ways(network, regions, aim) if regions else None


def listed(network: Network, found: Ways, most: int) -> Iterator[Found]:
    """Yield the first paths, with their terms."""
    for way in found.best(most):
        arcs = [network.arcs[at] for at in way.arcs]
        names = (network.names[way.start], *(arc.target for arc in arcs))
        aim: Aim = "bound" if found.longest else "best"
        yield Found(names, terms(network, way), _sum(network, way, aim))


def terms(network: Network, way: Way) -> tuple[Term, ...]:
    """Return the terms of a path's bound: waiting, response, link, each with its reason and place."""
    steps = network.steps
    name = network.names[way.start]
    start = steps.start(name)
    made = [Term(name, start.value, steps.response(name), ZERO, start.why, start.at)]
    for arc in (network.arcs[at] for at in way.arcs):
        waits = steps.delay(arc)
        made.append(Term(arc.target, waits.value, steps.response(arc.target), steps.link(arc), waits.why, waits.at))
    return tuple(made)


def _result(network: Network, regions: Sequence[route.Region], asked: Chain) -> ChainResult:
    """Return all figures of a chain, with the terms of its worst path."""
    deadline = Value(asked.deadline.value) if asked.deadline else None
    found = _ways(network, regions, "bound") if regions else None
    way = next(found.best(), None) if found else None
    if asked.unresolved or found is None or way is None:
        named = tuple(point.id for point in asked.through)
        none = _nameless(asked.unresolved) if asked.unresolved else NO_WAY
        return ChainResult(asked.id, named, (), none, none, none, none, deadline, "open")
    bound = _from_event(network, way, _whole(network, found, way, "bound"))
    return ChainResult(
        id=asked.id,
        through=(network.names[way.start], *(network.arcs[at].target for at in way.arcs)),
        terms=terms(network, way),
        bound=bound,
        best=_extreme(network, regions, "best"),
        reduced_reaction=_extreme(network, regions, "reduced reaction"),
        reduced_age=_extreme(network, regions, "reduced age"),
        deadline=deadline,
        verdict=verdict(bound, deadline),
    )


def _nameless(words: tuple[str, ...]) -> Value:
    """Return the value of a chain with words that name nothing."""
    return Value(None, complete=False, missing=words, assumptions=tuple(f"`{word}` is not resolved" for word in words))


def _from_event(network: Network, way: Way, bound: Value) -> Value:
    """Note on a chain that begins with an event that reaction time and data age differ, and by how much."""
    first = network.names[way.start]
    if network.steps.analysis.system.activities[first].behaviour not in {"event", "on_demand"}:
        return bound
    gap = network.steps.arrivals.gap(first)
    longer = wording.duration(gap.value) if gap.value is not None and known(gap) else f"unknown for {first}"
    said = f"the reaction counts from the event that fires {first}; data age is larger by its largest gap ({longer})"
    return replace(bound, assumptions=(*bound.assumptions, said))


def data_age(network: Network, result: ChainResult) -> Value:
    """Return the largest age of what a chain makes of a sample, until the next one replaces it.

    It is the bound where the first element samples the world. Where its event is the stimulus, the next stimulus may be
    a gap away, which comes on top.
    """
    if not result.terms or network.steps.analysis.system.activities[result.through[0]].behaviour == "periodic":
        return result.bound
    return bounded((result.bound, network.steps.arrivals.gap(result.through[0])))


def verdict(bound: Value, deadline: Value | None) -> Literal["met", "missed", "open"]:
    """Compare a bound with a deadline. What is known may exceed it before everything is known."""
    if deadline is None or deadline.value is None:
        return "open"
    if boundless(bound):
        return "missed"
    if bound.value is not None and bound.value > deadline.value:
        return "missed"
    return "met" if known(bound) else "open"


def _ways(network: Network, regions: Sequence[route.Region], aim: Aim) -> Ways:
    """Return the paths of a route, with the extreme one for an aim first."""
    graph, first = network.graph(aim)
    return ways(graph, first, regions, longest=aim != "best")


def _extreme(network: Network, regions: Sequence[route.Region], aim: Aim) -> Value:
    """Return the extreme figure of a route for an aim."""
    found = _ways(network, regions, aim)
    way = next(found.best(), None)
    return _whole(network, found, way, aim) if way else UNKNOWN


def _sum(network: Network, way: Way, aim: Aim) -> Value:
    """Return the sum of a path's costs for an aim."""
    parts = list(network.start(network.names[way.start], aim))
    for at in way.arcs:
        parts += network.step(network.arcs[at], aim)
    return bounded(parts, "at least" if aim == "best" else "at most")


def _whole(network: Network, found: Ways, way: Way, aim: Aim) -> Value:
    """Return the extreme path's sum; it bounds all paths only where the costs of the others are known too."""
    value = _sum(network, way, aim)
    if found.cut:
        value = replace(value, assumptions=(*value.assumptions, _cut_text([network.arcs[at] for at in found.cut])))
    if aim == "best" or found.count == 1 or boundless(value):
        return value
    # Costs of unknown figures count as 0 in the network, so that a path with a gap may seem shorter than it is: if any
    # arc on any path lacks a figure, the bound is open.
    others = bounded([part for at in found.arcs() for part in network.step(network.arcs[at], aim)])
    if others.complete:
        return value
    missing = tuple(dict.fromkeys((*value.missing, *others.missing)))
    return replace(value, complete=False, missing=missing, side="at least")


def _cut_text(arcs: Sequence[Arc]) -> str:
    pairs = [f"{arc.source} > {arc.target}" for arc in arcs[:3]]
    more = f" and {len(arcs) - 3} more" if len(arcs) > 3 else ""  # noqa: PLR2004 - as many as are named
    return f"the loops are large: ways that go back along {', '.join(pairs)}{more} are left out"
