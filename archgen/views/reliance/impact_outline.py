"""What rests on a partner or on some components, as a document: figures, then tables that terminal, Markdown and site share."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from archgen.diagnostics import join_first
from archgen.timing.figures.timing_values import TimingValue
from archgen.views import inline_text
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.reliance.partner_impact import (
    AwaitedInterface,
    LateParts,
    PartnerImpact,
    RestingChain,
    StepState,
    WaitingPartner,
)
from archgen.views.shapes import (
    Block,
    Column,
    Inlines,
    KeyFigure,
    Meter,
    Outline,
    Paragraph,
    Section,
    Table,
    Text,
    Waterfall,
    WaterfallPiece,
    WaterfallStep,
    drop_empty_columns,
    make_columns,
)
from archgen.views.tables.requirement_tables import use_case_link
from archgen.views.timing import chain_status, value_format

_STATE_SIGNS: dict[StepState, str] = {"runs": "-", "theirs": "#", "never": "."}
_STATE_WORDS: dict[StepState, str] = {"runs": "runs", "theirs": "needs them", "never": "never comes"}
USE_CASES_ANCHOR = "impact:use-cases"
_MAX_NAMES = 3


def name_late(lookup: Lookup, late: LateParts) -> str:
    """Return what is late in words: a partner, or components by their titles."""
    if late.partner:
        return late.partner.title
    return join_first([lookup.architecture.components[name].title for name in sorted(late.components)], _MAX_NAMES)


def make_impact_outline(lookup: Lookup, impact: PartnerImpact) -> Outline:
    """Return the document on what rests on a partner or on components."""
    name = name_late(lookup, impact.late)
    verb = "are" if len(impact.late.components) > 1 and not impact.late.partner else "is"
    return Outline(
        f"If {name} {verb} late",
        count_noun(len(impact.late.components), "component"),
        tuple((figure.title, inline_text.to_inlines(phrase_figure(figure))) for figure in list_figures(lookup, impact)),
        () if impact.late.components else (Paragraph(inline_text.to_inlines(f"{name} owns no component."), "note"),),
        tuple(section for section in _list_sections(lookup, impact) if section.blocks),
    )


def phrase_figure(figure: KeyFigure) -> str:
    """Return a figure in words."""
    note = "".join(run.text for run in figure.note)
    return f"{figure.value}{f' of {figure.total}' if figure.total else ''} {note}"


def list_figures(lookup: Lookup, impact: PartnerImpact) -> Iterator[KeyFigure]:
    """Yield the counts; those of what a project has none of are left out."""
    chain_count = len(impact.chains) + len(impact.free_chains)
    if chain_count:
        yield make_key_figure("Deadlines", len(impact.chains), chain_count, "run through them", "chains")
    if impact.use_case_count:
        at_once = sum(each.stop == 1 for each in impact.use_cases)
        note = "need them" + (f", {at_once} at the first step" if at_once else "")
        yield make_key_figure("Use cases", len(impact.use_cases), impact.use_case_count, note, "use-cases")
    if lookup.architecture.requirements:
        alone = sum(not each.others for each in impact.requirements)
        note = f"rest on them; {alone} no other component serves" if alone else "rest on them"
        yield make_key_figure(
            "Requirements", len(impact.requirements), len(lookup.architecture.requirements), note, "requirements"
        )
    if impact.interfaces:
        flows = sum(each.flow_count for each in impact.waiting)
        note = f"that {count_noun(len(impact.waiting), 'partner')} wait{'s' * (len(impact.waiting) == 1)} for"
        yield make_key_figure("Flows", flows, None, note, "waiting")
    if count := len(lookup.architecture.milestones):
        yield make_key_figure("Milestones", len(impact.milestones), count, _phrase_milestones(impact), "milestones")
    other_count = len(lookup.architecture.components) - len(impact.late.components)
    if other_count:
        note = f"read from them; with what those feed it is {impact.reached}"
        yield make_key_figure("Other components", len(impact.readers), other_count, note, "interfaces")
    if impact.interfaces:
        count = sum(each.stand_in != "none" for each in impact.interfaces)
        yield make_key_figure(
            "Interfaces", count, len(impact.interfaces), "can be replaced by a recording or a stub", "interfaces"
        )


def _phrase_milestones(impact: PartnerImpact) -> str:
    before = f" before {impact.until}" if impact.until else ""
    first = impact.milestones[0].milestone.date if impact.milestones else None
    return f"need them{before}" + (f", the first on {first}" if first else "")


def make_key_figure(title: str, count: int, total: int | None, note: str, anchor: str) -> KeyFigure:
    """Return a count, of a total where there is one, with what it counts and the section that tells more."""
    whole = "" if total is None else str(total)
    return KeyFigure(title, str(count), whole, (Text(note, muted=True),), f"impact:{anchor}")


def _list_sections(lookup: Lookup, impact: PartnerImpact) -> Iterator[Section]:
    yield Section("impact:chains", "Deadlines that rest on them", tuple(list_chain_blocks(lookup, impact)))
    yield Section(USE_CASES_ANCHOR, "How far the use cases get", tuple(_list_use_case_blocks(lookup, impact)))
    yield Section("impact:milestones", "Milestones", tuple(list_milestone_blocks(lookup, impact)))
    yield Section("impact:interfaces", "What to settle first", tuple(_list_interface_blocks(lookup, impact)))
    yield Section("impact:requirements", "Requirements", tuple(_list_requirement_blocks(lookup, impact)))
    yield Section("impact:waiting", "Who waits, and with what meanwhile", tuple(_list_waiting_blocks(lookup, impact)))


def make_table(
    anchor: str, caption: str, columns: tuple[Column, ...], rows: Sequence[tuple[Inlines, ...]]
) -> list[Block]:
    """Return a table without its empty columns; nothing where there are no rows."""
    table = Table(f"table:impact-{anchor}", caption, columns, tuple(rows), numbered=False)
    return [drop_empty_columns(table)] if rows else []


def list_chain_blocks(lookup: Lookup, impact: PartnerImpact) -> Iterator[Block]:
    """Yield the chains that run through them, and the names of the others."""
    chains = lookup.architecture.chains
    rows = [
        (
            inline_text.to_inlines(Text(chains[each.result.id].title, ref=f"chain:{each.result.id}")),
            inline_text.to_inlines(f"{each.own_steps} of {len(each.result.terms)}"),
            _own_time_cell(each),
            _share_cell(each),
            inline_text.to_inlines(chains[each.result.id].deadline_text),
            chain_status.verdict_chip(each.result),
        )
        for each in impact.chains
    ]
    columns = make_columns(
        ("Chain", 2),
        ("Steps", 0.8, "right"),
        ("Takes", 0.9, "right"),
        ("Share", 1),
        ("Deadline", 0.8, "right"),
        ("Verdict", 0.8),
    )
    yield from make_table(
        "chains",
        "How many of its steps are theirs, how long these take, and their share of the deadline",
        columns,
        rows,
    )
    if impact.free_chains and impact.chains:
        titles = inline_text.join_inlines(
            (Text(chains[name].title, ref=f"chain:{name}"),) for name in impact.free_chains if name in chains
        )
        yield Paragraph(inline_text.to_inlines("Untouched: ", *titles, "."))


def _own_time_cell(chain: RestingChain) -> Inlines:
    value, sign = chain.own_time.value, "" if chain.own_time.complete else ">= "
    return (Text(sign + chain_status.round_duration(value, sign or "<"), sort_number=str(value)),) if value else ()


def _share_cell(chain: RestingChain) -> Inlines:
    deadline, own = chain.result.deadline, chain.own_time
    if not deadline or not deadline.value or own.value is None:
        return ()
    share = TimingValue(own.value / deadline.value, own.complete)
    meter = Meter(float(own.value / deadline.value), "open", is_partial=not own.complete)
    return (Text(value_format.display_share(share), meter=meter, sort_number=str(share.value)),)


def list_milestone_blocks(lookup: Lookup, impact: PartnerImpact) -> Iterator[Block]:
    """Yield the milestones that need them, with which of their components; with a day, where there are none, that."""
    components = lookup.architecture.components
    rows = [
        (
            (Text(each.milestone.title, ref=f"milestone:{each.milestone.id}"),),
            inline_text.to_inlines(each.milestone.date or "no day named"),
            inline_text.join_first([(inline_text.component_link(components[name]),) for name in each.components]),
        )
        for each in impact.milestones
    ]
    caption = (
        f"Those that cannot be kept if they are late until {impact.until}" if impact.until else "Those that need them"
    )
    yield from make_table("milestones", caption, make_columns(("Milestone", 1.5), ("Day", 0.8), ("Needs", 2)), rows)
    if impact.until and not rows:
        is_written = bool(lookup.architecture.milestones)
        lead = (
            f"None that is before {impact.until} needs them." if is_written else "The project writes no `milestones`."
        )
        yield Paragraph(inline_text.message_to_inlines(lead))


def _list_use_case_blocks(lookup: Lookup, impact: PartnerImpact) -> Iterator[Block]:
    rows = [
        (
            (*use_case_link(lookup, each.id), *_name_use_case(lookup, each.id)),
            (Text("".join(_STATE_SIGNS[state] for state in each.steps), code=True),),
            inline_text.to_inlines(describe_stop(each.stop, len(each.steps))),
        )
        for each in impact.use_cases
    ]
    legend = ", ".join(f"{sign} {_STATE_WORDS[state]}" for state, sign in _STATE_SIGNS.items())
    yield from make_table(
        "use-cases", f"A sign a step: {legend}", make_columns(("Use case", 1.5), "Steps", "Stops"), rows
    )


def _name_use_case(lookup: Lookup, use_case_id: str) -> Inlines:
    title = lookup.architecture.use_cases[use_case_id].title
    return (Text(f" {title}"),) if title != use_case_id else ()


def describe_stop(stop: int, count: int) -> str:
    """Say at which step a use case stops."""
    return f"at once, of {count_noun(count, 'step')}" if stop == 1 else f"at step {stop} of {count}"


def make_use_case_waterfall(lookup: Lookup, impact: PartnerImpact) -> Waterfall | None:
    """Return the steps of the use cases as bars, all on one scale."""
    longest = max((len(each.steps) for each in impact.use_cases), default=0)
    kinds: dict[StepState, WaterfallPiece] = {
        "runs": WaterfallPiece("sampling", 0, 0),
        "theirs": WaterfallPiece("response", 0, 0),
        "never": WaterfallPiece("link", 0, 0),
    }
    steps = []
    for each in impact.use_cases:
        pieces, at = [], 0
        for state, group in groupby(each.steps):
            end = at + len(list(group))
            tip = f"{'steps' if end - at > 1 else 'step'} {at + 1}{f' to {end}' if end - at > 1 else ''}: {_STATE_WORDS[state]}"
            pieces.append(WaterfallPiece(kinds[state].kind, at / longest, end / longest, tip))
            at = end
        link = Text(each.id, ref=f"use_case:{each.id}")
        note = _name_use_case(lookup, each.id)
        steps.append(WaterfallStep(link, note, tuple(pieces), f"stops {describe_stop(each.stop, len(each.steps))}"))
    legend = tuple((kinds[state].kind, words) for state, words in _STATE_WORDS.items())
    title = "How far the use cases get"
    return Waterfall((), (), (), (None, None), "", (), tuple(steps), "", (), (), title, legend) if steps else None


def _list_interface_blocks(lookup: Lookup, impact: PartnerImpact) -> Iterator[Block]:
    rows = [
        (
            (Text(f"{number}. "), Text(each.terms[0].title, ref=_reference(each))),
            inline_text.join_first([inline_text.partner_link(lookup.architecture, name) for name in each.takers]),
            inline_text.to_inlines(_count_rest(each)),
            inline_text.to_inlines(", ".join(each.open_words)),
            _stand_in_cell(each),
        )
        for number, each in enumerate(impact.interfaces, start=1)
    ]
    columns = make_columns(("What", 2.4), ("Who waits", 1.5), ("Rests on it", 1.4), ("Open", 1.1), ("Stand-in", 1.7))
    yield from make_table("interfaces", "By deadlines, then steps of use cases, then readers", columns, rows)
    readers = len({reader for each in impact.interfaces for reader in each.readers})
    if len(impact.interfaces) > impact.enough > 0:
        what = "the first" if impact.enough == 1 else f"the first {impact.enough}"
        yield Paragraph(
            inline_text.to_inlines(
                f"A recording or stub of {what} gives {'the reader' if readers == 1 else f'each of the {readers} readers'} something to work with."
            )
        )


def _reference(awaited: AwaitedInterface) -> str:
    return f"interface:{awaited.terms[0].interface.key}:{':'.join(awaited.terms[0].interface.pair)}"


def _stand_in_cell(awaited: AwaitedInterface) -> Inlines:
    interface = awaited.terms[0].interface
    if awaited.stand_in == "none":
        reason = "physical" if interface.flow == "physical" else "its message is not agreed"
        return inline_text.to_inlines(f"none: {reason}")
    names = inline_text.join_inlines((inline_text.topic_link(name),) for name in interface.topic_names)
    return (Text(awaited.stand_in), *((Text(" of "), *names) if names else ()))


def _count_rest(awaited: AwaitedInterface) -> str:
    counts = ((len(awaited.chains), "deadline"), (awaited.use_case_steps, "step"), (len(awaited.readers), "reader"))
    return ", ".join(count_noun(count, noun) for count, noun in counts if count)


def _number(count: int) -> Inlines:
    return (Text(str(count), sort_number=str(count)),) if count else ()


def _list_requirement_blocks(lookup: Lookup, impact: PartnerImpact) -> Iterator[Block]:
    rows = []
    for each in impact.requirements:
        owners = dict.fromkeys(owner for other in each.others for owner in other.owners)
        # Of what nobody owns the components are named.
        others = [inline_text.partner_link(lookup.architecture, owner) for owner in owners]
        others += [(inline_text.component_link(other),) for other in each.others if not other.owners]
        rows.append(
            (
                inline_text.to_inlines(Text(each.requirement.id, ref=f"requirement:{each.requirement.id}")),
                inline_text.to_inlines(each.requirement.title),
                inline_text.join_inlines(others) or inline_text.to_inlines("nobody else"),
            )
        )
    columns = make_columns(("Id", 0.6), ("Requirement", 3), ("Who else serves it", 1.5))
    yield from make_table("requirements", "Those that no other component serves first", columns, rows)


def _list_waiting_blocks(lookup: Lookup, impact: PartnerImpact) -> Iterator[Block]:
    architecture = lookup.architecture
    rows = [
        (
            inline_text.partner_link(architecture, each.id),
            _number(each.flow_count),
            inline_text.join_inlines(_describe_stand_ins(each), "; "),
            inline_text.join_inlines(
                (inline_text.component_link(architecture.components[name]),) for name in each.free_components
            ),
        )
        for each in impact.waiting
    ]
    columns = make_columns(("Partner", 1), ("Flows", 0.5, "right"), ("Meanwhile", 2), ("Runs without", 1.2))
    yield from make_table("waiting", "What can stand in for them", columns, rows)
    if impact.awaited:
        flows = sum(count for _, count in impact.awaited)
        names = join_first([f"{architecture.partners[partner].title} {count}" for partner, count in impact.awaited])
        yield Paragraph(inline_text.to_inlines(f"They wait for others too: {count_noun(flows, 'flow')}, of {names}."))


def _describe_stand_ins(waiting: WaitingPartner) -> Iterator[Inlines]:
    for kind, words in (("recording", "a recording or stub of "), ("stub", "a stub of "), ("none", "nothing yet for ")):
        links = [
            (inline_text.topic_link(names[0]) if names else Text(each.terms[0].title, ref=_reference(each)),)
            for each in waiting.interfaces
            if each.stand_in == kind
            for names in (each.terms[0].interface.topic_names,)
        ]
        if links:
            yield (Text(words), *inline_text.join_first(links))
