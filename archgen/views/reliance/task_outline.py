"""What a partner has to do, as a document that terminal, Markdown and site share."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.views import element_references, inline_text
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.reliance.impact_outline import (
    list_chain_blocks,
    list_milestone_blocks,
    make_key_figure,
    make_table,
    phrase_figure,
)
from archgen.views.reliance.partner_tasks import PartnerTasks, PlannedNode, Task
from archgen.views.shapes import Block, Bullets, Inlines, KeyFigure, Outline, Paragraph, Section, Text, make_columns
from archgen.views.tables.finding_tables import describe_severities


def make_task_outline(lookup: Lookup, tasks: PartnerTasks) -> Outline:
    """Return the document on what a partner has to do."""
    partner = tasks.impact.late.partner
    figures = list_task_figures(tasks)
    return Outline(
        f"{partner.title if partner else ''}: what is to do",
        count_noun(len(tasks.impact.late.components), "component"),
        tuple((figure.title, inline_text.to_inlines(phrase_figure(figure))) for figure in figures),
        sections=tuple(section for section in _list_sections(lookup, tasks) if section.blocks),
    )


def list_task_figures(tasks: PartnerTasks) -> Iterator[KeyFigure]:
    """Yield the counts; those of what a project has none of are left out."""
    owed = [each for each in tasks.impact.interfaces if each.open_words]
    if tasks.impact.interfaces:
        partners = len({taker for each in owed for taker in each.takers})
        note = f"given have open terms, for {count_noun(partners, 'partner')}" if owed else "given have open terms"
        yield make_key_figure("Interfaces", len(owed), len(tasks.impact.interfaces), note, "tasks")
    if tasks.awaited:
        partners = len({terms.interface.pair[0] for terms in tasks.awaited})
        note = f"have open terms that {count_noun(partners, 'partner')} owe{'s' * (partners == 1)}"
        yield make_key_figure("Waits for", len(tasks.awaited), None, note, "awaited")
    if chains := tasks.impact.chains:
        met = sum(each.result.verdict == "met" for each in chains)
        yield make_key_figure("Deadlines", met, len(chains), "through them are met", "chains")
    if tasks.planned:
        yield make_key_figure("Planned nodes", len(tasks.planned), None, "are still to be made", "planned")
    findings = [each.finding for each in tasks.tasks if each.finding]
    if findings:
        yield make_key_figure("Findings", len(findings), None, f"to mend: {describe_severities(findings)}", "tasks")


def _list_sections(lookup: Lookup, tasks: PartnerTasks) -> Iterator[Section]:
    yield Section("impact:tasks", "To do", tuple(_list_task_blocks(lookup, tasks.tasks)))
    yield Section("impact:awaited", "Waits for", tuple(_list_awaited_blocks(lookup, tasks)))
    yield Section("impact:changed", "What others changed", tuple(_list_change_blocks(lookup, tasks)))
    yield Section("impact:chains", "Deadlines through them", tuple(list_chain_blocks(lookup, tasks.impact)))
    yield Section("impact:milestones", "Milestones", tuple(list_milestone_blocks(lookup, tasks.impact)))
    yield Section("impact:planned", "Still to be made", tuple(_list_planned_blocks(lookup, tasks.planned)))


def _list_task_blocks(lookup: Lookup, tasks: Sequence[Task]) -> Iterator[Block]:
    rows = [
        (
            (Text(f"{number}. "), *element_references.link_names(lookup.architecture, task.text)),
            _give_reasons(lookup, task),
            (place,) if (place := element_references.place_run(lookup, task.place)) else (),
        )
        for number, task in enumerate(tasks, start=1)
    ]
    columns = make_columns(("What", 3), ("What rests on it", 1.8), ("Where", 1.4))
    yield from make_table("tasks", "What most rests on first", columns, rows)
    if not rows:
        yield Paragraph(inline_text.to_inlines("Nothing is open."))


def _give_reasons(lookup: Lookup, waiting: Task | PlannedNode) -> Inlines:
    return inline_text.join_inlines(_list_reasons(lookup, waiting), "; ")


def _list_reasons(lookup: Lookup, waiting: Task | PlannedNode) -> Iterator[Inlines]:
    architecture = lookup.architecture
    chains = [architecture.chains[name] for name in waiting.chains if name in architecture.chains]
    if chains:
        links = [(Text(each.title, ref=f"chain:{each.id}"), Text(f" ({each.deadline_text})")) for each in chains]
        yield (Text(f"{count_noun(len(chains), 'deadline')}: "), *inline_text.join_first(links))
    if waiting.requirements:
        yield inline_text.join_first([(Text(name, ref=f"requirement:{name}"),) for name in waiting.requirements])
    if waiting.partners:
        owners = [inline_text.partner_link(architecture, name) for name in waiting.partners]
        yield (*inline_text.join_first(owners), Text(f" wait{'s' * (len(owners) == 1)}"))
    if isinstance(waiting, Task) and waiting.finding:
        rule = waiting.finding.rule
        yield (Text(f"{waiting.finding.effective_severity} "), Text(rule, ref=f"rule:{rule}"))


def _list_awaited_blocks(lookup: Lookup, tasks: PartnerTasks) -> Iterator[Block]:
    rows: list[tuple[Inlines, ...]] = [
        (
            inline_text.partner_link(lookup.architecture, terms.interface.pair[0]),
            (Text(terms.title, ref=f"interface:{terms.interface.key}:{':'.join(terms.interface.pair)}"),),
            inline_text.to_inlines(", ".join(terms.open_terms)),
        )
        for terms in tasks.awaited
    ]
    columns = make_columns(("Partner", 1), ("Interface", 2), ("Open", 1.5))
    yield from make_table("awaited", "What others owe them, what deadlines rest on first", columns, rows)


def _list_change_blocks(lookup: Lookup, tasks: PartnerTasks) -> Iterator[Block]:
    if tasks.changes:
        yield Bullets(tuple(element_references.link_names(lookup.architecture, text) for text in tasks.changes))
    elif tasks.changes is not None:
        yield Paragraph(inline_text.to_inlines("Nothing that others changed concerns them."))


def _list_planned_blocks(lookup: Lookup, planned: Sequence[PlannedNode]) -> Iterator[Block]:
    rows = [
        (
            (Text(each.node.id, ref=f"node:{each.node.id}", code=True),),
            _give_reasons(lookup, each),
        )
        for each in planned
    ]
    yield from make_table("planned", "Planned nodes", make_columns(("Node", 1), ("What waits for it", 2)), rows)
