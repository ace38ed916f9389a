"""What the timing analysis found about one element: a chain, a node, a component, a host or a topic."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.model.node import Node
from archgen.timing.analysis import ChainResult, Tier
from archgen.timing.system import Activity
from archgen.timing.value import Value
from archgen.views import charts, figures, loads, paces, timing, words
from archgen.views.index import Index
from archgen.views.shapes import Block, Column, Facts, Figure, Inlines, Table, Text
from archgen.views.timed import Timed


def chain_blocks(view: Index, timed: Timed, result: ChainResult) -> tuple[Block, ...]:
    """Describe the timing of one chain: facts, the chart of its terms, and each term with its reason."""
    chain = view.architecture.chains[result.id]
    found = view.architecture
    facts: list[tuple[str, Inlines]] = [
        ("Through", words.joined((timing.named(timed, name) for name in result.through), " → ")),
        ("Verdict", words.text(charts.verdict(result, timed))),
        ("Reaction time and data age, at the latest", words.text(figures.whole(result.bound, timed.analysis))),
        ("At the earliest", timing.figure(figures.least(result.best))),
        ("Reaction time without the first wait", timing.figure(figures.duration(result.reduced_reaction))),
        ("Data age, from the first reading on", timing.figure(figures.duration(result.reduced_age))),
        ("Requirements", words.joined(words.requirement_link(found, name)[:1] for name in chain.requirements)),
        ("Assumptions", words.text("; ".join(dict.fromkeys(_assumed(timed, result))))),
    ]
    name = f"chains/{result.id}"
    title = f"{chain.title}: how the time adds up"
    rows = tuple(_term(timed, result, at) for at in range(len(result.terms)))
    columns = (
        Column("Activity", 1.6),
        Column("Waits", 0.85, "right"),
        Column("Responds", 0.85, "right"),
        Column("Link", 0.7, "right"),
        Column("Why", 1.8),
        Column("Place", 1.4),
    )
    return (
        Facts(tuple((key, value) for key, value in facts if value and not timing.blank(value))),
        Figure(f"figure:{name}", name, title, charts.verdict(result, timed)),
        *([Table(f"table:{name}", f"{chain.title}: terms of the bound", columns, rows)] if rows else []),
    )


def _assumed(timed: Timed, result: ChainResult) -> Iterator[str]:
    """Yield the assumptions of a bound in words.

    Tiers of responses name their activities, so the analysis' own words for the same assumption are left out.
    """
    tiers: dict[Tier, list[str]] = {}
    for term in result.terms:
        response = timed.analysis.responses.get(term.activity)
        if response and response.tier in {"declared", "dedicated"}:
            tiers.setdefault(response.tier, []).append(term.activity)
    # These texts must equal the assumptions that the timing analysis writes, or both versions appear in the report.
    said = {f"the response of {name} is as declared" for name in tiers.get("declared", ())}
    said |= {"assuming a dedicated core"} if "dedicated" in tiers else set()
    yield from (word for word in result.bound.assumptions if word not in said)
    yield from (f"{timing.TIERS[tier]}: {', '.join(dict.fromkeys(names))}" for tier, names in tiers.items())


def _term(timed: Timed, result: ChainResult, at: int) -> tuple[Inlines, ...]:
    term = result.terms[at]
    return (
        timing.named(timed, term.activity),
        _part(term.sampling),
        _part(term.response),
        _part(term.link),
        words.text(term.why),
        words.text(Text(timing.place(term.at), code=True)) if timing.place(term.at) else (),
    )


def _part(value: Value) -> Inlines:
    return timing.figure(figures.duration(value))


def node_facts(view: Index, node: Node) -> Iterator[tuple[str, Inlines]]:
    """Yield how often each activity of a node runs, and within what time it responds."""
    timed = view.timed
    if timed is None:
        return
    mine = timed.of_node.get(node.id, ())
    for activity in mine:
        # Only a node with several activities needs to tell them apart.
        suffix = f" of {activity.id.rsplit('.', 1)[-1]}" if len(mine) > 1 else ""
        yield from _facts(timed, activity, timed.origins.get(activity.id, ()), suffix)


def _facts(timed: Timed, activity: Activity, origin: tuple[str, ...], suffix: str) -> Iterator[tuple[str, Inlines]]:
    """Yield rate and response of one activity, as far as they are known."""
    pace, response = timed.analysis.paces.get(activity.id), timed.analysis.responses.get(activity.id)
    if pace and (said := paces.said(pace)) != "?":
        # A written rate needs no source here: the fact `Timing` beside it says what was written.
        source = timing.source(timed, activity, pace, origin) if pace.inferred else ()
        yield f"Rate{suffix}", (*words.text(said), *((Text(", "), *source) if source else ()))
    if response and response.worst.value is not None:
        tier = f" ({timing.TIERS[response.tier]})" if timing.TIERS[response.tier] else ""
        yield f"Response{suffix}", words.text(f"within {figures.duration(response.worst)}{tier}")


def component_fact(view: Index, nodes: Iterable[Node], component: str) -> Inlines:
    """Describe how often the activities of a component run: `10 Hz, from scanner`."""
    timed = view.timed
    if timed is None:
        return ()
    name = component.rsplit(".", 1)[-1]
    mine = [activity for node in nodes for activity in timed.of_node.get(node.id, ())]
    # A node may implement several components, and an activity names its component by full id, by short name, or not at
    # all.
    found = [activity for activity in mine if activity.component in {None, name, component}]
    lines = []
    for activity in found:
        pace = timed.analysis.paces.get(activity.id)
        if pace and (said := paces.sentence(pace, timed.origins.get(activity.id, ()))):
            lines.append(words.text(f"{activity.id}: {said}" if len(found) > 1 else said))
    return words.lines(lines)


def host_blocks(view: Index, host: str) -> tuple[Block, ...]:
    """Return the chart of a host's load, activity by activity; empty where nothing runs on the host."""
    timed = view.timed
    load = timed.analysis.hosts.get(host) if timed else None
    if load is None or not load.parts:
        return ()
    title = f"{view.architecture.hosts[host].title}: load by activity"
    return (Figure(f"figure:load/{host}", f"load/{host}", title, loads.load_verdict(load)),)


def topic_facts(view: Index, name: str) -> list[tuple[str, Inlines]]:
    """Return the traffic of a topic in bytes per second; empty where it is not known."""
    load = view.timed.analysis.topics.get(name) if view.timed else None
    if load is None or load.published.value is None:
        return []
    said = f"{figures.traffic(load.published)} published"
    if load.delivered.value is not None:
        said += f", {figures.traffic(load.delivered)} delivered to all readers"
    return [("Traffic", words.text(said))]
