"""What an element takes in and gives out, a row a flow; its chains, the time left to it, what no chain says; whom to talk to.

Site, cards and documents read the same rows.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from types import MappingProxyType

from archgen.diagnostics import join_words, order_naturally
from archgen.frozen import NamedTuple, replace
from archgen.model.component import Component
from archgen.model.element_ids import make_id, make_unique_id
from archgen.model.node import Endpoint, Node
from archgen.timing.analysis import ChainResult, ChainTerm
from archgen.timing.chains.chain_advice import sum_known_parts
from archgen.timing.chains.element_flows import ElementFlow, UnjudgedWay
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.figures.timing_values import TimingValue, sum_bounds, sum_fractions
from archgen.timing.rates.link_traffic import find_sending_rate
from archgen.timing.system.timing_system import Activity
from archgen.views import element_readers, element_references, inline_text
from archgen.views.lookup import Lookup, remember_views
from archgen.views.shapes import Block, Bullets, Inlines, Markdown, Paragraph, Section, Table, Text, make_columns
from archgen.views.timing import chain_status, timing_tables, value_format
from archgen.views.timing.timing_lookup import TimingLookup

_PARTNER_VERBS = (("gives", "takes"), ("calls", "answers"))
"""What another partner does with what comes in and goes out: with data, and with calls."""


class FlowRow(NamedTuple):
    """What is said of a flow: `port` of the element, `other` at the other end with its partner and the way of travel."""

    port: str
    other: Inlines
    topic: Inlines
    rate: Inlines
    gap: Inlines
    age: Inlines
    since_sensing: Inlines
    read: Inlines
    reading: str
    deadlines: Inlines
    type: Inlines
    """The type of what flows, empty where it has none."""


def list_activities(lookup: Lookup, nodes: Iterable[Node], component_id: str = "") -> list[Activity]:
    """Return the activities of nodes; of a component alone those that work for it."""
    if lookup.timing is None:
        return []
    activities = [each for node in nodes for each in lookup.timing.activities_of_node.get(node.id, ())]
    # A node may implement several components, and an activity names its component by full id, by short name, or not at
    # all.
    names = {None, component_id, component_id.rsplit(".", 1)[-1]}
    return [each for each in activities if not component_id or each.component in names]


def list_own_activities(lookup: Lookup, element: Node | Component) -> list[Activity]:
    """Return the activities of a node, or of a component; a composed one has none of its own."""
    if isinstance(element, Node):
        return list_activities(lookup, (element,))
    is_composed = element.id in lookup.architecture.shells
    return [] if is_composed else list_activities(lookup, lookup.nodes_of.get(element.id, ()), element.id)


def list_flow_rows(lookup: Lookup, activities: Sequence[Activity]) -> tuple[list[FlowRow], list[FlowRow]]:
    """Return the rows of what activities take in, and of what they give out."""
    taken, given = _list_flows(lookup, activities)
    return (
        [_make_row(lookup, lookup.timing, flow, is_taken=True) for flow in taken if lookup.timing],
        [_make_row(lookup, lookup.timing, flow, is_taken=False) for flow in given if lookup.timing],
    )


def _list_flows(lookup: Lookup, activities: Sequence[Activity]) -> tuple[list[ElementFlow], list[ElementFlow]]:
    finder, names = lookup.timing.flows if lookup.timing else None, [each.id for each in activities]
    return (finder.list_taken(names), finder.list_given(names)) if finder else ([], [])


def _make_row(lookup: Lookup, timing_lookup: TimingLookup, flow: ElementFlow, *, is_taken: bool) -> FlowRow:
    arc = flow.arc
    own, other = (arc.target, arc.source) if is_taken else (arc.source, arc.target)
    pace = flow.pace
    is_data = arc.role == "data"
    rate = pace.rate if is_data else find_sending_rate(timing_lookup.analysis, arc)
    output = lookup.architecture.outputs.get(arc.output)
    return FlowRow(
        _port_name(arc.input if is_taken else arc.output),
        _describe_end(lookup, timing_lookup, own, other, arc.link),
        _describe_topic(lookup, arc.topic, _find_endpoint(lookup, flow, timing_lookup, is_taken=is_taken)),
        timing_tables.figure_cell(value_format.display_rate(rate), rate),
        timing_tables.duration_cell(pace.gap) if is_data else (),
        timing_tables.duration_cell(flow.age) if is_data else (),
        timing_tables.duration_cell(flow.since_sensing) if is_data else (),
        timing_tables.duration_cell(sum_bounds((flow.since_sensing, flow.wait))) if is_data else (),
        _describe_reading(timing_lookup, flow),
        inline_text.join_inlines(_link_chain(lookup, chain) for chain in flow.chains),
        inline_text.type_link(output.type) if output and output.type else (),
    )


def _describe_end(lookup: Lookup, timing_lookup: TimingLookup, own_id: str, other_id: str, link: str | None) -> Inlines:
    """Return the element at the other end, its partner where that is another one, and whether a link lies between."""
    architecture, activities = lookup.architecture, timing_lookup.analysis.system.activities
    own, other = activities[own_id], activities[other_id]
    node = architecture.nodes.get(other.node)
    components = [
        name for name in (node.implements if node else ()) if other.component in {None, name, name.rpartition(".")[2]}
    ]
    component = architecture.components.get(components[0]) if len(components) == 1 else None
    own_partners = element_references.list_node_owners(architecture, own.node)
    owners = [
        each for each in element_references.list_node_owners(architecture, other.node) if each not in own_partners
    ]
    name = inline_text.component_link(component) if component else Text(other.node, ref=f"node:{other.node}", code=True)
    link_title = architecture.links[link].title if link and link in architecture.links else link
    travel = f"by {link_title}" if link_title else "same host" if own.host and own.host == other.host else ""
    notes = [inline_text.owner_links(architecture, owners)] if owners else []
    notes += [inline_text.to_inlines(Text(travel, muted=True))] if travel else []
    return inline_text.join_lines(((name,), inline_text.join_inlines(notes, " · ")))


def _find_endpoint(
    lookup: Lookup, flow: ElementFlow, timing_lookup: TimingLookup, *, is_taken: bool
) -> Endpoint | None:
    """Return the element's own end of a flow."""
    own_id, key = (flow.arc.target, flow.arc.input) if is_taken else (flow.arc.source, flow.arc.output)
    ends = lookup.endpoints_of.get(timing_lookup.analysis.system.activities[own_id].node, ())
    fitting = [end for end in ends if key in {end.port, end.name} and end.name == flow.arc.topic]
    return fitting[0] if fitting else None


