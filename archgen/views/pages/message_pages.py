"""The site's pages on messages, services and actions: fields, constants, comments, and who sends and reads them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TypeVar

from archgen.diagnostics import order_naturally
from archgen.frozen import replace
from archgen.model.component import Output
from archgen.model.known_interfaces import Interface, InterfaceField
from archgen.model.message_types import ConceptualType, flow_of
from archgen.model.node import Topic
from archgen.views import inline_text
from archgen.views.agreement.message_fields import field_type_run
from archgen.views.element_references import message_link
from archgen.views.elements.type_fields import make_constant_table
from archgen.views.lookup import Lookup, collect_messages, group_values, list_fields
from archgen.views.shapes import (
    Block,
    Column,
    Inlines,
    Page,
    Paragraph,
    Section,
    Table,
    Text,
    drop_column,
    drop_empty_columns,
    make_columns,
    show_known,
)
from archgen.views.tables import deployment_tables

T = TypeVar("T")

_KIND_TITLES = {"topic": "Message", "service": "Service", "action": "Action"}
_PART_TITLES = {"request": "Request", "response": "Answer", "goal": "Goal", "result": "Result", "feedback": "Feedback"}
_MAX_NAMED_TOPICS = 20
_LIST_CRUMB = ("Messages", "page:messages")


class MessagePages:
    """Makes the pages of the messages that these types and topics use, and the list of them."""

    def __init__(self, lookup: Lookup, types: Iterable[ConceptualType], topics: Iterable[Topic]) -> None:
        self._lookup = lookup
        self._types = tuple(types)
        self._topics = tuple(sorted(topics, key=lambda each: order_naturally(each.name)))
        self._users = collect_messages(lookup.architecture, self._types, self._topics)
        self._types_by_message = group_values((each.message, each) for each in self._types if each.message)
        self._topics_by_message = group_values((name, each) for each in self._topics for name in each.messages)
        self._containers = group_values(
            (inner, message)
            for message in self._users
            for inner in dict.fromkeys(field.type for field in list_fields(lookup.architecture, message))
            if "/" in inner
        )

    def _topic_cell(self, message: str) -> Inlines:
        """Link to what carries a message; of many to the first, and to the message's page, which lists all."""
        topics = self._topics_by_message.get(message, ())
        links: list[Inlines] = [(inline_text.topic_link(each.name),) for each in topics[:_MAX_NAMED_TOPICS]]
        if hidden_count := len(topics) - len(links):
            links.append((replace(message_link(message), text=f"{hidden_count:,} more", code=False),))
        return inline_text.join_inlines(links)

    def make_list(self) -> Table | None:
        """List all messages by name; None where there are none."""
        rows = tuple(
            (
                (message_link(message),),
                inline_text.to_inlines(_KIND_TITLES[flow_of(message)].lower()),
                (Text(str(len(fields)), sort_number=str(len(fields))),)
                if (fields := self._fields_of(message)) is not None
                else (),
                self._size_cell(message),
                inline_text.join_inlines(inline_text.type_link(each.name) for each in self._types_of(message)),
                self._topic_cell(message),
            )
            for message in sorted(self._users, key=order_naturally)
        )
        columns = make_columns(
            ("Name", 1.9),
            ("Kind", 0.6),
            ("Fields", 0.5, "right"),
            ("Size", 0.9, "right"),
            ("Types", 1.2),
            ("Carried by", 1.9),
        )
        table = Table("table:messages", "Messages, services and actions", columns, rows)
        return drop_empty_columns(table) if rows else None

    def make_pages(self) -> Iterator[Page]:
        """Make a page for each message, by name."""
        for message in sorted(self._users, key=order_naturally):
            package, kind, name = message.split("/")
            blocks = (
                *self._make_fact_blocks(message),
                *self._make_field_blocks(message),
                *self._make_use_blocks(message),
            )
            section = Section(f"message:{message}", message, tuple(blocks))
            # The path of the file that defines it: `messages/sensor_msgs/msg/image.html`.
            path = f"messages/{package}/{kind}/{name}.html".lower()
            yield Page(
                path,
                section.anchor,
                name,
                "messages",
                section,
                (("Overview", "page:index"), _LIST_CRUMB),
                f"{_KIND_TITLES[flow_of(message)]} · {package}",
            )

    def _definition_of(self, message: str) -> Interface | None:
        return self._lookup.architecture.interfaces.definitions.get(message)

    def _fields_of(self, message: str) -> tuple[InterfaceField, ...] | None:
        return list_fields(self._lookup.architecture, message) if self._definition_of(message) else None

    def _types_of(self, message: str) -> tuple[ConceptualType, ...]:
        return self._types_by_message.get(message, ())

    def _size_cell(self, message: str) -> Inlines:
        size = self._lookup.message_size(message, None) if flow_of(message) == "topic" else None
        return (Text(str(size), sort_number=str(size.bytes)),) if size and size.bytes is not None else ()

    def _make_fact_blocks(self, message: str) -> Iterator[Block]:
        definition = self._definition_of(message)
        facts = (
            ("Full name", inline_text.to_code(message)),
            ("Size", self._size_cell(message)),
            ("Types", inline_text.join_inlines(inline_text.type_link(each.name) for each in self._types_of(message))),
            ("Part of", inline_text.join_inlines((message_link(each),) for each in self._containers.get(message, ()))),
            ("Definition", self._describe_definition(message)),
        )
        yield show_known(facts)
        if definition and definition.comment:
            yield Paragraph(inline_text.join_lines((Text(line),) for line in definition.comment.splitlines()))

    def _describe_definition(self, message: str) -> Inlines:
        interfaces = self._lookup.architecture.interfaces
        package = message.split("/", maxsplit=1)[0]
        if self._definition_of(message) is None:
            return (Text("not at hand: give the package's files below ros.interfaces to see its fields", muted=True),)
        defining_types = [each for each in self._types_of(message) if each.has_content]
        if defining_types:
            return (Text("by the fields of the type "), *inline_text.type_link(defining_types[0].name))
        if package in interfaces.project_packages:
            return (Text("in the project's own files"),)
        return (Text(f"as ROS {(interfaces.distro or '').capitalize()}".rstrip() + " has it"),)

    def _make_field_blocks(self, message: str) -> Iterator[Block]:
        definition = self._definition_of(message)
        if definition is None:
            return
        constants = definition.constants or ((),) * len(definition.parts)
        for part, fields, part_constants in zip(definition.part_names, definition.parts, constants, strict=True):
            title = _PART_TITLES.get(part, "")
            if fields:
                yield self._make_field_table(f"table:fields/{message}/{part}", title, fields)
            if part_constants:
                caption = f"{title}: constants" if title else "Constants"
                yield make_constant_table(part_constants, f"table:constants/{message}/{part}", caption)
            if not fields and not part_constants:
                yield Paragraph(inline_text.to_inlines(f"{title}: nothing." if title else "It has no fields."))

    def _make_field_table(self, anchor: str, title: str, fields: tuple[InterfaceField, ...]) -> Table:
        rows = tuple(
            (
                inline_text.to_code(field.name),
                self._field_type_cell(field),
                inline_text.to_code(field.default),
                inline_text.to_inlines(field.comment),
            )
            for field in fields
        )
        columns = (Column("Field", 1.2), Column("Type", 1.5), Column("Default", 0.6), Column("Meaning", 2))
        return drop_empty_columns(Table(anchor, f"{title}: fields" if title else "Fields", columns, rows))

    def _field_type_cell(self, field: InterfaceField) -> Inlines:
        is_unknown = "/" in field.type and self._definition_of(field.type) is None
        remark = (Text(" definition not at hand", muted=True),) if is_unknown else ()
        return (field_type_run(field.type, f"{field.type}{field.array}"), *remark)

    def _make_use_blocks(self, message: str) -> Iterator[Block]:
        """Yield who sends and reads it: on which topics, and by which ports of components."""
        topics = self._topics_by_message.get(message, ())
        topic_table = deployment_tables.make_topic_table(
            self._lookup, topics, f"table:carriers/{message}", "Topics, services and actions that carry it"
        )
        if topic_table:
            yield drop_column(topic_table, "carried")
        outputs = [output for each in self._types_of(message) for output in self._shown_outputs(each)]
        if outputs:
            yield self._make_port_table(message, outputs)
        if not topic_table and not outputs:
            containers = " by itself" if self._containers.get(message) else ""
            yield Paragraph(inline_text.to_inlines(f"Nobody sends it{containers}."))

    def _shown_outputs(self, conceptual_type: ConceptualType) -> list[Output]:
        lookup = self._lookup
        return [
            output
            for output in lookup.outputs_of_type.get(conceptual_type.name, ())
            if lookup.scope.shows_component(output.component)
            or any(
                lookup.scope.shows_component(lookup.architecture.inputs[connection.input].component)
                for connection in lookup.readers_of.get(output.id, ())
            )
        ]

    def _make_port_table(self, message: str, outputs: Iterable[Output]) -> Table:
        architecture = self._lookup.architecture
        rows = tuple(
            (
                inline_text.port_link(architecture, output),
                inline_text.owner_links(architecture, architecture.components[output.component].owners),
                inline_text.type_link(output.type),
                inline_text.join_lines(
                    inline_text.port_link(architecture, architecture.inputs[connection.input])
                    for connection in self._lookup.readers_of.get(output.id, ())
                )
                or inline_text.to_inlines(Text("nobody yet", muted=True)),
            )
            for output in outputs
        )
        columns = (Column("Given by", 1.5), Column("Owner", 0.9), Column("Type"), Column("Read by", 1.7))
        return Table(f"table:ports/{message}", "Outputs that give it, and who reads them", columns, rows)
