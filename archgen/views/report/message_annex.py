"""The project's own messages, services and actions on paper: the fields and constants of each, one on a line."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from archgen.model.known_interfaces import Interface, InterfaceConstant, InterfaceField
from archgen.views import inline_text
from archgen.views.agreement.message_fields import field_type_run
from archgen.views.lookup import Lookup
from archgen.views.pages.context_pages import shown_topics
from archgen.views.report.ros_blocks import shorten_message
from archgen.views.shapes import Column, Inlines, Paragraph, Section, Table, Text
from archgen.views.tables import type_tables
from archgen.views.used_messages import collect_messages

_PART_TITLES = {"response": "answer"}


def make_message_annex(lookup: Lookup) -> Section | None:
    """List the fields of the messages that the project defines itself; None where what is shown uses none of them.

    Those of ROS's packages are left out: each distribution documents them, and they would be three times as many.
    """
    interfaces = lookup.architecture.interfaces
    used_messages = collect_messages(lookup.architecture, type_tables.shown_types(lookup), shown_topics(lookup))
    own_messages = [
        message
        for message in sorted(used_messages)
        if message in interfaces.definitions and message.partition("/")[0] in interfaces.project_packages
    ]
    if not own_messages:
        return None
    rows = tuple(
        (
            (Text(shorten_message(message), code=True, strong=True),),
            inline_text.join_lines(_list_lines(interfaces.definitions[message]))
            or inline_text.to_inlines(Text("no fields", muted=True)),
        )
        for message in own_messages
    )
    anchors = tuple(f"message:{message}" for message in own_messages)
    columns = (Column("Message", 1.2), Column("Fields and constants", 3))
    lead = Paragraph((Text("What the project defines itself; other messages are in the documentation of ROS."),))
    table = Table(
        "table:message_fields", "Fields of the project's own messages, services and actions", columns, rows, anchors
    )
    return Section("page:messages", "Messages", (lead, table), appendix=True, page_break=False)


def _list_lines(definition: Interface) -> Iterator[Inlines]:
    """Yield lines: the comment of a definition, fields with a meaning one by one, others and constants side by side."""
    if definition.comment:
        yield inline_text.to_inlines(" ".join(definition.comment.split()))
    constants = definition.constants or ((),) * len(definition.parts)
    for part, fields, part_constants in zip(definition.part_names, definition.parts, constants, strict=True):
        title = (Text(f"{_PART_TITLES.get(part, part)} ", emphasis=True),) if part else ()
        for is_explained, same_fields in itertools.groupby(fields, key=lambda field: bool(field.comment)):
            phrases = [_phrase_field(field) for field in same_fields]
            lines = phrases if is_explained else [inline_text.join_inlines(phrases)]
            yield from ((*title, *line) for line in lines)
        for is_explained, same_constants in itertools.groupby(part_constants, key=lambda each: bool(each.comment)):
            phrases = [_phrase_constant(constant) for constant in same_constants]
            lines = phrases if is_explained else [inline_text.join_inlines(phrases)]
            yield from ((*title, *line) for line in lines)


def _phrase_field(field: InterfaceField) -> Inlines:
    type_text = shorten_message(f"{field.type}{field.array}")
    default = f" = {field.default}" if field.default else ""
    return (
        Text(field.name, code=True),
        Text(": "),
        field_type_run(field.type, f"{type_text}{default}"),
        *_phrase_comment(field.comment),
    )


def _phrase_constant(constant: InterfaceConstant) -> Inlines:
    return (
        Text(constant.name, code=True),
        Text(" = "),
        Text(constant.value, code=True),
        *_phrase_comment(constant.comment),
    )


def _phrase_comment(comment: str) -> Inlines:
    return (Text(f" ({' '.join(comment.split())})", muted=True),) if comment else ()
