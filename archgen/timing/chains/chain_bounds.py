"""End to end along chains: the safe bound (reaction time = data age), its terms, and the verdict on the deadline.

F = S0 + R0 + sum over later steps of (link worst + S_i + R_i)
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import pairwise

from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture, Chain, Waypoint
from archgen.model.latest_result import remember_latest
from archgen.timing.analysis import Analysis, ChainResult, ChainTerm, ChainVerdict, ShareDeadline
from archgen.timing.chains import chain_regions
from archgen.timing.chains.chain_verdicts import judge_deadline, judge_shares, may_be_late
from archgen.timing.chains.cost_network import CostNetwork, PathAim
from archgen.timing.chains.element_index import ChainPoint, ElementIndex
from archgen.timing.chains.extreme_paths import (
    ExtremePath,
    find_aimed_paths,
    find_extreme_path,
    find_extreme_value,
    sum_path,
)
from archgen.timing.chains.path_search import CostedPath, PathSet, RouteRegion
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import (
    ZERO_VALUE,
    TimingValue,
    is_boundless,
    is_known_bound,
    largest_value,
    smallest_value,
    sum_bounds,
)


@dataclass(frozen=True, slots=True)
class BoundedPath:
    """One path between two elements: its activities, terms, and bound."""

    through: tuple[str, ...]
    terms: tuple[ChainTerm, ...]
    bound: TimingValue


@dataclass(frozen=True, slots=True)
class JudgedChain:
    """A chain that is not known to meet its deadline: its bound, its best case, and the terms."""

    chain: Chain
    bound: TimingValue
    best: TimingValue
    verdict: ChainVerdict
    terms: tuple[ChainTerm, ...]


def bound_chain(
    analysis: Analysis, architecture: Architecture, asked_chain: Chain, network: CostNetwork | None = None
) -> ChainResult:
    """Bound one chain. Pass a network to share its costs among many chains."""
    network = network or CostNetwork.of_analysis(analysis)
    chain_points = network.index_elements(architecture).resolve_points(asked_chain.through)
    regions = chain_regions.lay_out_chain(network, chain_points)
    return _build_result(network, regions, asked_chain, chain_points)


def find_chain_slack(network: CostNetwork, architecture: Architecture, asked_chain: Chain) -> Fraction | None:
    """Return what the bound of a chain leaves of its deadline, in ns, and look for no other figure; None where either is open."""
    if asked_chain.deadline is None or asked_chain.unresolved:
        return None
    extreme_path = _find_longest(network, architecture, asked_chain)[1]
    if extreme_path is None or extreme_path.value.value is None or not is_known_bound(extreme_path.value):
        return None
    return asked_chain.deadline.value - extreme_path.value.value


_LongestPath = tuple[Sequence[RouteRegion], ExtremePath | None]


def _find_longest(network: CostNetwork, architecture: Architecture, asked_chain: Chain) -> _LongestPath:
    """Return a chain laid out, and its longest path. Several rules ask for these: they are found once."""
    elements = network.index_elements(architecture)
    known_paths = _open_longest_paths(elements)
    if asked_chain.through not in known_paths:
        regions = chain_regions.lay_out_chain(network, elements.resolve_points(asked_chain.through))
        known_paths[asked_chain.through] = regions, find_extreme_path(network, regions, "bound")
    return known_paths[asked_chain.through]


@remember_latest
def _open_longest_paths(_: ElementIndex) -> dict[tuple[Waypoint, ...], _LongestPath]:
    return {}


def bound_all_chains(analysis: Analysis, architecture: Architecture) -> dict[str, ChainResult]:
    """Bound all chains of an architecture, in order of appearance."""
    network = CostNetwork.of_analysis(analysis)
    return {
        asked_chain.id: bound_chain(analysis, architecture, asked_chain, network)
        for asked_chain in architecture.chains.values()
    }


def find_unmet_chains(analysis: Analysis, architecture: Architecture, margin: Fraction) -> Iterator[JudgedChain]:
    """Yield the chains that can miss their deadlines, and those of which that cannot be excluded, without other figures.

    `margin` is the share of each deadline that must stay free.
    """
    network = CostNetwork.of_analysis(analysis)
    for asked_chain in architecture.chains.values():
        if asked_chain.deadline is None or asked_chain.unresolved:
            continue
        # Only the bound: each other aim would cost a graph of its own, and rules need none of chains that are in time.
        regions, extreme_path = _find_longest(network, architecture, asked_chain)
        if extreme_path is not None:
            view, path, bound = extreme_path
            deadline = TimingValue((1 - margin) * asked_chain.deadline.value)
            if is_known_bound(bound) and not may_be_late(bound, deadline):
                continue
            best = find_extreme_value(network, regions, "best")
            # The margin is for what is uncertain: nothing is missed as long as it is only used up.
            can_be_missed = judge_deadline(bound, best, TimingValue(asked_chain.deadline.value)) == "missed"
            if can_be_missed or may_be_late(bound, deadline):
                verdict: ChainVerdict = "missed" if can_be_missed else "not proven"
                yield JudgedChain(asked_chain, bound, best, verdict, build_terms(view, path))


def find_open_chains(analysis: Analysis, architecture: Architecture) -> Iterator[JudgedChain]:
    """Yield the chains of whose deadlines nobody can say whether they are met, since figures are missing."""
    network = CostNetwork.of_analysis(analysis)
    for asked_chain in architecture.chains.values():
        if asked_chain.deadline is None or asked_chain.unresolved:
            continue
        regions, extreme_path = _find_longest(network, architecture, asked_chain)
        # Where all is known of what it passes, its best case need not be looked for.
        if extreme_path is None or extreme_path.value.complete:
            continue
        view, path, bound = extreme_path
        best = find_extreme_value(network, regions, "best")
        if judge_deadline(bound, best, TimingValue(asked_chain.deadline.value)) == "open":
            yield JudgedChain(asked_chain, bound, best, "open", build_terms(view, path))


def find_missed_shares(
    analysis: Analysis, architecture: Architecture
) -> Iterator[tuple[Chain, ShareDeadline, TimingValue]]:
    """Yield the deadlines of shares that no reaction of a chain can meet, each with the best case."""
    asked_chains = [each for each in architecture.chains.values() if each.deadline_shares and not each.unresolved]
    network = CostNetwork.of_analysis(analysis) if asked_chains else None
    for asked_chain in asked_chains if network else ():
        result = bound_chain(analysis, architecture, asked_chain, network)
        yield from ((asked_chain, share, result.best) for share in result.shares if share.verdict == "missed")


def find_paths_between(
    network: CostNetwork, architecture: Architecture, source: Waypoint, target: Waypoint, aim: PathAim = "bound"
) -> PathSet | None:
    """Return all paths from one element to another, None where an element has no activity.

    Extremes, the next ones and their number can be asked of the answer. With the aim `best`, the quickest best case is
    first.
    """
    end_points = network.index_elements(architecture).resolve_points((source, target))
    regions = chain_regions.lay_out_between(network, end_points)
    return find_aimed_paths(network, regions, aim) if regions else None


def list_bounded_paths(network: CostNetwork, path_set: PathSet, limit: int) -> Iterator[BoundedPath]:
    """Yield the first paths, with their terms."""
    for path in path_set.best_paths(limit):
        arcs = [network.arcs[arc_index] for arc_index in path.arcs]
        names = (network.names[path.start], *(arc.target for arc in arcs))
        aim: PathAim = "bound" if path_set.longest else "best"
        yield BoundedPath(names, build_terms(network, path), sum_path(network, path, aim))


def build_terms(network: CostNetwork, path: CostedPath) -> tuple[ChainTerm, ...]:
    """Return the terms of a path's bound: waiting, response, link, each with its reason and place."""
    steps = network.steps
    name = network.names[path.start]
    start_delay = steps.start_delay(name)
    chain_terms = [
        ChainTerm(name, start_delay.value, network.start_response(name), ZERO_VALUE, start_delay.why, start_delay.at)
    ]
    counting = name
    for arc in (network.arcs[arc_index] for arc_index in path.arcs):
        step_delay, response, why = steps.sampling_delay(arc), network.step_response(arc), ""
        own_time = steps.response_value(arc.target).value
        if not steps.continues_run(arc, network.runs):
            counting = arc.target
        elif response.value is not None and (own_time is None or response.value < own_time):
            why = f", {'the rest of its time' if response.value else 'its time'} counted at {counting}"
        chain_terms.append(
            ChainTerm(
                arc.target,
                step_delay.value,
                response,
                steps.link_latency(arc),
                step_delay.why + why,
                step_delay.at,
                counting if why else "",
            )
        )
    return tuple(chain_terms)


