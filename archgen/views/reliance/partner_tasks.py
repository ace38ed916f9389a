"""What a partner has to do, in one list over all kinds, by what rests on it, and as a document; whom he waits for, what
others changed for him, what is still to be made. Each row is one that another output tells: nothing is judged here.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Literal

from archgen.diagnostics import NO_SPAN, Diagnostic, Severity, Span, join_words
from archgen.frozen import dataclass, replace
from archgen.model.node import Node
from archgen.views import element_references, inline_text
from archgen.views.agreement.exchange_tables import PartnerExchange
from archgen.views.agreement.interface_terms import InterfaceTerms
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup, group_values
from archgen.views.reliance.impact_outline import (
    list_chain_blocks,
    list_milestone_blocks,
    make_key_figure,
    make_table,
    phrase_figure,
)
from archgen.views.reliance.partner_impact import AwaitedInterface, PartnerImpact
from archgen.views.shapes import Block, Bullets, Inlines, KeyFigure, Outline, Paragraph, Section, Text, make_columns
from archgen.views.tables.finding_tables import describe_severities
from archgen.views.timing import chain_status, timing_verdicts, value_format

if TYPE_CHECKING:  # a site that is compared with nothing loads no comparison
    from archgen.compare import Comparison

TaskKind = Literal["finding", "contradiction", "term", "chain", "host", "requirement"]


@dataclass(frozen=True, slots=True)
class Task:
    """Something to do: what, in a sentence that quotes names; the chains, requirements and partners that wait for it; where."""

    kind: TaskKind
    text: str
    chains: tuple[str, ...] = ()
    requirements: tuple[str, ...] = ()
    partners: tuple[str, ...] = ()
    place: Span = NO_SPAN
    finding: Diagnostic | None = None


@dataclass(frozen=True, slots=True)
class PlannedNode:
    """A node that is still to be made, with what waits for it."""

    node: Node
    chains: tuple[str, ...]
    requirements: tuple[str, ...]
    partners: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class PartnerTasks:
    """What a partner has to do (what most rests on first), and what he waits for: terms that others owe him.

    `changes` are None where the project was compared with nothing.
    """

    impact: PartnerImpact
    tasks: tuple[Task, ...]
    awaited: tuple[InterfaceTerms, ...]
    planned: tuple[PlannedNode, ...]
    changes: tuple[str, ...] | None


def find_tasks(
    lookup: Lookup, exchanges: Sequence[PartnerExchange], impact: PartnerImpact, comparison: Comparison | None = None
) -> PartnerTasks:
    """Return what the partner of an impact has to do."""
    partner = impact.late.owners[0]
    own = [exchange for exchange in exchanges if partner in exchange.pair]
    tasks = [
        *_list_findings(lookup, partner),
        *_list_contradictions(own, partner),
        *_list_terms(lookup, impact),
        *_list_chains(lookup, partner),
        *_list_hosts(lookup, impact),
        *_list_requirements(lookup, impact),
    ]
    awaited = [terms for each in own for terms in each.interfaces if terms.interface.pair[1] == partner]
    return PartnerTasks(
        impact,
        tuple(sorted(tasks, key=_rank)),
        tuple(sorted((terms for terms in awaited if terms.open_names), key=lambda each: -len(each.chains))),
        tuple(_list_planned(lookup, impact, partner)),
        None if comparison is None else tuple(_list_changes(comparison, partner)),
    )


def _rank(task: Task) -> tuple[bool, int, int, int]:
    """Return the sort key: errors, then what most deadlines, requirements and partners rest on."""
    is_error = task.finding is not None and task.finding.effective_severity is Severity.ERROR
    return not is_error, -len(task.chains), -len(task.requirements), -len(task.partners)


def _list_findings(lookup: Lookup, partner: str) -> Iterator[Task]:
    """Yield the errors and warnings that are his to mend."""
    for finding in lookup.findings:
        name = finding.element or ""
        is_grave = finding.effective_severity in {Severity.ERROR, Severity.WARNING}
        if is_grave and partner in element_references.find_answering(lookup, name, finding.span):
            chains = (name,) if name in lookup.architecture.chains else ()
            requirements = (name,) if name in lookup.architecture.requirements else ()
            yield Task("finding", finding.message, chains, requirements, (), finding.span, finding)


def _list_contradictions(exchanges: Sequence[PartnerExchange], partner: str) -> Iterator[Task]:
    for exchange in exchanges:
        other = next(each for each in exchange.pair if each != partner)
        for terms in exchange.interfaces:
            place = terms.interface.output.at if terms.interface.output else NO_SPAN
            chains = tuple(chain.id for chain in terms.chains if chain.deadline or chain.shares)
            yield from (Task("contradiction", text, chains, (), (other,), place) for text in terms.contradictions)


def _list_terms(lookup: Lookup, impact: PartnerImpact) -> Iterator[Task]:
    """Yield the terms that he owes: a task for each interface, whoever takes it."""
    for each in impact.interfaces:
        if each.open_words:
            output = each.terms[0].interface.output
            place = output.at if output else NO_SPAN
            text = f"State {join_words(each.open_words)} of `{each.terms[0].interface.key}`"
            yield Task("term", text, each.chains, _list_served(lookup, impact, each), each.takers, place)


def _list_served(lookup: Lookup, impact: PartnerImpact, awaited: AwaitedInterface) -> tuple[str, ...]:
    """Return the requirements that what gives an interface serves, and nobody else."""
    output = awaited.terms[0].interface.output
    component = lookup.architecture.components[output.component] if output else None
    served = {use.text for use in component.requirements} if component else set()
    return tuple(
        each.requirement.id for each in impact.requirements if not each.others and each.requirement.id in served
    )


def _list_chains(lookup: Lookup, partner: str) -> Iterator[Task]:
    """Yield the chains that are not shown to be in time, that no finding is about, and in which he has to act."""
    for result in timing_verdicts.list_silent_chains(lookup) if lookup.timing else ():
        chain = lookup.architecture.chains[result.id]
        if lookup.timing and partner in element_references.find_answering(lookup, result.id, chain.at):
            chip = "".join(run.text for run in chain_status.chain_chip(result))
            missing = value_format.describe_missing(result.bound, lookup.timing.analysis, 3)
            asked = (
                f"Bring `{chain.id}` below its" if result.verdict == "missed" else f"Show that `{chain.id}` meets its"
            )
            text = f"{asked} deadline: {chip}{f'; {missing}' if missing else ''}"
            deadlines = (chain.id,) if chain.deadline_text else ()
            text = text if deadlines else f"Complete the figures of `{chain.id}`: {missing or 'no bound found'}"
            yield Task("chain", text, deadlines, chain.requirements, (), chain.at)


def _list_hosts(lookup: Lookup, impact: PartnerImpact) -> Iterator[Task]:
    """Yield his activities that nothing proves to be done before they are due again, by host."""
    for name, load in lookup.timing.analysis.hosts.items() if lookup.timing else ():
        own = [each for each in load.unproven if each in impact.late.activities]
        if own:
            chains = tuple(
                each.result.id for each in impact.chains if any(term.activity in own for term in each.result.terms)
            )
            members, (verb, who) = (
                join_words([f"`{each}`" for each in own]),
                ("is", "it is") if len(own) == 1 else ("are", "they are"),
            )
            text = f"Show that {members} on `{name}` {verb} done before {who} due again"
            yield Task("host", text, chains, (), (), lookup.architecture.hosts[name].at)


def _list_requirements(lookup: Lookup, impact: PartnerImpact) -> Iterator[Task]:
    """Yield the requirements that only he serves and that nothing verifies, where the project says of others what does."""
    trace = lookup.requirement_trace
    for each in impact.requirements:
        name = each.requirement.id
        if trace.is_verification_told and not each.others and name not in trace.verified:
            yield Task("requirement", f"Say what verifies `{name}`", (), (name,), (), each.requirement.at)


def _list_planned(lookup: Lookup, impact: PartnerImpact, partner: str) -> Iterator[PlannedNode]:
    """Yield the nodes that he has still to make, what most waits for first."""
    found = []
    alone = {each.requirement.id for each in impact.requirements if not each.others}
    activities = lookup.timing.activities_of_node if lookup.timing else {}
    given_by = group_values(
        (name, each)
        for each in impact.interfaces
        for name in dict.fromkeys(end.node for every in each.terms for end in every.interface.giver_endpoints)
    )
    for node in lookup.architecture.nodes.values():
        if node.status != "planned" or partner not in element_references.list_node_owners(lookup.architecture, node.id):
            continue
        own = {each.id for each in activities.get(node.id, ())}
        chains = [each.result.id for each in impact.chains if any(term.activity in own for term in each.result.terms)]
        components = [lookup.architecture.components[name] for name in node.implements]
        if not node.written and all(each.status == "existing" for each in components):
            continue  # it exists, and which node it is nobody wrote yet
        requirements = dict.fromkeys(use.text for each in components for use in each.requirements if use.text in alone)
        partners = dict.fromkeys(taker for each in given_by.get(node.id, ()) for taker in each.takers)
        found.append(PlannedNode(node, tuple(chains), tuple(requirements), tuple(partners)))
    yield from sorted(found, key=lambda each: (-len(each.chains), -len(each.requirements), -len(each.partners)))


def _list_changes(comparison: Comparison, partner: str) -> Iterator[str]:
    """Yield the changes of others that concern him, those that break him first, and what comes to him otherwise now."""
    from archgen.compare.concerned_owners import find_concerned_owners
    from archgen.views.changes.boundary_lines import write_boundary_lines

    own_ids = (comparison.before.architecture, comparison.after.architecture)
    others = [
        change
        for change in comparison.changes
        if partner in find_concerned_owners((change,), comparison.versions)
        and not any(partner in element_references.find_owners(each, change.element_id) for each in own_ids)
    ]
    for change in sorted(others, key=lambda each: partner not in each.broken_partners):
        yield f"{'breaks: ' if partner in change.broken_partners else ''}{change.text}"
    taken = tuple(each for each in comparison.boundaries if partner in (*each.takers, *each.old_takers))
    titles = {each.id: each.title for each in comparison.after.architecture.partners.values()}
    yield from (line.text for line in write_boundary_lines(replace(comparison, boundaries=taken), titles))


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
