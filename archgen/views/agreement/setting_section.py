"""The section on parameters and operations: what one partner declares, and the other one sets or may call."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.model.architecture import Architecture
from archgen.model.parameter import format_parameter
from archgen.model.partner_interfaces import components_at_ends, find_interfaces_between
from archgen.model.setting_sharing import (
    ParameterSetter,
    SharedOperation,
    SharedParameter,
    find_shared_operations,
    find_shared_parameters,
)
from archgen.views import inline_text
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.elements.parameter_blocks import describe_limits, describe_types
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.shapes import (
    Block,
    Inlines,
    Paragraph,
    Section,
    Table,
    Text,
    drop_empty_columns,
    make_columns,
)

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