def _build_result(
    network: CostNetwork,
    regions: Sequence[RouteRegion],
    asked_chain: Chain,
    chain_points: Sequence[ChainPoint],
) -> ChainResult:
    """Return all figures of a chain, with the terms of its worst path; without terms where there is no path."""
    deadline = TimingValue(asked_chain.deadline.value) if asked_chain.deadline else None
    extreme_path = find_extreme_path(network, regions, "bound")
    if asked_chain.unresolved or extreme_path is None:
        waypoint_ids = tuple(point.id for point in asked_chain.through)
        no_bound = (
            _unresolved_value(asked_chain.unresolved)
            if asked_chain.unresolved
            else _unconnected_value(network, asked_chain, chain_points)
        )
        shares = judge_shares(no_bound, no_bound, asked_chain)
        return ChainResult(
            asked_chain.id, waypoint_ids, (), no_bound, no_bound, no_bound, no_bound, deadline, "open", shares
        )
    view, path, path_bound = extreme_path
    bound = _note_event_start(network, path, _note_reentrant_end(network, path, path_bound))
    bound = _note_measured(network, path, bound)
    best = find_extreme_value(network, regions, "best")
    event_ages = _ages_from_events(network, regions, chain_points[0].activities)
    return ChainResult(
        id=asked_chain.id,
        through=(network.names[path.start], *(network.arcs[arc_index].target for arc_index in path.arcs)),
        terms=build_terms(view, path),
        bound=bound,
        best=best,
        reduced_reaction=find_extreme_value(network, regions, "reduced reaction"),
        reduced_age=_limit_reduced_age(find_extreme_value(network, regions, "reduced age"), bound, event_ages),
        deadline=deadline,
        verdict=judge_deadline(bound, best, deadline),
        shares=judge_shares(bound, best, asked_chain),
    )