def _describe_topic(lookup: Lookup, topic_name: str, endpoint: Endpoint | None) -> Inlines:
    """Return a topic, its message, and the quality of service of one end below one another."""
    topic = lookup.architecture.topics.get(topic_name)
    if topic is None:
        return (Text(topic_name, code=True),)
    messages = inline_text.join_inlines((element_references.message_link(name),) for name in topic.messages)
    size = lookup.format_size(topic).partition(" (")[0] if topic.flow == "topic" else ""
    if messages and size not in {"", "unknown"}:
        messages = (*messages, Text(f" {size}", muted=True))
    qos = inline_text.format_qos_cell(endpoint) if endpoint else ()
    return inline_text.join_lines(filter(None, ((inline_text.topic_link(topic_name),), messages, qos)))


def _describe_reading(timing: TimingLookup, flow: ElementFlow) -> str:
    """Say whether a flow fires its reader or is read when that works, and what is left out or read again."""
    if flow.arc.role == "request":
        answer = timing.analysis.services.get(flow.arc.target)
        is_known = answer is not None and answer.worst.value is not None
        return (
            f"called; worked off within {value_format.display_duration(answer.worst)}"
            if answer and is_known
            else "called"
        )
    fit = flow.fit
    words = ["triggers" if flow.triggers else "sampled"]
    if fit and fit.loss.value:
        words.append(f"{value_format.display_share(fit.loss)} never read")
    if fit and fit.rereads.value and fit.rereads.value > 1:
        words.append(f"each read about {value_format.display_number(fit.rereads.value, 1)} times")
    if fit and flow.arc.depth and fit.queue.value and fit.queue.value > flow.arc.depth:
        waiting = value_format.display_number(fit.queue.value)
        words.append(f"up to {waiting} may wait, the queue holds {flow.arc.depth}")
    return "; ".join(words)


