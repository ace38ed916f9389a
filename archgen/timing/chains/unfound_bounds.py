"""Where the search found no bound: on which host, at which load, and what was analysed there."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from archgen.diagnostics.common_wording import join_first, join_words
from archgen.frozen import dataclass
from archgen.timing.analysis import Analysis, ChainTerm
from archgen.timing.chains.trigger_arrivals import TriggerArrivals
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import ResponseTier, TimingValue
from archgen.timing.figures.value_arithmetic import SATURATED_NOTE, is_boundless, is_unfound

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


def describe_overload(analysis: Analysis, terms: Iterable[ChainTerm], quote: str = "") -> str:
    """Say what of a chain has more to do or to carry than it can: `more is to be done on pc than can be`; empty for nothing."""
    term_list = tuple(terms)
    places = (
        ("done on", tuple(find_overloaded_places(analysis, term_list))),
        ("sent over", find_saturated_links(term_list)),
    )
    phrases = [f"{verb} {join_words([f'{quote}{name}{quote}' for name in names])}" for verb, names in places if names]
    return f"more is to be {join_words(phrases)} than can be" if phrases else ""
