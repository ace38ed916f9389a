"""What the bound of a chain lacks, in words: figures that nobody wrote, links that are not there, what is overloaded.

Where the search found no bound: on which host, at which load, and what was analysed there.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction

from archgen.diagnostics.common_wording import join_first, join_words
from archgen.frozen import dataclass
from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.chains.chain_bounds import JudgedChain
from archgen.timing.chains.trigger_arrivals import TriggerArrivals
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import (
    NO_MATCH_NOTE,
    NO_USE_NOTE,
    SATURATED_NOTE,
    UNLINKED_NOTE,
    ResponseTier,
    TimingValue,
    is_boundless,
    is_unfound,
)
from archgen.timing.load.host_loads import activity_share
from archgen.timing.system.core_placement import is_missing_cores
from archgen.timing.system.timing_system import TimingSystem

_TIER_PHRASES: Mapping[ResponseTier, str] = {
    "dedicated": "each on a core of its own",
    "host": "in any order",
    "priorities": "by their priorities",
    "executor": "one thread in any order",
    "cores": "several cores in any order",
    "whole host": "several cores as one",
    "whole way": "ways over hosts as wholes",
}
"""What was analysed, by how responses were asked for."""


@dataclass(frozen=True, slots=True)
class UnfoundPlace:
    """A host (None: cores of their own) without bounds for some activities; `load` is the share of all its cores."""

    host: str | None
    activities: tuple[str, ...]
    load: TimingValue | None
    tiers: tuple[ResponseTier, ...]

    @property
    def load_text(self) -> str:
        """Return ` at a load of 40 %`; empty where the load is not known."""
        known_load = self.load.value if self.load else None
        return "" if known_load is None else f" at a load of {figure_wording.format_share(known_load)}"


def find_unfound_places(analysis: Analysis, terms: Iterable[ChainTerm]) -> tuple[UnfoundPlace, ...]:
    """Return where the search for a chain's bound found none: the hosts where that begins, not those it spreads to."""
    term_list = tuple(terms)
    if not any(is_unfound(value) for term in term_list for value in (term.sampling, term.response, term.link)):
        return ()
    names = [term.activity for term in term_list if is_unfound(term.response)]
    # Only a gap: what fires the elements of the chain stands elsewhere.
    places = group_by_host(analysis, names or analysis.diverged)
    unfound_ids = {name for name, response in analysis.responses.items() if is_unfound(response.worst)}
    # Where each host of the chain is fed by another one without bounds, it begins off the chain.
    for candidates in (places, group_by_host(analysis, analysis.diverged)):
        first_places = tuple(place for place in candidates if not _is_fed(analysis, place, unfound_ids))
        if first_places:
            return first_places
    return places


def group_by_host(analysis: Analysis, names: Iterable[str]) -> tuple[UnfoundPlace, ...]:
    """Return the hosts of activities for which no bound was found."""
    names_by_host: dict[str | None, list[str]] = {}
    for name in names:
        names_by_host.setdefault(analysis.system.activities[name].host, []).append(name)
    return tuple(
        UnfoundPlace(
            host,
            tuple(host_names),
            load.share_of_cores if (load := analysis.hosts.get(host or "")) else None,
            tuple(dict.fromkeys(analysis.responses[name].tier for name in host_names)),
        )
        for host, host_names in names_by_host.items()
    )


def _is_fed(analysis: Analysis, place: UnfoundPlace, unfound_ids: set[str]) -> bool:
    """Whether something without a bound on another host fires what is on a place: then the trouble may come from there."""
    activities, arrivals = analysis.system.activities, TriggerArrivals(analysis)
    return any(
        arc.source in unfound_ids and activities[arc.source].host != place.host and arrivals.fires_reader(arc)
        for name in place.activities
        for arc in analysis.system.arcs_into.get(name, ())
    )


def describe_unfound_places(places: Iterable[UnfoundPlace]) -> str:
    """Say where no bound was found: `on cpu at a load of 40 % (one thread in any order)`; empty for no place."""
    return join_words([_describe_place(place) for place in places])


def _describe_place(place: UnfoundPlace) -> str:
    subject = f"on {place.host}{place.load_text}" if place.host else f"for {join_first(place.activities)}"
    phrases = join_words([phrase for tier in place.tiers if (phrase := _TIER_PHRASES.get(tier))])
    return f"{subject} ({phrases})" if phrases else subject


def find_overloaded_places(
    analysis: Analysis, terms: Iterable[ChainTerm]
) -> dict[str, tuple[tuple[str, TimingValue], ...]]:
    """Return the hosts and resources that have more to do than they can, and that a step of a chain needs.

    With each the share of a core, or of the resource, that each activity takes.
    """
    activities = [analysis.system.activities[term.activity] for term in terms if is_boundless(term.response)]
    hosts = {activity.host: analysis.hosts[activity.host] for activity in activities if activity.host is not None}
    resources = {name: analysis.resources[name] for activity in activities for name in activity.uses}
    shares = {host: load.activity_shares for host, load in hosts.items() if load.verdict == "overload"}
    return shares | {name: load.shares for name, load in resources.items() if load.verdict == "overload"}


def find_saturated_links(terms: Iterable[ChainTerm]) -> tuple[str, ...]:
    """Return the links of a chain over which more is sent than they carry."""
    notes = dict.fromkeys(note for term in terms for note in term.link.assumptions)
    return tuple(note.removeprefix(f"{SATURATED_NOTE}: ") for note in notes if note.startswith(SATURATED_NOTE))


