"""Verdicts on timing: how an architecture does in a few sentences, what is late and why, and a table of all chains."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.timing.analysis import ChainResult
from archgen.timing.chains.chain_advice import advise_on_chain, sum_known_parts
from archgen.timing.chains.chain_verdicts import VERDICT_MEANINGS
from archgen.timing.chains.missing_figures import UnfoundPlace, group_by_host
from archgen.timing.figures.timing_values import TimingValue, is_known_bound
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Bullets, Inlines, Paragraph, Table, Text, make_columns
from archgen.views.timing import chain_charts, chain_status, load_charts, timing_tables, value_format
from archgen.views.timing.timing_lookup import TimingLookup


def summarize_verdicts(timing_lookup: TimingLookup) -> Paragraph:
    """Summarize in a few sentences how many rates are known and how many chains meet their deadlines."""
    sentences: list[str] = []
    if timing_lookup.chains:
        verdicts = [
            "without a deadline" if chain_status.lacks_deadline(result) else result.verdict
            for result in timing_lookup.chains
        ]
        counts = [
            (name, verdicts.count(name)) for name in ("met", "missed", "not proven", "open", "without a deadline")
        ]
        verdict_counts = ", ".join(f"{count} {name}" for name, count in counts if count)
        sentences.append(
            f"Of {inline_text.count_noun(len(timing_lookup.chains), 'chain')} of effect: {verdict_counts}."
        )
    activity_rates = timing_lookup.analysis.paces.values()
    # What runs on demand or once has no rate by nature, so it is not counted as a gap.
    known_count = sum(pace.rate.value is not None or pace.behaviour in {"on_demand", "once"} for pace in activity_rates)
    sentences.append(
        f"Of {inline_text.count_noun(len(activity_rates), 'activity')}, {known_count} have a known rate or run on demand or once."
    )
    sentences.append("All bounds are safe for the figures written; what they rest on beside them stands with each.")
    return Paragraph(inline_text.to_inlines(" ".join(sentences)))


def list_late_elements(lookup: Lookup, timing_lookup: TimingLookup) -> Iterator[Block]:
    """List chains that miss their deadline or have no bound, then overloaded hosts, with the reasons."""
    chains = [
        (
            Text(lookup.architecture.chains[result.id].title, ref=f"chain:{result.id}"),
            " ".join(_describe_late_chain(result, timing_lookup)),
        )
        # Certain misses come before what may be late.
        for verdict in ("missed", "not proven", "open")
        for result in timing_lookup.chains
        if result.verdict == verdict
        and not chain_status.lacks_deadline(result)
        and result.id in lookup.architecture.chains
    ]
    hosts = [
        (Text(lookup.architecture.hosts[name].title, ref=f"host:{name}"), load_charts.describe_load(load))
        for name, load in timing_lookup.analysis.hosts.items()
        if load.verdict == "overload"
    ]
    if chains or hosts:
        yield Bullets(
            tuple(
                (link, *inline_text.message_to_inlines(f". {verdict_text}")) for link, verdict_text in (*chains, *hosts)
            )
        )


def list_troubled_chains(lookup: Lookup) -> list[ChainResult]:
    """Return the chains that are not shown to meet their deadline, or without one lack figures, the worst first."""
    return [
        result
        for result in (lookup.timing.chains if lookup.timing else ())
        if result.verdict != "met" and not (chain_status.lacks_deadline(result) and is_known_bound(result.bound))
    ]


def list_silent_chains(lookup: Lookup) -> list[ChainResult]:
    """Return the chains that are not shown to meet their deadline, and that no finding is about."""
    return [result for result in list_troubled_chains(lookup) if result.id not in lookup.findings_of]


def _describe_late_chain(result: ChainResult, timing_lookup: TimingLookup) -> Iterator[str]:
    """Yield by how much a chain is late, what takes most and why, and what is missing."""
    advice = advise_on_chain(timing_lookup.analysis, result)
    if advice is None:
        yield chain_charts.describe_chain_verdict(result, timing_lookup)
    else:
        yield f"{result.verdict.capitalize()}."
        yield from filter(None, advice)


def explain_verdict_words(timing_lookup: TimingLookup) -> Iterator[Block]:
    """Explain the verdicts that chains have."""
    verdicts = {result.verdict for result in timing_lookup.chains if result.deadline}
    phrases = [f"{word.capitalize()}: {meaning}." for word, meaning in VERDICT_MEANINGS.items() if word in verdicts]
    if phrases:
        bound_sentence = "A bound is what the time from a change in the world to the reaction is never above."
        yield Paragraph(inline_text.to_inlines(" ".join((bound_sentence, *phrases))))


def list_trigger_troubles(timing_lookup: TimingLookup) -> Iterator[Block]:
    """List rings of triggers that never end or never start."""
    analysis = timing_lookup.analysis
    kinds = (
        ("An event that enters circulates for ever among", analysis.endless),
        ("Each waits for the other, and none ever starts:", analysis.deadlocked),
    )
    for lead, rings in kinds:
        if rings:
            yield Paragraph(inline_text.to_inlines(lead), "error")
            yield Bullets(
                tuple(
                    inline_text.join_inlines((timing_tables.activity_link(timing_lookup, name) for name in ring), " → ")
                    for ring in rings
                )
            )


def list_unfound_bounds(lookup: Lookup, timing_lookup: TimingLookup) -> Iterator[Block]:
    """List the hosts on which no bound was found for some activities: one line for each host, with its load."""
    analysis = timing_lookup.analysis
    places = group_by_host(analysis, analysis.diverged)
    if places:
        yield Paragraph(inline_text.to_inlines("There may be bounds, but none was found:"), "error")
        yield Bullets(tuple(_describe_unfound_place(lookup, timing_lookup, place) for place in places))


def _describe_unfound_place(lookup: Lookup, timing_lookup: TimingLookup, place: UnfoundPlace) -> Inlines:
    names = inline_text.join_inlines(
        (timing_tables.activity_link(timing_lookup, name) for name in place.activities), ", "
    )
    if place.host is None:
        return names
    host_link = Text(lookup.architecture.hosts[place.host].title, ref=f"host:{place.host}")
    return inline_text.to_inlines(host_link, f"{place.load_text}: ", *names)


def make_bound_table(lookup: Lookup, timing_lookup: TimingLookup) -> Table | None:
    """List chains with bound, best case, largest step and verdict."""
    rows = tuple(
        (
            inline_text.to_inlines(Text(lookup.architecture.chains[result.id].title, ref=f"chain:{result.id}")),
            timing_tables.duration_cell(result.bound),
            timing_tables.lower_bound_cell(result.best),
            _largest_step(timing_lookup, result),
            timing_tables.deadline_cell(result),
            chain_status.margin_cell(result),
            chain_status.verdict_chip(result),
            inline_text.to_inlines(value_format.describe_missing(result.bound, timing_lookup.analysis, 3)),
        )
        for result in timing_lookup.chains
        if result.id in lookup.architecture.chains
    )
    columns = make_columns(
        ("Chain", 1.6),
        ("At the latest", 0.9, "right"),
        ("At the earliest", 0.9, "right"),
        ("Largest step", 1.5),
        ("Deadline", 0.8, "right"),
        ("Margin", 0.8, "right"),
        ("Verdict", 0.7),
        ("Figures missing", 1.6),
    )
    # The same anchor as `make_chain_table`, which this table replaces; only one of them is ever in a document.
    return (
        timing_tables.drop_blank_columns(Table("table:chains", "Chains of effect: bounds and deadlines", columns, rows))
        if rows
        else None
    )


def _largest_step(timing_lookup: TimingLookup, result: ChainResult) -> Inlines:
    """Name the step with the largest part of a chain's bound: the first one to look at."""
    sums = [(sum_known_parts(term), term.activity) for term in result.terms]
    largest_sum = max((value for value, _ in sums), default=Fraction(0))
    if not largest_sum:
        return ()
    # Of equal steps the first one in the chain.
    name = next(name for value, name in sums if value == largest_sum)
    return inline_text.to_inlines(
        *timing_tables.activity_link(timing_lookup, name), f" {value_format.display_duration(TimingValue(largest_sum))}"
    )