def _link_chain(lookup: Lookup, chain: ChainResult) -> Inlines:
    title = lookup.architecture.chains[chain.id].title
    return (Text(title, ref=f"chain:{chain.id}"), Text(" "), *timing_tables.deadline_cell(chain))


def make_flow_blocks(lookup: Lookup, element_id: str, title: str, activities: Sequence[Activity]) -> Iterator[Block]:
    """Yield the tables of what an element takes in and gives out."""
    for table in _make_flow_tables(lookup, activities):
        yield replace(table, anchor=f"{table.anchor}/{element_id}", caption=f"{title} {table.caption}")


@remember_views
def _make_flow_tables(lookup: Lookup, activities: Sequence[Activity]) -> list[Table]:
    """Return the tables of what activities take in and give out, without the element in anchor and caption."""
    tables = zip(("in", "out"), ("takes in", "gives out"), list_flow_rows(lookup, activities), strict=True)
    made = []
    for key, words, rows in tables:
        if rows:
            columns = make_columns(
                ("Input" if key == "in" else "Output", 0.9),
                ("From" if key == "in" else "To", 1.5),
                ("Topic", 1.9),
                ("Rate", 0.7, "right"),
                ("Largest gap", 0.8, "right"),
                ("Age on arrival", 0.8, "right"),
                ("From sensor to arrival", 0.9, "right"),
                ("To being read", 0.8, "right"),
                ("How it is read", 1.3),
                ("Deadlines on it", 1.3),
            )
            cells = tuple(
                (
                    (Text("internal", muted=True) if row.port.startswith("/") else Text(row.port, code=True),),
                    *row[1:8],
                    inline_text.to_inlines(row.reading),
                    row.deadlines or (Text("none", muted=True),),
                )
                for row in rows
            )
            table = Table(f"table:flows-{key}", words, columns, cells, wide=True)
            made.append(timing_tables.drop_blank_columns(table))
    return made


def make_chain_share_table(lookup: Lookup, element_id: str, title: str, activities: Sequence[Activity]) -> Table | None:
    """List the chains that run through an element: what passes before it, in it and after it, and how they stand."""
    if lookup.timing is None:
        return None
    rows = [
        (
            inline_text.to_inlines(Text(lookup.architecture.chains[result.id].title, ref=f"chain:{result.id}")),
            chain_status.chain_meter(result),
            *_write_shares(lookup.timing, result, first, sums),
            timing_tables.duration_cell(result.bound),
            timing_tables.deadline_cell(result),
            chain_status.chain_chip(result),
        )
        for result, first, sums in _list_chains_through(lookup, {each.id for each in activities})
    ]
    columns = make_columns(
        ("Chain", 1.6),
        ("Of the deadline", 1),
        ("Before it", 0.8, "right"),
        ("Here", 0.8, "right"),
        ("After it", 0.8, "right"),
        ("At the latest", 0.9, "right"),
        ("Deadline", 0.8, "right"),
        ("Verdict", 1.1),
    )
    table = Table(f"table:chains-through/{element_id}", f"Chains through {title}", columns, tuple(rows))
    return table if rows else None


def _write_shares(
    timing: TimingLookup, result: ChainResult, first: ChainTerm, sums: Sequence[Fraction]
) -> Iterator[Inlines]:
    """Yield the cells of the time before, in and after an element. Of a chain with gaps this is what is known."""
    for index, known_sum in enumerate(sums):
        if index == 1 and not known_sum and first.counted_at:
            yield (Text("with ", muted=True), *timing_tables.activity_link(timing, first.counted_at))
        else:
            yield timing_tables.duration_cell(TimingValue(known_sum, result.bound.complete))


