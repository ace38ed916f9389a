"""What the timing analysis found about one element: a chain, a node, a component, a host or a topic."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator

from archgen.model.node import Node
from archgen.timing.analysis import ChainResult
from archgen.timing.chains.chain_advice import advise_on_chain
from archgen.timing.figures.timing_values import ResponseTier, TimingValue, list_assumptions
from archgen.timing.system.timing_system import Activity
from archgen.views import element_references, inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Fact, Figure, Inlines, Table, Text, make_columns, show_facts
from archgen.views.timing import chain_charts, load_charts, timing_tables, use_tables, value_format
from archgen.views.timing.chain_charts import make_late_run_figures
from archgen.views.timing.flow_tables import list_activities
from archgen.views.timing.timing_lookup import TimingLookup

"""How many of those whose work a response waits for are named."""
_NAME = re.compile(r"((?<![\w/.])/[\w/]++|(?<![\w/.])[a-z0-9.]++(?:_[a-z0-9.]++)++)")


def make_whole_fact(lookup: Lookup, component_id: str) -> Inlines:
    """Return the worst way through a composed component that says how long it takes; empty for any other."""
    bound = lookup.timing.whole_bounds.get(component_id) if lookup.timing else None
    if bound is None or lookup.timing is None:
        return ()
    duration = value_format.display_bound(bound.duration, lookup.timing.analysis)
    way = inline_text.join_inlines((timing_tables.activity_link(lookup.timing, name) for name in bound.through), " → ")
    return (Text(f"{duration}: "), *way)


def make_chain_blocks(
    lookup: Lookup, timing_lookup: TimingLookup, result: ChainResult, without: Collection[str] = ()
) -> tuple[Block, ...]:
    """Describe the timing of one chain: facts without those of some keys, the chart of its terms, and each term with its
    reason.
    """
    chain = lookup.architecture.chains[result.id]
    architecture = lookup.architecture
    facts = [
        Fact(
            "",
            "Through",
            inline_text.join_inlines(
                (timing_tables.activity_link(timing_lookup, name) for name in result.through), " → "
            ),
        ),
        Fact("verdict", "Verdict", inline_text.to_inlines(chain_charts.describe_chain_verdict(result, timing_lookup))),
        *_list_advice(lookup, timing_lookup, result),
        Fact(
            "latest",
            "Reaction time and data age, at the latest",
            inline_text.to_inlines(value_format.display_bound(result.bound, timing_lookup.analysis)),
        ),
        Fact(
            "earliest",
            "At the earliest",
            timing_tables.lower_bound_cell(result.best),
        ),
        Fact(
            "",
            "From the earliest to the latest",
            () if result.spread is None else timing_tables.duration_cell(TimingValue(result.spread)),
        ),
        Fact(
            "",
            "Reaction time without the first wait",
            timing_tables.duration_cell(result.reduced_reaction),
        ),
        Fact(
            "",
            "Data age, from the first reading on",
            timing_tables.duration_cell(result.reduced_age),
        ),
        Fact(
            "requirements",
            "Requirements",
            inline_text.join_inlines(
                inline_text.requirement_link(architecture, name)[:1] for name in chain.requirements
            ),
        ),
        Fact(
            "assumptions",
            "Assumptions",
            link_names(lookup, timing_lookup, "; ".join(dict.fromkeys(describe_assumptions(timing_lookup, result)))),
        ),
    ]
    name = f"chains/{result.id}"
    title = f"{chain.title}: how the time adds up"
    rows = tuple(_term_row(lookup, timing_lookup, result, index) for index in range(len(result.terms)))
    columns = make_columns(
        ("Activity", 1.6),
        ("Waits", 0.85, "right"),
        ("Responds", 0.85, "right"),
        ("Link", 0.7, "right"),
        ("Why", 1.8),
        ("Place", 1.4),
    )
    return (
        show_facts((fact for fact in facts if not timing_tables.is_blank(fact.value)), without),
        Figure(f"figure:{name}", name, title, chain_charts.describe_chain_verdict(result, timing_lookup)),
        *make_late_run_figures(lookup, timing_lookup, result),
        *([Table(f"table:{name}", f"{chain.title}: parts of the bound", columns, rows)] if rows else []),
    )


def _list_advice(lookup: Lookup, timing_lookup: TimingLookup, result: ChainResult) -> Iterator[Fact]:
    """Yield what takes most of a chain that does not surely meet its deadline, and what is missing."""
    advice = advise_on_chain(timing_lookup.analysis, result)
    if advice is not None:
        yield Fact("why", "Why", link_names(lookup, timing_lookup, advice.largest_parts))
        if advice.first_step:
            yield Fact("advice", "What to do", inline_text.message_to_inlines(advice.first_step))


def describe_assumptions(timing_lookup: TimingLookup, result: ChainResult) -> Iterator[str]:
    """Yield the assumptions of a bound in words.

    Tiers of responses name their activities, so the analysis' own words for the same assumption are left out.
    """
    activities_by_tier: dict[ResponseTier, list[str]] = {}
    for term in result.terms:
        response = timing_lookup.analysis.responses.get(term.activity)
        if response and response.tier in {"declared", "dedicated"}:
            activities_by_tier.setdefault(response.tier, []).append(term.activity)
    # These texts must equal the assumptions that the timing analysis writes, or both versions appear in the report.
    redundant_words = {f"the response of {name} is as declared" for name in activities_by_tier.get("declared", ())}
    redundant_words |= {"assuming a dedicated core"} if "dedicated" in activities_by_tier else set()
    yield from (word for word in list_assumptions(result.bound) if word not in redundant_words)
    yield from (
        f"{timing_tables.TIER_WORDS[tier]}: {', '.join(dict.fromkeys(names))}"
        for tier, names in activities_by_tier.items()
    )


def link_names(lookup: Lookup, timing_lookup: TimingLookup, sentence: str) -> Inlines:
    """Return a sentence of the timing analysis with its activities as links to their nodes, and its topics as links."""
    activities, topics = timing_lookup.analysis.system.activities, lookup.architecture.topics
    # Split at names: even positions are what stands between them. A name without `_` may be a word of the sentence.
    parts = _NAME.split(sentence)
    return tuple(
        inline_text.topic_link(part)
        if index % 2 and part in topics
        else Text(part, ref=f"node:{activities[part].node}" if index % 2 and part in activities else None)
        for index, part in enumerate(parts)
        if part
    )


def _term_row(lookup: Lookup, timing_lookup: TimingLookup, result: ChainResult, index: int) -> tuple[Inlines, ...]:
    term = result.terms[index]
    return (
        timing_tables.activity_link(timing_lookup, term.activity),
        timing_tables.duration_cell(term.sampling),
        timing_tables.duration_cell(term.response),
        timing_tables.duration_cell(term.link),
        link_names(lookup, timing_lookup, term.why),
        (place,) if (place := element_references.place_run(lookup, term.at)) else (),
    )


def make_node_facts(lookup: Lookup, node: Node) -> Iterator[Fact]:
    """Yield how often each activity of a node runs, and within what time it responds, as facts of `activity`."""
    timing_lookup = lookup.timing
    if timing_lookup is None:
        return
    activities = timing_lookup.activities_of_node.get(node.id, ())
    for activity in activities:
        # Only a node with several activities needs to tell them apart.
        suffix = f" of {activity.id.rsplit('.', 1)[-1]}" if len(activities) > 1 else ""
        yield from _activity_facts(
            lookup, timing_lookup, activity, timing_lookup.rate_origins.get(activity.id, ()), suffix
        )


def _activity_facts(
    lookup: Lookup, timing_lookup: TimingLookup, activity: Activity, origin_ids: tuple[str, ...], suffix: str
) -> Iterator[Fact]:
    """Yield rate and response of one activity, as far as they are known."""
    pace, response = timing_lookup.analysis.paces.get(activity.id), timing_lookup.analysis.responses.get(activity.id)
    if pace and (rate_text := value_format.format_rate_words(pace)) != "?":
        # A written rate needs no source here: the fact `Timing` beside it says what was written.
        source = (
            timing_tables.describe_rate_source(lookup, timing_lookup, activity, pace, origin_ids)
            if pace.inferred
            else ()
        )
        rate = (*inline_text.to_inlines(rate_text), *((Text(", "), *source) if source else ()))
        yield Fact("activity", f"Rate{suffix}", rate)
    if response and response.worst.value is not None:
        yield Fact("activity", f"Response{suffix}", timing_tables.describe_response(timing_lookup, activity))
    yield from use_tables.list_use_facts(timing_lookup, activity, suffix)


def make_rate_fact(lookup: Lookup, nodes: Iterable[Node], component_id: str) -> Inlines:
    """Describe how often the activities of a component run: `10 Hz, from scanner`."""
    timing_lookup = lookup.timing
    if timing_lookup is None:
        return ()
    matching_activities = list_activities(lookup, nodes, component_id)
    lines = []
    for activity in matching_activities:
        pace = timing_lookup.analysis.paces.get(activity.id)
        if pace and (rate_text := value_format.format_rate_words(pace)) != "?":
            name = timing_tables.activity_link(timing_lookup, activity.id) if len(matching_activities) > 1 else ()
            origin_ids = timing_lookup.rate_origins.get(activity.id, ())
            source = (
                timing_tables.describe_rate_source(lookup, timing_lookup, activity, pace, origin_ids)
                if pace.inferred
                else ()
            )
            lines.append(
                (*name, Text(f": {rate_text}" if name else rate_text), *((Text(", "), *source) if source else ()))
            )
    return inline_text.join_lines(lines)


def make_load_blocks(lookup: Lookup, host_id: str) -> tuple[Block, ...]:
    """Return the chart of a host's load, activity by activity; empty where nothing runs on the host."""
    timing_lookup = lookup.timing
    load = timing_lookup.analysis.hosts.get(host_id) if timing_lookup else None
    # Without a number of cores there is no chart.
    if load is None or not load.activity_shares or load.cores is None:
        return ()
    title = f"{lookup.architecture.hosts[host_id].title}: load by activity"
    return (Figure(f"figure:load/{host_id}", f"load/{host_id}", title, load_charts.describe_load(load)),)


def make_traffic_facts(lookup: Lookup, topic_name: str) -> list[tuple[str, Inlines]]:
    """Return the traffic of a topic in bytes per second; empty where it is not known."""
    load = lookup.timing.analysis.topics.get(topic_name) if lookup.timing else None
    if load is None or load.published.value is None:
        return []
    traffic_text = f"{value_format.display_traffic(load.published)} published"
    if load.delivered.value is not None:
        traffic_text += f", {value_format.display_traffic(load.delivered)} delivered to all readers"
    return [("Traffic", inline_text.to_inlines(traffic_text))]
