"""Which figure decides a chain: each one improved by a tenth in turn; and which unknown figure to measure first."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction

from archgen.diagnostics.source_span import Span
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture, Chain
from archgen.model.declared_timing import Timing
from archgen.model.graph_search import find_reachable
from archgen.model.quantity import Quantity
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_bounds import bound_chain
from archgen.timing.chains.trigger_arrivals import TriggerArrivals
from archgen.timing.figures.timing_values import UNLINKED_NOTE
from archgen.timing.system.core_placement import is_missing_cores

IMPROVED_SHARE = Fraction(9, 10)
"""What is left of a duration that is improved by a tenth."""
MAX_TRIED_FIGURES = 200
"""How many figures are tried: each takes an analysis of the whole. The rest is counted in `untried`."""
_FIGURE_KEYS = ("wcet", "response", "period", "rate", "throttle", "jitter")


@dataclass(frozen=True, slots=True)
class FigureGain:
    """A figure (`object_recognizer.timing.wcet`), what is written, and what a tenth of it takes off the bound (ns)."""

    figure: str
    written: str
    gain: Fraction
    at: Span


@dataclass(frozen=True, slots=True)
class UnknownFigure:
    """An unknown figure: how many terms of the chain lack it, how many chains, and what may hide there (ns)."""

    element: str
    what: str
    terms: int
    chains: int
    plausible: Fraction | None


@dataclass(frozen=True, slots=True)
class ChainSensitivity:
    """What decides a chain. `untried` counts the figures that were left out."""

    gains: tuple[FigureGain, ...]
    gaps: tuple[UnknownFigure, ...]
    untried: int


def find_sensitivity(
    architecture: Architecture,
    asked_chain: Chain,
    analyse: Callable[[Architecture], Analysis],
    results: Mapping[str, ChainResult],
) -> ChainSensitivity:
    """Try each figure that may bear on a chain; the largest gain comes first.

    `results` are all chains as they are now.
    """
    analysis = analyse(architecture)
    current_result = results[asked_chain.id]
    if not current_result.terms:  # open: no path, so no figure bears on it
        return ChainSensitivity((), (), 0)
    candidates = list(_improved_architectures(architecture, analysis, current_result))
    gains: list[FigureGain] = []
    for figure, written, span, changed_architecture in candidates[:MAX_TRIED_FIGURES]:
        # The whole analysis anew: a neighbour on the same host bears on the chain through responses and jitter only.
        new_bound = bound_chain(analyse(changed_architecture), changed_architecture, asked_chain).bound
        if (
            current_result.bound.value is not None
            and new_bound.value is not None
            and new_bound.value < current_result.bound.value
        ):
            gains.append(FigureGain(figure, written, current_result.bound.value - new_bound.value, span))
    gains.sort(key=lambda gain: (-gain.gain, gain.figure))
    return ChainSensitivity(
        tuple(gains),
        tuple(_rank_unknown_figures(analysis, current_result, results)),
        max(0, len(candidates) - MAX_TRIED_FIGURES),
    )


def _improved_architectures(
    architecture: Architecture, analysis: Analysis, result: ChainResult
) -> Iterator[tuple[str, str, Span, Architecture]]:
    """Yield each written figure that may bear on a chain, with the architecture in which it is improved."""
    for name in _relevant_activities(analysis, result):
        activity = analysis.system.activities[name]
        node = architecture.nodes[activity.node]
        key = activity.component or ""
        timing = node.timing.get(key)
        if timing is None:
            continue
        for figure in _FIGURE_KEYS:
            quantity: Quantity | None = getattr(timing, figure)
            if quantity is not None and quantity.value:
                better_timing = _improve_timing(timing, figure, quantity)
                nodes = {**architecture.nodes, node.id: replace(node, timing={**node.timing, key: better_timing})}
                span = timing.places.get(figure, timing.at)
                yield f"{name}.timing.{figure}", quantity.text, span, replace(architecture, nodes=nodes)
    yield from _improved_links(architecture, analysis, result)


def _improved_links(
    architecture: Architecture, analysis: Analysis, result: ChainResult
) -> Iterator[tuple[str, str, Span, Architecture]]:
    """Yield the written latencies of links along a chain, with the architecture in which each is improved."""
    used_links = {
        arc.link
        for source, target in zip(result.through, result.through[1:], strict=False)
        for arc in analysis.system.arcs_from.get(source, ())
        if arc.target == target and arc.link
    }
    for name in sorted(used_links):
        link = architecture.links[name]
        if link.worst is not None and link.worst.value:
            # A worst latency below the best one would be a mistake in the files.
            value = max(link.worst.value * IMPROVED_SHARE, link.best.value if link.best else Fraction(0))
            changed_link = replace(link, worst=Quantity(value, link.worst.text))
            links = {**architecture.links, name: changed_link}
            yield f"{name}.latency.worst", link.worst.text, link.at, replace(architecture, links=links)


def _improve_timing(timing: Timing, figure: str, quantity: Quantity) -> Timing:
    """Take a tenth off a duration (a rate grows accordingly); what cannot be above it goes down with it."""
    value = quantity.value / IMPROVED_SHARE if figure == "rate" else quantity.value * IMPROVED_SHARE
    changes = {figure: Quantity(value, quantity.text)}
    if figure == "wcet" and timing.bcet is not None and timing.bcet.value > value:
        changes["bcet"] = changes["wcet"]
    return replace(timing, **changes)  # type: ignore[arg-type]


def _relevant_activities(analysis: Analysis, result: ChainResult) -> list[str]:
    """Return the activities that bear on a chain: its own, what fires them, and what shares their hosts."""
    arrivals, activities = TriggerArrivals(analysis), analysis.system.activities
    firing_sources = {
        name: [arc.source for arc in arcs if arrivals.fires_reader(arc)]
        for name, arcs in analysis.system.arcs_into.items()
    }
    relevant_ids = dict.fromkeys(find_reachable(firing_sources, result.through))
    hosts = {activities[name].host for name in result.through} - {None}
    relevant_ids |= dict.fromkeys(name for name, activity in activities.items() if activity.host in hosts)
    return list(relevant_ids)


def _rank_unknown_figures(
    analysis: Analysis, result: ChainResult, results: Mapping[str, ChainResult]
) -> list[UnknownFigure]:
    """Rank unknown figures: by the terms that lack them, by what may hide there, by the chains that lack them."""
    lacking_terms: dict[tuple[str, str], int] = {}
    for term in result.terms:
        for figure_name, value in (
            ("period or rate", term.sampling),
            ("execution time", term.response),
            ("latency", term.link),
        ):
            # Where no link joins two hosts, nothing of the elements on them is missing: the link is, and is named itself.
            is_nameable = not value.complete and UNLINKED_NOTE not in value.assumptions
            for name in value.missing if is_nameable else ():
                if lack := _name_lack(analysis, name, figure_name):
                    lacking_terms[name, lack] = lacking_terms.get((name, lack), 0) + 1
    gaps = [
        UnknownFigure(
            name,
            figure_name,
            count,
            sum(name in other_result.bound.missing for other_result in results.values()),
            _plausible_duration(analysis, name),
        )
        for (name, figure_name), count in lacking_terms.items()
    ]
    return sorted(gaps, key=lambda gap: (-gap.terms, -(gap.plausible or 0), -gap.chains, gap.element))


def _name_lack(analysis: Analysis, name: str, figure_name: str) -> str:
    """Return which figure of an element is missing, most likely that of the term; empty where all are written."""
    activity = analysis.system.activities.get(name)
    if activity is None:
        return "number" if is_missing_cores(name) else figure_name
    pace = analysis.paces[name]
    lacks = {
        "execution time": activity.wcet is None and activity.response is None,
        "period or rate": activity.period is None and (pace.gap.value is None or pace.rate.value is None),
    }
    return (
        figure_name if lacks.get(figure_name) else next((lack for lack, is_lacking in lacks.items() if is_lacking), "")
    )


def _plausible_duration(analysis: Analysis, name: str) -> Fraction | None:
    """Return what may hide in an unknown figure: the activity's gap, since what works rarely may take long."""
    pace = analysis.paces.get(name)
    return pace.gap.value if pace else None
