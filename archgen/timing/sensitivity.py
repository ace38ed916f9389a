"""Which figure decides a chain: each one improved by a tenth in turn; and which unknown figure to measure first."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture, Chain
from archgen.model.quantity import Quantity
from archgen.model.timing import Timing
from archgen.source import Span
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.arrivals import Arrivals
from archgen.timing.chains import chain

BETTER = Fraction(9, 10)
"""What is left of a duration that is improved by a tenth."""
MOST = 200
"""How many figures are tried: each takes an analysis of the whole. The rest is counted in `untried`."""
_KEYS = ("wcet", "response", "period", "rate", "throttle", "jitter")


@dataclass(frozen=True, slots=True)
class Gain:
    """A figure (`object_recognizer.timing.wcet`), what is written, and what a tenth of it takes off the bound (ns)."""

    figure: str
    written: str
    gain: Fraction
    at: Span


@dataclass(frozen=True, slots=True)
class Gap:
    """An unknown figure: how many terms of the chain lack it, how many chains, and what may hide there (ns)."""

    element: str
    what: str
    terms: int
    chains: int
    plausible: Fraction | None


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """What decides a chain. `untried` counts the figures that were left out."""

    gains: tuple[Gain, ...]
    gaps: tuple[Gap, ...]
    untried: int


def sensitivity(
    architecture: Architecture,
    asked: Chain,
    analyse: Callable[[Architecture], Analysis],
    results: Mapping[str, ChainResult],
) -> Sensitivity:
    """Try each figure that may bear on a chain; the largest gain comes first.

    `results` are all chains as they are now.
    """
    analysis = analyse(architecture)
    now = results[asked.id]
    candidates = list(_candidates(architecture, analysis, now))
    gains: list[Gain] = []
    for figure, written, at, changed in candidates[:MOST]:
        # The whole analysis anew: a neighbour on the same host bears on the chain through responses and jitter only.
        after = chain(analyse(changed), changed, asked).bound
        if now.bound.value is not None and after.value is not None and after.value < now.bound.value:
            gains.append(Gain(figure, written, now.bound.value - after.value, at))
    gains.sort(key=lambda gain: (-gain.gain, gain.figure))
    return Sensitivity(tuple(gains), tuple(_gaps(analysis, now, results)), max(0, len(candidates) - MOST))


def _candidates(
    architecture: Architecture, analysis: Analysis, result: ChainResult
) -> Iterator[tuple[str, str, Span, Architecture]]:
    """Yield each written figure that may bear on a chain, with the architecture in which it is improved."""
    for name in _near(analysis, result):
        activity = analysis.system.activities[name]
        node = architecture.nodes[activity.node]
        key = activity.component or ""
        timing = node.timing.get(key)
        if timing is None:
            continue
        for figure in _KEYS:
            quantity: Quantity | None = getattr(timing, figure)
            if quantity is not None and quantity.value:
                better = _better(timing, figure, quantity)
                nodes = {**architecture.nodes, node.id: replace(node, timing={**node.timing, key: better})}
                at = timing.places.get(figure, timing.at)
                yield f"{name}.timing.{figure}", quantity.text, at, replace(architecture, nodes=nodes)
    yield from _links(architecture, analysis, result)


def _links(
    architecture: Architecture, analysis: Analysis, result: ChainResult
) -> Iterator[tuple[str, str, Span, Architecture]]:
    """Yield the written latencies of links along a chain, with the architecture in which each is improved."""
    used = {
        arc.link
        for one, other in zip(result.through, result.through[1:], strict=False)
        for arc in analysis.system.out_of.get(one, ())
        if arc.target == other and arc.link
    }
    for name in sorted(used):
        link = architecture.links[name]
        if link.worst is not None and link.worst.value:
            # A worst latency below the best one would be a mistake in the files.
            value = max(link.worst.value * BETTER, link.best.value if link.best else Fraction(0))
            changed = replace(link, worst=Quantity(value, link.worst.text))
            links = {**architecture.links, name: changed}
            yield f"{name}.latency.worst", link.worst.text, link.at, replace(architecture, links=links)


def _better(timing: Timing, figure: str, quantity: Quantity) -> Timing:
    """Take a tenth off a duration (a rate grows accordingly); what cannot be above it goes down with it."""
    value = quantity.value / BETTER if figure == "rate" else quantity.value * BETTER
    changes = {figure: Quantity(value, quantity.text)}
    if figure == "wcet" and timing.bcet is not None and timing.bcet.value > value:
        changes["bcet"] = changes["wcet"]
    return replace(timing, **changes)  # type: ignore[arg-type]


def _near(analysis: Analysis, result: ChainResult) -> list[str]:
    """Return the activities that bear on a chain: its own, what fires them, and what shares their hosts."""
    arrivals, activities = Arrivals(analysis), analysis.system.activities
    found = dict.fromkeys(result.through)
    queue = list(found)
    for name in queue:
        for arc in analysis.system.into.get(name, ()):
            if arrivals.fires(arc) and arc.source not in found:
                found[arc.source] = None
                queue.append(arc.source)
    hosts = {activities[name].host for name in result.through} - {None}
    found |= dict.fromkeys(name for name, activity in activities.items() if activity.host in hosts)
    return list(found)


def _gaps(analysis: Analysis, result: ChainResult, results: Mapping[str, ChainResult]) -> list[Gap]:
    """Rank unknown figures: by the terms that lack them, by what may hide there, by the chains that lack them."""
    lacking: dict[tuple[str, str], int] = {}
    for term in result.terms:
        for what, value in (
            ("period or rate", term.sampling),
            ("execution time", term.response),
            ("latency", term.link),
        ):
            for name in () if value.complete else value.missing:
                lacking[name, what] = lacking.get((name, what), 0) + 1
    gaps = [
        Gap(
            name,
            what,
            count,
            sum(name in other.bound.missing for other in results.values()),
            _plausible(analysis, name),
        )
        for (name, what), count in lacking.items()
    ]
    return sorted(gaps, key=lambda gap: (-gap.terms, -(gap.plausible or 0), -gap.chains, gap.element))


def _plausible(analysis: Analysis, name: str) -> Fraction | None:
    """Return what may hide in an unknown figure: the activity's gap, since what works rarely may take long."""
    pace = analysis.paces.get(name)
    return pace.gap.value if pace else None