def _unresolved_value(words: tuple[str, ...]) -> TimingValue:
    """Return the value of a chain with words that name nothing."""
    assumptions = tuple(f"`{word}` is not resolved" for word in words)
    return TimingValue(None, complete=False, missing=words, assumptions=assumptions)


def _unconnected_value(network: CostNetwork, asked_chain: Chain, chain_points: Sequence[ChainPoint]) -> TimingValue:
    """Return the value of a chain without a path, which names the first two elements that no path joins."""
    for (source, target), pair in zip(pairwise(asked_chain.through), pairwise(chain_points), strict=True):
        regions = chain_regions.lay_out_between(network, pair)
        path_set = find_aimed_paths(network, regions, "bound") if regions else None
        if path_set is None or next(path_set.best_paths(), None) is None:
            gap = f"no way leads from `{source.id}` to `{target.id}`"
            return TimingValue(None, complete=False, assumptions=(gap,))
    # Each two are joined, but not by paths that meet in one and the same activity of the element between them.
    return TimingValue(None, complete=False, assumptions=("no way leads through all elements",))


def _note_event_start(network: CostNetwork, path: CostedPath, bound: TimingValue) -> TimingValue:
    """Note on a chain that begins with an event that reaction time and data age differ, and by how much."""
    first_id = network.names[path.start]
    if network.steps.analysis.system.activities[first_id].behaviour not in {"event", "on_demand"}:
        return bound
    gap = network.steps.arrivals.activation_gap(first_id)
    gap_text = (
        figure_wording.format_duration(gap.value)
        if gap.value is not None and is_known_bound(gap)
        else f"unknown for {first_id}"
    )
    assumption = (
        f"the reaction counts from the event that fires {first_id}; data age is larger by its largest gap ({gap_text})"
    )
    return replace(bound, assumptions=(*bound.assumptions, assumption))