def _list_chains_through(
    lookup: Lookup, own_ids: Collection[str]
) -> Iterator[tuple[ChainResult, ChainTerm, list[Fraction]]]:
    """Yield the chains that run through activities, with the first term of theirs, and what is known of the time (ns) before, in and after these."""
    for result in lookup.timing.chains if lookup.timing else ():
        places = [index for index, term in enumerate(result.terms) if term.activity in own_ids]
        if places and result.id in lookup.architecture.chains:
            first, last = places[0], places[-1] + 1
            parts = (result.terms[:first], result.terms[first:last], result.terms[last:])
            yield result, result.terms[first], [sum_fractions(map(sum_known_parts, terms)) for terms in parts]


def list_unjudged_lines(lookup: Lookup, activities: Sequence[Activity]) -> list[tuple[UnjudgedWay, str]]:
    """Return what no chain says of the inputs of activities, each with its sentence."""
    finder = lookup.timing.flows if lookup.timing else None
    ways = finder.list_unjudged(_list_flows(lookup, activities)[0]) if finder else ()
    described = [(way, _describe_unjudged(lookup, way)) for way in ways]
    return [(way, text) for way, text in described if text]


def _describe_unjudged(lookup: Lookup, way: UnjudgedWay) -> str:
    """Return what a chain would say of a way, empty where nothing is known."""
    port, first, last = _port_name(way.flow.arc.input), way.through[0], way.through[-1]
    if way.duration is None:
        activities = lookup.timing.analysis.system.activities if lookup.timing else {}
        command = f"archgen timing --from {activities[first].node} --to {activities[last].node}"
        return f"`{port}`: from `{first}`, which is {len(way.through) - 1} elements away; `{command}` says how long it takes"
    if way.duration.value is None:
        return ""
    most = " at most" if way.duration.complete else ", as far as it is known,"
    duration = value_format.display_duration(way.duration)
    return f"`{port}`: {duration}{most} from what `{first}` senses until `{last}` has acted on it"


@remember_views
def make_unjudged_blocks(lookup: Lookup, activities: Sequence[Activity]) -> tuple[Block, ...]:
    """Return what no chain says of the inputs of an element, and the lines that would make a chain of each."""
    found = list_unjudged_lines(lookup, activities)
    if not found:
        return ()
    lead = "On these inputs no deadline rests. What a chain from the farthest sensor would say:"
    said = (Paragraph(inline_text.to_inlines(lead)), Bullets(tuple(_link_line(lookup, text) for _, text in found)))
    all_activities = lookup.timing.analysis.system.activities if lookup.timing else {}
    names_by_way: dict[tuple[str, ...], str] = {}
    for way in (way for way, _ in found if way.duration is not None):
        nodes = tuple(all_activities[each].node for each in way.through)
        name, taken_names = make_id(f"{way.through[0]}_to_{way.through[-1]}", "chain"), {*names_by_way.values()}
        if name in taken_names:
            name = make_id(f"{name}_by_{_port_name(way.flow.arc.input)}", "chain")
        names_by_way.setdefault(nodes, make_unique_id(name, taken_names))
    lines = [f"  {name}:\n    through: [{', '.join(nodes)}]" for nodes, name in names_by_way.items()]
    if not lines:
        return said
    lead = "The lines that make chains of them; a `deadline` is yours to choose:"
    return (
        *said,
        Paragraph(inline_text.message_to_inlines(lead)),
        Markdown("```yaml\nchains:\n" + "\n".join(lines) + "\n```"),
    )


def _link_line(lookup: Lookup, text: str) -> Inlines:
    """Link the elements that a line names; the port that it begins with may be called as something else is."""
    port, colon, rest = text.partition(": ")
    return (
        *inline_text.message_to_inlines(f"{port}{colon}"),
        *element_references.link_names(lookup.architecture, f"{rest}."),
    )


def _port_name(key: str) -> str:
    return key.rpartition(".")[2]


