"""The sections on more than one interface: what holds for all of them, the start-up, use cases, frames,
budgets, and the parameters and operations that one declares and the other one sets or may call.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping

from archgen.bringup.plan_shapes import StartStep
from archgen.bringup.start_plan import make_start_plan
from archgen.model.agreed_terms import GENERAL_TERMS, find_agreement
from archgen.model.architecture import Architecture
from archgen.model.parameter import describe_types, format_parameter
from archgen.model.partner_interfaces import (
    ParameterSetter,
    SharedFrame,
    SharedOperation,
    SharedParameter,
    components_at_ends,
    find_interfaces_between,
    find_shared_frames,
    find_shared_operations,
    find_shared_parameters,
)
from archgen.model.step_connections import ConnectedStep
from archgen.timing.analysis import ChainResult
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.search.chain_budgets import SharedBudget
from archgen.views import inline_text, start_phrases
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.agreement.interface_record import InterfaceRecord
from archgen.views.agreement.term_changes import AgreementChanges
from archgen.views.elements.parameter_blocks import describe_limits
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.sequences.sequence_blocks import make_step_table
from archgen.views.shapes import (
    Block,
    Column,
    Facts,
    Inlines,
    Paragraph,
    Section,
    Table,
    Text,
    drop_empty_columns,
    make_columns,
)
from archgen.views.tables.functional_tables import link_declared_frame, link_writer
from archgen.views.tables.start_table import link_step
from archgen.views.timing import value_format

_LEAD = "One of the two declares these at a component, and the other one sets them, or may call them."
_Terms = Mapping[str, tuple[object, ...]]
"""What binds the two of each parameter and operation, by its name with its component."""


def write_setting_section(content: AgreementContent) -> Iterator[Section]:
    """Yield the section, where there is anything of the kind."""
    marks = _mark_settings(content)
    tables = (*_make_parameter_table(content, marks), *_make_operation_table(content, marks))
    if tables:
        lead: Block = Paragraph(inline_text.to_inlines(_LEAD))
        yield Section("page:settings", "Parameters and operations", (lead, *tables))


def list_changed_settings(content: AgreementContent) -> tuple[str, ...]:
    """Return the names of what is not as it was at the earlier revision, of what is gone too."""
    return tuple(_mark_settings(content))


def _make_parameter_table(content: AgreementContent, marks: Mapping[str, Text]) -> Iterator[Table]:
    rows = tuple(
        (
            (Text(shared.parameter.name, code=True),),
            (inline_text.component_link(shared.component),),
            inline_text.to_inlines(join_owner_titles(content.lookup, [shared.giver])),
            inline_text.to_inlines(shared.parameter.type),
            inline_text.to_inlines(shared.parameter.unit),
            inline_text.to_inlines(describe_limits(shared.parameter)),
            inline_text.join_lines(_describe_setter(content, each) for each in shared.setters),
            _mark_cell(marks, _name_parameter(shared)),
        )
        for shared in find_shared_parameters(content.lookup.architecture, content.pair)
    )
    columns = make_columns(
        ("Parameter", 1.1),
        ("Component", 1.1),
        ("Declared by", 0.9),
        ("Type", 0.6),
        ("Unit", 0.5),
        ("May be", 0.9),
        ("Set by", 1.4),
        ("Change", 0.7),
    )
    if rows:
        yield drop_empty_columns(Table("table:shared_parameters", "Parameters between the two", columns, rows))


def _describe_setter(content: AgreementContent, setter: ParameterSetter) -> Inlines:
    architecture = content.lookup.architecture
    link = (
        inline_text.node_link(architecture.nodes[setter.id])
        if setter.is_node
        else inline_text.component_link(architecture.shells.get(setter.id) or architecture.components[setter.id])
    )
    return (link, Text(": "), Text(format_parameter(setter.value), code=True))


def _make_operation_table(content: AgreementContent, marks: Mapping[str, Text]) -> Iterator[Table]:
    rows = tuple(
        (
            (Text(shared.operation.id, code=True),),
            (inline_text.component_link(shared.component),),
            inline_text.to_inlines(join_owner_titles(content.lookup, [shared.giver])),
            inline_text.to_inlines(describe_types(shared.operation.request or "")),
            inline_text.to_inlines(describe_types(shared.operation.response or "")),
            inline_text.to_inlines(shared.operation.call),
            _mark_cell(marks, _name_operation(shared)),
        )
        for shared in _list_operations(content.lookup.architecture, content.pair)
    )
    columns = make_columns(
        ("Operation", 1.1),
        ("Component", 1.1),
        ("Offered by", 0.9),
        ("Request", 1.2),
        ("Response", 1.2),
        ("Call", 0.8),
        ("Change", 0.7),
    )
    if rows:
        yield drop_empty_columns(Table("table:shared_operations", "Operations between the two", columns, rows))


def _mark_cell(marks: Mapping[str, Text], name: str) -> Inlines:
    return (marks[name],) if name in marks else ()


def _list_operations(architecture: Architecture, pair: tuple[str, str]) -> tuple[SharedOperation, ...]:
    """Return the operations of the components that give the other partner something: whoever only gives calls nothing."""
    ends = (
        component.id
        for interface in find_interfaces_between(architecture, *pair)
        for component in components_at_ends(architecture, interface)[0]
    )
    return find_shared_operations(architecture, dict.fromkeys(ends), pair)


def _mark_settings(content: AgreementContent) -> dict[str, Text]:
    return content.mark_changes(lambda architecture: _list_terms(architecture, content.pair))


def _list_terms(architecture: Architecture, pair: tuple[str, str]) -> _Terms:
    parameters = {
        _name_parameter(shared): (
            shared.giver,
            shared.parameter.type,
            shared.parameter.unit,
            shared.parameter.range,
            shared.parameter.choices,
            # Which value it is remains the business of whoever sets it.
            tuple(setter.id for setter in shared.setters),
        )
        for shared in find_shared_parameters(architecture, pair)
    }
    operations = {
        _name_operation(shared): (
            shared.giver,
            describe_types(shared.operation.request or ""),
            describe_types(shared.operation.response or ""),
            shared.operation.call,
        )
        for shared in _list_operations(architecture, pair)
    }
    return {**parameters, **operations}


def _name_parameter(shared: SharedParameter) -> str:
    return f"{shared.component.id}: {shared.parameter.name}"


def _name_operation(shared: SharedOperation) -> str:
    return f"{shared.component.id}: {shared.operation.id}()"


BudgetFinder = Callable[[ChainResult], SharedBudget | None]
"""Finds what all elements of a chain may take together; None where there is no budget."""
_BUDGET_LEAD = (
    "How long each element of the two on a chain that crosses from one to the other may take, if everything on the chain and "
    "on its hosts grows alike. Who keeps to it keeps the deadlines, as long as all others do. Elements that stand on several "
    "chains are bound by the smallest figure."
)


def find_crossing_budgets(records: Iterable[InterfaceRecord], find_budget: BudgetFinder) -> dict[str, SharedBudget]:
    """Return the budgets of the chains that lead over some interfaces, by chain."""
    crossing_chains = {chain.id: chain for record in records for chain in record.terms.chains}
    budgets = {chain_id: find_budget(chain) for chain_id, chain in crossing_chains.items()}
    return {chain_id: budget for chain_id, budget in budgets.items() if budget is not None}


def write_budget_section(content: AgreementContent) -> Iterator[Section]:
    """Write the table of what each element of the two may take; nothing where no chain has a budget."""
    rows = [row for chain_id, budget in content.budgets.items() for row in _chain_rows(content, chain_id, budget)]
    if rows:
        columns = make_columns(
            ("Chain", 1.3), ("Partner", 0.8), ("Element", 1.4), ("Written", 0.6, "right"), ("May take", 0.7, "right")
        )
        table = Table("table:budgets", "Who may take how much", columns, tuple(rows), numbered=False)
        yield Section("page:budgets", "Execution times", (Paragraph(inline_text.to_inlines(_BUDGET_LEAD)), table))


def _chain_rows(content: AgreementContent, chain_id: str, budget: SharedBudget) -> Iterator[tuple[Inlines, ...]]:
    own_shares = [share for share in budget.shares if share.on_chain and set(share.owners) & set(content.pair)]
    for number, share in enumerate(own_shares):
        yield (
            () if number else _chain_cell(content, chain_id, budget),
            inline_text.to_inlines(join_owner_titles(content.lookup, share.owners)),
            inline_text.to_code(share.activity),
            inline_text.to_inlines(value_format.display_duration(TimingValue(share.written))),
            # Exact, so that it still keeps the deadline.
            inline_text.to_inlines(figure_wording.write_exact_duration(share.may_take)),
        )


def _chain_cell(content: AgreementContent, chain_id: str, budget: SharedBudget) -> Inlines:
    chain = content.lookup.architecture.chains[chain_id]
    parts = [f"{chain.deadline} in all"] if chain.deadline else []
    parts += [f"all times {figure_wording.format_number(budget.factor)}"] if budget.factor is not None else []
    return inline_text.join_lines([inline_text.to_inlines(chain.title), (Text(", ".join(parts), muted=True),)])


_FRAME_LEAD = "These frames are written by one of the two, and used by the other one: its data is given or expected in them, or its own frames are placed in them."


def write_frame_section(content: AgreementContent) -> Iterator[Section]:
    """Yield the section, where there is such a frame."""
    shared_frames = find_shared_frames(content.lookup.architecture, *content.pair)
    if shared_frames:
        marks = _mark_frames(content)
        columns = make_columns(
            "Frame",
            ("Partner", 0.9),
            ("Written by", 1.1),
            ("Placed in", 0.9),
            ("Rate", 0.6, "right"),
            ("Used for", 1.7),
            ("Change", 0.7),
        )
        rows = tuple(_frame_row(content, shared, marks.get(shared.frame.id)) for shared in shared_frames)
        table = drop_empty_columns(Table("table:shared_frames", "Frames between the two", columns, rows))
        yield Section("page:frames", "Frames", (Paragraph(inline_text.to_inlines(_FRAME_LEAD)), table))


def list_changed_frames(content: AgreementContent) -> tuple[str, ...]:
    """Return the names of the frames that are not what they were at the earlier revision, those that are gone too."""
    return tuple(_mark_frames(content))


def _frame_row(content: AgreementContent, shared: SharedFrame, mark: Text | None) -> tuple[Inlines, ...]:
    architecture, frame = content.lookup.architecture, shared.frame
    rate = inline_text.to_inlines("static") if frame.static else inline_text.quantity_to_inlines(frame.rate)
    ports = (inline_text.port_id_link(architecture, name) for name in shared.ports)
    frames = (link_declared_frame(architecture, name) for name in shared.frames)
    return (
        (Text(frame.id, code=True),),
        inline_text.to_inlines(join_owner_titles(content.lookup, [shared.giver])),
        link_writer(architecture, frame),
        link_declared_frame(architecture, frame.parent or ""),
        rate,
        inline_text.join_inlines((*ports, *frames)),
        (mark,) if mark else (),
    )


def _mark_frames(content: AgreementContent) -> dict[str, Text]:
    return content.mark_changes(
        lambda architecture: {
            shared.frame.id: _plain_terms(shared) for shared in find_shared_frames(architecture, *content.pair)
        }
    )


def _plain_terms(shared: SharedFrame) -> tuple[object, ...]:
    frame = shared.frame
    return shared.giver, shared.ports, shared.frames, frame.parent, frame.by, frame.rate, frame.static


_USE_CASE_LEAD = (
    "What the interfaces are there for: these steps run along them, under their numbers in the whole use case. They say what happens "
    "and change no interface."
)


def write_use_case_section(content: AgreementContent) -> Iterator[Section]:
    """Yield the section, where steps of use cases run from one of the two to the other."""
    lookup = content.lookup
    tables = []
    for use_case_id, steps in _list_crossing_steps(content).items():
        table = make_step_table(lookup, lookup.architecture.use_cases[use_case_id], steps)
        tables.append(table)
    if tables:
        yield Section("page:use_cases", "Use cases", (Paragraph(inline_text.to_inlines(_USE_CASE_LEAD)), *tables))


def _list_crossing_steps(content: AgreementContent) -> dict[str, tuple[ConnectedStep, ...]]:
    """Return the steps that run along an interface of the two, by use case."""
    interfaces = [record.terms.interface for record in content.records]
    crossings = {(each.output.id, port.id) for each in interfaces if each.output is not None for port in each.inputs}
    crossing_steps = {
        use_case_id: tuple(
            each for each in steps if any((way.output, way.input) in crossings for way in each.connections)
        )
        for use_case_id, steps in content.lookup.steps.by_use_case.items()
    }
    return {use_case_id: steps for use_case_id, steps in crossing_steps.items() if steps}


_START_LEAD = (
    "When the robot starts, one of the two waits for the other one here. Each says how one sees that its own is up. The order "
    "follows from the connections, the phases and what is written; it is no term of an interface."
)


def list_start_steps(architecture: Architecture) -> dict[str, StartStep]:
    """Return the steps by id; none where the project does not describe its start-up."""
    return {step.id: step for step in make_start_plan(architecture).steps} if architecture.describes_start() else {}


def write_start_section(content: AgreementContent) -> Iterator[Section]:
    """Yield the section, where the project describes its start-up and one of the two waits for the other."""
    steps = list_start_steps(content.lookup.architecture)
    rows = tuple(row for step in steps.values() for row in _list_rows(content, step, steps))
    if rows:
        columns = make_columns(
            ("What waits", 1.1), ("Partner", 0.9), ("For what", 1.1), ("Partner", 0.9), ("Until", 1.3), ("Why", 1.8)
        )
        table = drop_empty_columns(Table("table:shared_start", "Who waits for whom", columns, rows))
        yield Section("page:start", "Start-up", (Paragraph(inline_text.to_inlines(_START_LEAD)), table))


def _list_rows(
    content: AgreementContent, step: StartStep, steps: dict[str, StartStep]
) -> Iterator[tuple[Inlines, ...]]:
    for named in start_phrases.name_waits(step):
        awaited = steps[named.awaited]
        pair = _find_direction(content, step, awaited)
        if pair is not None:
            until = {"ended": "it has ended", "started": "it is started"}.get(named.until)
            sign = until or start_phrases.describe_ready(awaited) or "it is started"
            yield (
                (link_step(step),),
                inline_text.to_inlines(join_owner_titles(content.lookup, pair[:1])),
                (link_step(awaited),),
                inline_text.to_inlines(join_owner_titles(content.lookup, pair[1:])),
                inline_text.to_inlines(sign),
                (Text("; ".join(named.reasons), muted=True),),
            )


def _find_direction(content: AgreementContent, step: StartStep, awaited: StartStep) -> tuple[str, str] | None:
    """Return who of the two waits and who is awaited; None where that is somebody else, or both at both ends."""
    own, other = (_list_owners(content, each) for each in (step, awaited))
    for pair in (content.pair, content.pair[::-1]):
        if pair[0] in own and pair[1] in other and not (pair[1] in own and pair[0] in other):
            return pair[0], pair[1]
    return None


def _list_owners(content: AgreementContent, step: StartStep) -> frozenset[str]:
    """Return the owners of what a step starts; those of a container are the owners of all that it loads."""
    nodes = content.lookup.architecture.nodes
    if step.kind != "container":
        return frozenset(nodes[step.id].owners)
    return frozenset(owner for node in nodes.values() if node.container == step.container for owner in node.owners)


_TERMS_LEAD = (
    "What the two agree on in words, for all interfaces; each interface's own section has the rest. Where it says that nothing "
    "is said, neither of the two owes the other one anything in this respect."
)
_ALWAYS = "The project has no variants: what stands here holds always."
_OTHERS = "What holds in others, documents of their own say."


def write_terms_section(content: AgreementContent) -> Section:
    """Write the terms, each with what is not said; and what differs in which variant."""
    terms = find_agreement(content.lookup.architecture.agreements, *content.pair).terms
    nothing = inline_text.to_inlines(Text("nothing is said of it", muted=True))
    rows = [
        (title, inline_text.message_to_inlines(terms[name]) if name in terms else nothing)
        for name, title in GENERAL_TERMS.items()
    ]
    rows.append(("Variants", inline_text.to_inlines(" ".join(_describe_variants(content)))))
    lead = Paragraph(inline_text.to_inlines(_TERMS_LEAD))
    return Section("page:terms", "Terms", (lead, Facts(tuple(rows)), *_write_variant_table(content)))


def describe_standing(content: AgreementContent) -> str:
    """Return in which variant a document holds; empty where the project has none."""
    if content.standing:
        return f"as it stands in {', '.join(content.standing)}"
    return "without its variants" if content.lookup.architecture.variants else ""


def list_variant_differences(changes: AgreementChanges) -> Iterator[str]:
    """Yield sentences on what two partners owe each other otherwise in a variant."""
    yield from (f"`{key[0]}` is there, too." for key in sorted(changes.added_keys))
    yield from (f"`{record.key[0]}` is not there." for record in changes.removed_records)
    for key in sorted(changes.changes_by_key):
        for term in changes.terms_of(key):
            if not term.is_expected and term.term_kind != "title":
                yield f"`{key[0]}`: {term.name}: {term.after or 'nothing'}; here: {term.before or 'nothing'}."


def _describe_variants(content: AgreementContent) -> Iterator[str]:
    standing = describe_standing(content)
    yield f"This document holds for the project {standing}." if standing else _ALWAYS
    if content.standing:
        yield _OTHERS


def _write_variant_table(content: AgreementContent) -> Iterator[Table]:
    rows: list[tuple[Inlines, ...]] = []
    for name, changes in content.variant_changes.items():
        differences = list(list_variant_differences(changes)) or ["Nothing: it is as here."]
        title = content.lookup.architecture.variants[name].title
        lines = inline_text.join_lines(map(inline_text.message_to_inlines, differences))
        rows.append((inline_text.to_inlines(title), lines))
    if rows:
        columns = (Column("Variant", 0.8), Column("What differs between the two", 3))
        yield Table("table:agreed_variants", "What differs in variants", columns, tuple(rows), numbered=False)
