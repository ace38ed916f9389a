"""Use cases in documents: the sequence, how long it takes, and a table of its steps."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.model.architecture import UseCase
from archgen.model.path_resolver import title_from_id
from archgen.model.step_connections import ConnectedStep
from archgen.model.use_case_steps import StepEnd
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import UPRIGHT
from archgen.views.sequences import sequence_charts
from archgen.views.sequences.lane_sheets import has_lanes
from archgen.views.sequences.sequence_charts import CHART_PREFIX
from archgen.views.shapes import (
    Block,
    Facts,
    Figure,
    Inlines,
    Markdown,
    Paragraph,
    Section,
    Table,
    Text,
    drop_empty_columns,
    make_columns,
)
from archgen.views.timing import timing_tables


def make_use_case_sections(lookup: Lookup) -> Iterator[Section]:
    """Yield a section for each use case with steps, for the report."""
    for use_case_id in lookup.steps.by_use_case:
        use_case = lookup.architecture.use_cases[use_case_id]
        title = f"{use_case.id}: {use_case.title}" if use_case.title != use_case.id else use_case.id
        texts = (Markdown(use_case.description),) if use_case.description else ()
        yield Section(f"use_case:{use_case.id}", title, (*texts, *make_sequence_blocks(lookup, use_case)))


def make_sequence_blocks(lookup: Lookup, use_case: UseCase) -> Iterator[Block]:
    """Yield what is said of the steps of a use case; nothing for one without."""
    steps = lookup.steps.by_use_case.get(use_case.id)
    if not steps:
        return
    facts = tuple(_list_facts(lookup, use_case))
    if facts:
        yield Facts(facts)
    broken = [each.number for each in steps if each.is_broken]
    if broken:
        numbers = inline_text.join_inlines(inline_text.to_inlines(str(number)) for number in broken)
        lead, rest = ("Step ", " runs") if len(broken) == 1 else ("Steps ", " run")
        yield Paragraph((Text(lead), *numbers, Text(f"{rest} along no connection.")), "warning")
    chart_id = f"{CHART_PREFIX}{use_case.id}"
    alt = f"The steps of {use_case.title} between those who take part; the table has them in words."
    narrow = f"{chart_id}{UPRIGHT}" if has_lanes(steps) else None
    yield Figure(f"figure:{chart_id}", chart_id, f"{use_case.title}, step by step", alt, narrow=narrow)
    yield make_step_table(lookup, use_case, steps)


def _list_facts(lookup: Lookup, use_case: UseCase) -> Iterator[tuple[str, Inlines]]:
    if use_case.actors:
        yield "From outside", inline_text.to_inlines(", ".join(actor.title for actor in use_case.actors.values()))
    total = sequence_charts.explain_total(lookup, use_case.id)
    if total:
        yield "All steps", inline_text.to_inlines(total)


def make_step_table(lookup: Lookup, use_case: UseCase, steps: Iterable[ConnectedStep]) -> Table:
    """List the steps with who takes part, what they run along, and how long they take."""
    columns = make_columns(
        ("Step", 0.4, "right"),
        ("From", 1.3),
        ("To", 1.3),
        ("What happens", 2),
        ("Along", 1.5),
        ("Within", 0.8, "right"),
    )
    rows = tuple(
        (
            inline_text.to_inlines(str(each.number)),
            _link_participant(lookup, use_case, each.step.source),
            inline_text.to_inlines(Text("itself", muted=True))
            if each.step.is_inner
            else _link_participant(lookup, use_case, each.step.target),
            inline_text.to_inlines(" ".join(each.step.say.split())) if each.step.say else (),
            _link_carriers(lookup, each),
            _make_time_cell(lookup, use_case, each.number),
        )
        for each in steps
    )
    anchor = f"table:steps/{use_case.id}"
    return drop_empty_columns(Table(anchor, f"Steps of {use_case.title}", columns, rows))


def make_short_steps(lookup: Lookup, use_case: UseCase) -> Table:
    """List the steps in a line each: who, to whom, what, within what time. A sender stands where he was not the last receiver."""
    rows = []
    last = None
    for each in lookup.steps.by_use_case[use_case.id]:
        source, target = each.step.source, each.step.target
        sender = () if source.participant == last else _link_participant(lookup, use_case, source)
        say = " ".join(each.step.say.split()) if each.step.say else ""
        words = (*inline_text.to_inlines(say),) if say else _link_carriers(lookup, each)
        if each.is_broken:
            words = (*words, Text(" "), Text("no connection", status="warning"))
        rows.append(
            (
                inline_text.to_inlines(str(each.number)),
                sender,
                _link_participant(lookup, use_case, target)
                if not each.step.is_inner
                else (Text("itself", muted=True),),
                _name_partners(lookup, target),
                words,
                _make_time_cell(lookup, use_case, each.number),
            )
        )
        last = target.participant
    columns = make_columns(
        ("", 0.3, "right"), ("From", 1.2), ("To", 1.2), ("Whose", 0.8), ("What happens", 2.2), ("Within", 0.6, "right")
    )
    anchor = f"table:steps/{use_case.id}"
    table = Table(anchor, f"Steps of {use_case.title}", columns, tuple(rows), numbered=False, dense=True)
    return drop_empty_columns(table)


def _link_participant(lookup: Lookup, use_case: UseCase, end: StepEnd) -> Inlines:
    component = lookup.architecture.find_component(end.participant) if end.kind != "actor" else None
    if component is not None:
        return (inline_text.component_link(component),)
    return inline_text.to_inlines(Text(sequence_charts.name_participant(lookup, use_case, end), emphasis=True))


def _name_partners(lookup: Lookup, end: StepEnd) -> Inlines:
    component = lookup.architecture.find_component(end.participant) if end.kind != "actor" else None
    partners = lookup.architecture.partners
    titles = (partners[owner].title for owner in (component.owners if component else ()) if owner in partners)
    return inline_text.to_inlines(Text(", ".join(titles), muted=True)) if component and component.owners else ()


def _link_carriers(lookup: Lookup, connected: ConnectedStep) -> Inlines:
    """Return what a step runs along: each type with its page, or the ports that have none."""
    if connected.is_broken:
        return (Text("no connection", status="warning"),)
    architecture = lookup.architecture
    links: dict[str, Inlines] = {}
    for each in connected.connections:
        port = architecture.outputs.get(each.output or "") or architecture.inputs.get(each.input or "")
        if port is not None:
            own_name = Text(title_from_id(port.name), ref=f"component:{port.component}")
            links.setdefault(port.type or port.id, inline_text.type_link(port.type) if port.type else (own_name,))
    return inline_text.join_inlines(links.values())


def _make_time_cell(lookup: Lookup, use_case: UseCase, number: int) -> Inlines:
    times = sequence_charts.find_times(lookup, use_case.id)
    value = times.steps[number - 1] if times else None
    if value is not None and value.value is None:
        return (Text(sequence_charts.NOT_PROVEN, muted=True),)
    return timing_tables.duration_cell(value) if value is not None else ()


def link_use_cases(lookup: Lookup, component_id: str) -> Inlines:
    """Return links to the use cases in which a component takes part; empty where there are none."""
    use_case_ids = lookup.steps.by_component.get(component_id, ())
    return inline_text.join_inlines(
        inline_text.to_inlines(Text(use_case_id, ref=f"use_case:{use_case_id}")) for use_case_id in use_case_ids
    )