def _note_reentrant_end(network: CostNetwork, path: CostedPath, bound: TimingValue) -> TimingValue:
    """Note on a chain whose last element runs beside itself that what it began earlier may replace what it sent."""
    last_id = network.arcs[path.arcs[-1]].target if path.arcs else network.names[path.start]
    wait = network.steps.replacing_wait(network.steps.analysis.system.activities[last_id])
    if wait is ZERO_VALUE or not is_known_bound(bound):
        return bound
    wait_text = figure_wording.format_duration(wait.value) if wait.value is not None else "by an unknown time"
    assumption = f"{last_id} runs beside itself, and may send older data after newer: data age is larger ({wait_text})"
    return replace(bound, assumptions=(*bound.assumptions, assumption))


def _note_measured(network: CostNetwork, path: CostedPath, bound: TimingValue) -> TimingValue:
    """Note on a chain which measured execution times its bound rests on."""
    through = (network.names[path.start], *(network.arcs[arc_index].target for arc_index in path.arcs))
    note = network.find_measured_basis().describe(through)
    return replace(bound, assumptions=(*bound.assumptions, note)) if note else bound


def find_data_age(network: CostNetwork, result: ChainResult) -> TimingValue:
    """Return the largest age of what a chain makes of a sample, until the next one replaces it.

    It is the bound where the first element samples the world, and the last one sends in the order of its activations.
    Where an event is the stimulus, the next one may be a gap away, which comes on top; so does the time for which what
    a reentrant element began earlier may stand in the place of what it sent.
    """
    if not result.terms:
        return result.bound
    activities = network.steps.analysis.system.activities
    waits = [network.steps.replacing_wait(activities[result.through[-1]])]
    if activities[result.through[0]].behaviour != "periodic":
        waits.append(network.steps.arrivals.activation_gap(result.through[0]))
    waits = [wait for wait in waits if wait is not ZERO_VALUE]
    return sum_bounds((result.bound, *waits)) if waits else result.bound


def _limit_reduced_age(reduced_age: TimingValue, bound: TimingValue, event_ages: Iterable[TimingValue]) -> TimingValue:
    """Return the age of what is sent: never more than it may become before the next output replaces it."""
    if is_known_bound(reduced_age) and reduced_age.value is not None and reduced_age.value <= (bound.value or 0):
        return reduced_age
    data_ages = [bound, *event_ages]
    if all(map(is_known_bound, data_ages)):
        return smallest_value((reduced_age, max(data_ages, key=lambda value: value.value or 0)))
    # A data age that is not known yet limits nothing but what has no bound at all.
    can_limit = is_boundless(reduced_age) and not any(map(is_boundless, data_ages))
    return largest_value(data_ages) if can_limit else reduced_age


def _ages_from_events(
    network: CostNetwork, regions: Sequence[RouteRegion], start_ids: Sequence[str]
) -> Iterator[TimingValue]:
    """Yield the largest data age from each event that may be a chain's stimulus: until the result of the next one."""
    system = network.steps.analysis.system
    for name in start_ids:
        start = replace(regions[0], members=frozenset({network.vertex_of[name]}), inside=False)
        # A path begins with the samples of its first element where those fire the rest of it.
        is_inner = regions[0].inside and chain_regions.is_fired_by_samples(system, name, start_ids)
        is_event = system.activities[name].behaviour != "periodic" and not is_inner
        extreme_path = find_extreme_path(network, (start, *regions[1:]), "bound") if is_event else None
        if extreme_path is not None:
            yield sum_bounds((extreme_path.value, network.steps.arrivals.activation_gap(name)))