def list_flow_lines(lookup: Lookup, element: Node | Component) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield what the sections of its page say of an element, in lines for a card."""
    activities = list_own_activities(lookup, element)
    for name, arrow, rows in zip(
        ("takes in", "gives out"), ("<-", "->"), list_flow_rows(lookup, activities), strict=True
    ):
        yield name, tuple(_write_line(row, arrow) for row in rows)
    results = _list_chains_through(lookup, {each.id for each in activities})
    yield "chains", tuple(_write_chain(each, first, sums[1]) for each, first, sums in results)
    yield (
        "how long it may take",
        tuple(map(_read, (*_list_responses(lookup, activities), *list_time_left(lookup, activities)))),
    )
    yield (
        "what no chain says",
        tuple(
            f"{text.replace('`', '')} ({' > '.join(way.through)})"
            for way, text in list_unjudged_lines(lookup, activities)
        ),
    )
    yield "what rests on it", tuple(map(_read, element_readers.list_reliance(lookup, element)))
    partners = make_partner_bullets(lookup, activities)
    yield "who to talk to", tuple(map(_read, partners.items)) if partners else ()


def _write_chain(result: ChainResult, first: ChainTerm, own_time: Fraction) -> str:
    """Write how a chain stands, and how much of it passes in an element."""
    own, whole = TimingValue(own_time, result.bound.complete), result.bound
    share = f"; its time counted at {first.counted_at}" if first.counted_at else ""
    if own_time:
        share = f"; {value_format.display_duration(own)} of {value_format.display_duration(whole)} here"
    return f"{result.id}: {_read(chain_status.chain_chip(result))}{share}"


def _write_line(row: FlowRow, arrow: str) -> str:
    figures = (
        ("", row.rate),
        ("largest gap ", row.gap),
        ("age on arrival ", row.age),
        ("from sensor to arrival ", row.since_sensing),
        ("to being read ", row.read),
    )
    texts = [f"{label}{_read(cell)}" for label, cell in figures if cell]
    deadlines = f"deadlines: {_read(row.deadlines) or 'none'}"
    return f"{row.port} {arrow} {_read(row.other)}: {'; '.join(filter(None, (_read(row.topic), ', '.join(texts), row.reading, deadlines)))}"


def _read(cell: Inlines) -> str:
    """Return the text of a cell on one line."""
    return "".join(f", {run.text}" if run.line_break else run.text for run in cell)


def _list_responses(lookup: Lookup, activities: Sequence[Activity]) -> Iterator[Inlines]:
    """Yield within what time activities respond, and why not sooner."""
    for activity in activities if lookup.timing else ():
        response = lookup.timing.analysis.responses.get(activity.id) if lookup.timing else None
        if lookup.timing and response and response.worst.value is not None and activity.wcet is not None:
            name = (Text(activity.id, code=True), Text(": ")) if len(activities) > 1 else ()
            yield (*name, *timing_tables.describe_response(lookup.timing, activity))


def list_time_left(lookup: Lookup, activities: Sequence[Activity]) -> Iterator[Inlines]:
    """Yield what rates and deadlines leave to activities of which nobody has written how long they take."""
    for activity in activities:
        start = lookup.architecture.nodes[activity.node].start
        is_once = activity.behaviour == "once" or (start is not None and start.once)
        if lookup.timing is None or is_once or not (activity.wcet is activity.response is None):
            continue
        name = (Text(activity.id, code=True), Text(": ")) if len(activities) > 1 else ()
        rate = lookup.timing.analysis.paces[activity.id].rate
        # Runs of what is reentrant need not follow one another.
        period = NS_PER_SECOND / rate.value if rate.value and activity.callback_group else None
        if period:
            most = chain_status.round_duration(period, ">")
            yield (*name, Text(f"less than {most} a run, at {value_format.display_rate(rate)}"))
        results = [result for result, *_ in _list_chains_through(lookup, {activity.id}) if result.deadline]
        for result in results:
            others = [each for each in result.bound.missing if each != activity.id]
            rest = f", together with {join_words(others)}" if others and result.verdict == "open" else ""
            margin = chain_status.describe_margin(result) or "nobody knows how much is left"
            yield (*name, *_link_chain(lookup, result), Text(f": {margin}{rest}"))
        if not period and not results:
            yield (*name, Text("nothing that is written limits it"))


@remember_views
def _list_exchanges(lookup: Lookup, activities: Sequence[Activity]) -> dict[str, Inlines]:
    """Return by other partner, in words, what passes between him and an element."""
    architecture = lookup.architecture
    all_activities = lookup.timing.analysis.system.activities if lookup.timing else {}
    own = {owner for each in activities for owner in element_references.list_node_owners(architecture, each.node)}
    ports: dict[str, dict[str, dict[str, None]]] = {}
    for side, flows in enumerate(_list_flows(lookup, activities)):
        for flow in flows:
            other, port = (flow.arc.target, flow.arc.output) if side else (flow.arc.source, flow.arc.input)
            for owner in element_references.list_node_owners(architecture, all_activities[other].node):
                if owner not in own:
                    verb = _PARTNER_VERBS[flow.arc.role == "request"][side]
                    ports.setdefault(owner, {}).setdefault(verb, {})[_port_name(port)] = None
    return {
        owner: (
            *inline_text.owner_links(architecture, (owner,)),
            *element_references.link_names(architecture, f" {_describe_exchange(ports[owner])}"),
            *(
                (Text(f" · {known.contact}", muted=True),)
                if (known := architecture.partners.get(owner)) and known.contact
                else ()
            ),
        )
        for owner in sorted(ports, key=order_naturally)
    }


def _describe_exchange(ports_by_verb: Mapping[str, Iterable[str]]) -> str:
    return join_words(
        [f"{verb} {join_words([f'`{each}`' for each in names])}" for verb, names in ports_by_verb.items()]
    )


def make_partner_bullets(
    lookup: Lookup, activities: Sequence[Activity], unsettled: Mapping[str, Inlines] = MappingProxyType({})
) -> Bullets | None:
    """List the other partners with what passes between them and an element: whom to talk to, and of what that is unsettled."""
    items = [(*words, *unsettled.get(owner, ())) for owner, words in _list_exchanges(lookup, activities).items()]
    return Bullets(tuple(items)) if items else None


def make_flow_sections(
    lookup: Lookup, element: Node | Component, unsettled: Mapping[str, Inlines] = MappingProxyType({})
) -> list[Section]:
    """Return the sections on the page of an element about what passes through it, its time, and who relies on it."""
    name, title = element.id, element.id if isinstance(element, Node) else element.title
    activities = list_own_activities(lookup, element)
    chains = make_chain_share_table(lookup, name, title, activities)
    partners = make_partner_bullets(lookup, activities, unsettled)
    time_left, reliance = (
        tuple(list_time_left(lookup, activities)),
        tuple(element_readers.list_reliance(lookup, element)),
    )
    unwritten = (
        Paragraph(inline_text.to_inlines("No execution time is written. What is left to it:")),
        Bullets(time_left),
    )
    # The facts of a node say it of each of its activities.
    known = () if isinstance(element, Node) else tuple(_list_responses(lookup, activities))
    parts: list[tuple[str, str, tuple[Block, ...]]] = [
        ("flows", "Takes in and gives out", tuple(make_flow_blocks(lookup, name, title, activities))),
        ("chains-through", "Chains through it", (chains,) if chains else ()),
        (
            "time-left",
            "How long it may take",
            (*((Bullets(known),) if known else ()), *(unwritten if time_left else ())),
        ),
        ("unjudged", "What no chain says", make_unjudged_blocks(lookup, activities)),
        ("reliance", "What rests on it", (Bullets(reliance),) if reliance else ()),
        ("partners-of", "Who to talk to", (partners,) if partners else ()),
    ]
    return [Section(f"{kind}:{name}", heading, blocks) for kind, heading, blocks in parts if blocks]