def find_overloaded_elements(analysis: Analysis, terms: Iterable[ChainTerm]) -> dict[str, Fraction]:
    """Return the elements of a chain that are fired again before they are done, with the share of a core that each takes.

    What runs where more is to be done than can be is left out: the host is told.
    """
    term_list = tuple(terms)
    places = find_overloaded_places(analysis, term_list)
    shares: dict[str, Fraction] = {}
    for name in (term.activity for term in term_list if is_boundless(term.response)):
        share = activity_share(analysis.system, name, analysis.paces[name]).value
        if share is not None and share >= 1 and analysis.system.activities[name].host not in places:
            shares[name] = share
    return shares


def describe_overload(analysis: Analysis, terms: Iterable[ChainTerm], quote: str = "") -> str:
    """Say what of a chain has more to do or to carry than it can: `more is to be done on pc than can be`; empty for nothing."""
    term_list = tuple(terms)
    places = (
        ("done on", tuple(find_overloaded_places(analysis, term_list))),
        ("sent over", find_saturated_links(term_list)),
        ("done by", tuple(find_overloaded_elements(analysis, term_list))),
    )
    phrases = [f"{verb} {join_words([f'{quote}{name}{quote}' for name in names])}" for verb, names in places if names]
    return f"more is to be {join_words(phrases)} than can be" if phrases else ""


_HOST_SEPARATOR = " - "
"""What stands between the names of two hosts that no link joins, where a link's name would stand."""


def describe_gaps(result: ChainResult, analysis: Analysis) -> str:
    """Return what a chain's bound lacks: `no bound: execution time of x, y unknown`; empty where it lacks nothing."""
    overloaded = [*find_overloaded_places(analysis, result.terms), *find_saturated_links(result.terms)]
    overloaded += find_overloaded_elements(analysis, result.terms)
    if overloaded:
        return f"{join_words(overloaded)} {'is' if len(overloaded) == 1 else 'are'} overloaded"
    if result.bound.complete:
        return ""
    phrases = list_missing_figures(result, analysis)
    unfound_text = describe_unfound_places(find_unfound_places(analysis, result.terms))
    if not phrases:
        return f"{_describe_basis(result)}no bound found {unfound_text}" if unfound_text else "no bound"
    phrases += [f"none found {unfound_text}"] if unfound_text else []
    return f"{_describe_basis(result)}no bound: {'; '.join(phrases)}"


def list_missing_figures(result: ChainResult | JudgedChain, analysis: Analysis) -> list[str]:
    """Return what nobody wrote of a chain whose bound lacks something, a phrase for each quantity."""
    phrases = [*_describe_unknown_figures(result, analysis.system), *_describe_unlinked(result, analysis.system)]
    named_elements = {
        name
        for term in result.terms
        for term_value in (term.sampling, term.response, term.link)
        for name in term_value.missing
    }
    # The bound is the maximum over all ways, the terms are those of one of them.
    elsewhere = tuple(
        name for name in result.bound.missing if name not in named_elements and not is_missing_cores(name)
    )
    if elsewhere and result.terms:
        phrases.append(f"on other ways, figures of {join_first(elsewhere)} unknown")
    notes = (NO_MATCH_NOTE, NO_USE_NOTE)
    return phrases + [text for text in result.bound.assumptions if not result.terms or text.split(":")[0] in notes]


def _describe_unknown_figures(result: ChainResult | JudgedChain, system: TimingSystem) -> Iterable[str]:
    """Yield what figures nobody wrote, and of which elements and links.

    A response is also unknown where that of a neighbour is, or where its search diverged: then the missing names are
    those of elements whose execution time is written.
    """
    timed_names = {a.id for a in system.activities.values() if a.wcet is not None or a.response is not None}
    paced_names = {a.id for a in system.activities.values() if a.period is not None}
    links = _list_missing(term.link for term in result.terms)
    responses = _list_missing(term.response for term in result.terms)
    # An unknown latency makes the waiting time unknown as well: it is named once, as a latency.
    periods = [
        name
        for name in _list_missing(term.sampling for term in result.terms)
        if name not in links and name not in paced_names and name in system.activities
    ]
    times = [name for name in responses if name not in timed_names and name in system.activities]
    cores = [name for name in dict.fromkeys([*responses, *links, *result.bound.missing]) if is_missing_cores(name)]
    latencies = dict.fromkeys([*links, *(name for name in responses if name not in system.activities)])
    link_names = [name for name in latencies if _HOST_SEPARATOR not in name and not is_missing_cores(name)]
    for quantity, names in (("period or rate", periods), ("execution time", times), ("latency", link_names)):
        if names:
            yield f"{quantity} of {join_first(tuple(names))} unknown"
    yield from (f"{name} not written" for name in cores)


def _describe_unlinked(result: ChainResult | JudgedChain, system: TimingSystem) -> Iterable[str]:
    """Yield which hosts no link joins, where a message between them is on the way, or a response depends on one."""
    pairs = [name.split(_HOST_SEPARATOR) for name in _list_missing(term.link for term in result.terms)]
    unlinked_pairs = dict.fromkeys(tuple(sorted(pair)) for pair in pairs if len(pair) > 1)
    yield from (f"no link joins {' and '.join(pair)}" for pair in unlinked_pairs)
    values = [value for term in result.terms for value in (term.sampling, term.response)]
    names = _list_missing(value for value in values if UNLINKED_NOTE in value.assumptions)
    hosts = dict.fromkeys(
        activity.host for name in names if (activity := system.activities.get(name)) and activity.host
    )
    if hosts and not unlinked_pairs:
        yield f"no link joins {join_words(list(hosts))}"


def _list_missing(values: Iterable[TimingValue]) -> list[str]:
    return list(dict.fromkeys(name for value in values for name in value.missing if not value.complete))


def _describe_basis(result: ChainResult) -> str:
    if result.bound.value is None:
        return ""
    values = [value for term in result.terms for value in (term.response, term.link)]
    return "(what is known) " if any(value.value for value in values) else "(periods only) "
