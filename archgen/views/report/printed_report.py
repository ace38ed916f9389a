"""The report for paper: the outline of all documents, with its blocks put together, and what few read moved to annexes.

Nothing is left out that the outline says; tests/views/test_printed_report.py compares the two, and names what is said in
another place or shorter.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterable, Iterator, Mapping

from archgen.model.known_interfaces import Interface, InterfaceConstant, InterfaceField
from archgen.views import inline_text
from archgen.views.agreement.message_fields import field_type_run
from archgen.views.elements.functional_level import list_group_facts
from archgen.views.graphs.element_boxes import name_in_place
from archgen.views.lookup import Lookup, collect_messages
from archgen.views.pages import report_outline
from archgen.views.pages.component_pages import list_group_parts
from archgen.views.pages.context_pages import shown_topics
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.picture_shapes import Drawing, Graph, Sheet
from archgen.views.report import condensed_blocks, front_pages
from archgen.views.report.condensed_blocks import shorten_message
from archgen.views.report.figure_mentions import mention_section
from archgen.views.report.printed_figures import print_section_figures
from archgen.views.report.report_drawings import LEGEND_NAME, is_piece_of, make_report_drawings
from archgen.views.sequences.sequence_charts import CHART_PREFIX
from archgen.views.shapes import (
    Block,
    Column,
    Facts,
    Figure,
    Inlines,
    Markdown,
    Outline,
    Paragraph,
    Section,
    Table,
    Text,
    drop_column,
)
from archgen.views.tables import type_tables

_TIMING_ANNEX = "Rates, loads and traffic"
_LARGE_DRAWINGS = ("components", "ros", "timing")
"""Pictures of all components or nodes, which A4 paper shows too small to read."""


def make_printed_report(lookup: Lookup, edition: DocumentEdition) -> Outline:
    """Make the outline of the printed report; appendices are at the end."""
    outline = report_outline.make_report(lookup, edition)
    shows_ros = edition.level == "implementation"
    printer = _ReportPrinter(lookup, edition, make_report_drawings(lookup, edition.drawings, shows_ros=shows_ros))
    sections = [part for section in outline.sections for part in printer.print_section(section)]
    overview = next((section for section in sections if section.anchor == "page:index"), None)
    summary = front_pages.make_summary(lookup, edition, overview)
    if summary:
        # It has all of the overview, which would stand behind the project's own introduction.
        sections = [summary, *(section for section in sections if section is not overview)]
    body = [section for section in sections if not section.appendix]
    annexes = [section for section in sections if section.appendix]
    return dataclasses.replace(
        outline,
        facts=front_pages.make_title_facts(lookup, edition),
        sections=tuple(
            mention_section(print_section_figures(each)) for each in (*body, *printer.make_ros_annexes(), *annexes)
        ),
        title_table=front_pages.make_partner_table(lookup),
        front_sections=tuple(
            print_section_figures(each)
            for each in front_pages.make_front_sections(lookup, edition, printer.find_legend())
        ),
        properties=front_pages.list_properties(lookup, edition),
        lists=edition.settings.lists,
        has_large_paper=edition.settings.has_large_paper,
    )


@dataclasses.dataclass(frozen=True, slots=True)
class _ReportPrinter:
    """Rewrites the sections of the outline for paper. `drawings` are those of the report, by the names in the outline."""

    lookup: Lookup
    edition: DocumentEdition
    drawings: Mapping[str, Drawing]

    def find_legend(self) -> Drawing | None:
        """Return the picture of the legend, None where no picture is drawn anew for the report."""
        return self.drawings.get(LEGEND_NAME) if self.edition.drawings else None

    def print_section(self, section: Section) -> tuple[Section, ...]:
        """Return what becomes of a chapter: itself, and the annexes that some of it moves to."""
        if section.kind == "group":
            return (self._print_group(section),)
        if section.anchor == "page:timing":
            return tuple(self._split_timing(section))
        printed_section = self._print_others(section)
        # All of it may be pictures that only large paper has.
        return (printed_section,) if printed_section.blocks or printed_section.sections else ()

    def _print_others(self, section: Section) -> Section:
        blocks = tuple(_unturn_tables(self._keep_legible(section.blocks)))
        if section.anchor == "page:requirements" and (
            table := front_pages.make_use_case_table(self.lookup, has_chapter="use_cases" in self.edition.chapter_names)
        ):
            blocks = (table, *blocks)
        sections = tuple(self._print_others(each) for each in section.sections)
        # Annexes are looked up, not read: they follow one another without the rest of a page between them.
        page_break = section.page_break and not section.appendix
        return dataclasses.replace(section, blocks=blocks, sections=sections, page_break=page_break)

    def _keep_legible(self, blocks: Iterable[Block]) -> Iterator[Block]:
        """Yield blocks with the report's own pictures; those of the whole architecture come on large paper alone."""
        for block in blocks:
            if not isinstance(block, Figure):
                yield block
            elif block.graph.startswith(CHART_PREFIX) and not isinstance(self.drawings.get(block.graph), Sheet):
                yield from self._print_sequence(block)
            elif (
                block.graph not in _LARGE_DRAWINGS or self.edition.settings.has_large_paper
            ) and block.graph in self.drawings:
                yield from self._print_picture(block, self.drawings[block.graph])

    def _print_picture(self, figure: Figure, drawing: Drawing) -> Iterator[Figure]:
        """Yield a figure with the report's own picture and what that shows; a group in which nothing flows has none."""
        if isinstance(drawing, Graph) and drawing.kind in {"group", "group-timing"} and not drawing.arrows:
            return
        caption = figure.caption
        if isinstance(drawing, Graph) and not any(box.emphasis == "neighbour" for box in drawing.boxes):
            caption = caption.removesuffix(" and neighbours")
        yield dataclasses.replace(figure, graph=drawing.id, caption=caption)

    def _print_sequence(self, figure: Figure) -> Iterator[Figure]:
        """Yield a sequence as the pieces that it is drawn in."""
        pieces = [each for each in self.drawings.values() if each.id == figure.graph or is_piece_of(each, figure.graph)]
        for piece in pieces:
            if piece.id == figure.graph:
                yield figure
            else:
                caption = f"{figure.caption}: {piece.title.rpartition(': ')[2]}"
                anchor = f"figure:{piece.id}"
                yield dataclasses.replace(figure, anchor=anchor, graph=piece.id, caption=caption)

    def _print_group(self, section: Section) -> Section:
        blocks = list(_unturn_tables(self._keep_legible(section.blocks)))
        texts = [block for block in blocks if isinstance(block, Markdown)]
        group = self.lookup.architecture.groups[section.subject]
        facts = Facts(tuple(map(condensed_blocks.print_fact, list_group_facts(self.lookup, group))))
        others: list[Block] = [
            drop_column(block, "nodes") if isinstance(block, Table) else block
            for block in blocks
            if not isinstance(block, Markdown | Facts)
        ]
        for _, title, block in list_group_parts(self.lookup, group):
            others.append(Paragraph((Text(title, strong=True),)))
            others.append(condensed_blocks.set_small(block) if isinstance(block, Table) else block)
        sections = tuple(self._print_component(each) for each in section.sections)
        return dataclasses.replace(section, blocks=(*texts, facts, *others), sections=sections)

    def _print_component(self, section: Section) -> Section:
        architecture = self.lookup.architecture
        component = architecture.shells.get(section.subject) or architecture.components[section.subject]
        blocks = condensed_blocks.condense_component(self.lookup, component, self._keep_legible(section.blocks))
        if component.id in architecture.components and self._shows_ros and self.edition.ros_place == "inline":
            blocks += self._make_ros_blocks(component.id)
        # What is inside of a composed component has sections; those of nodes move to the annex.
        inner = (each for each in section.sections if each.kind == "component")
        return dataclasses.replace(
            section, blocks=blocks, sections=tuple(self._print_component(each) for each in inner)
        )

    @property
    def _shows_ros(self) -> bool:
        return self.edition.level == "implementation"

    def _make_ros_blocks(self, component_id: str) -> tuple[Block, ...]:
        component = self.lookup.architecture.components[component_id]
        return tuple(_unturn_tables(self._keep_legible(condensed_blocks.make_ros_blocks(self.lookup, component))))

    def make_ros_annexes(self) -> Iterator[Section]:
        """Yield the annexes of the ROS side: the components one by one, and the parameters of all nodes.

        Without pictures: they say what the tables say, and each would take half a page.
        """
        if not self._shows_ros or "groups" not in self.edition.chapter_names:
            return
        if self.edition.ros_place == "annex":
            sections = tuple(self._list_ros_groups())
            if sections:
                lead = Paragraph((Text("Nodes, topics, services and actions, in the order of the components."),))
                yield Section("page:nodes", "ROS side of the components", (lead,), sections, True, True)  # noqa: FBT003
        if table := condensed_blocks.make_parameter_table(self.lookup):
            yield Section("page:parameters", "Parameters", (table,), appendix=True, page_break=False)
        if section := make_message_annex(self.lookup):
            yield section

    def _list_ros_groups(self) -> Iterator[Section]:
        for group_id in self.lookup.shown_groups():
            sections = tuple(
                Section(
                    f"implementation:{component.id}",
                    name_in_place(self.lookup, component),
                    tuple(each for each in self._make_ros_blocks(component.id) if not isinstance(each, Figure)),
                )
                for component in self.lookup.shown_components(group_id)
                if self.lookup.nodes_of.get(component.id)
            )
            if sections:
                title = self.lookup.architecture.groups[group_id].title
                yield Section(f"nodes:{group_id}", title, (), sections, appendix=True)

    def _split_timing(self, section: Section) -> Iterator[Section]:
        """Yield the chapter of timing with its verdicts, and the annex of its tables."""
        blocks = tuple(_unturn_tables(self._keep_legible(section.blocks)))
        if blocks:
            yield dataclasses.replace(section, blocks=blocks, sections=())
        # How often the nodes of a group work is told by the table of rates.
        sections = tuple(self._print_others(each) for each in section.sections if each.anchor != "timing:groups")
        sections = tuple(each for each in sections if each.blocks)
        if sections:
            yield Section("page:rates", _TIMING_ANNEX, (), sections, appendix=True, page_break=False)


def walk_sections(sections: Iterable[Section]) -> Iterator[Section]:
    """Yield sections, each followed by those below it."""
    for section in sections:
        yield section
        yield from walk_sections(section.sections)


def _unturn_tables(blocks: Iterable[Block]) -> Iterator[Block]:
    """Yield blocks with tables that need no turned page, and no facts without rows."""
    for block in blocks:
        if isinstance(block, Table):
            yield dataclasses.replace(block, wide=False)
        elif not isinstance(block, Facts) or block.rows:
            yield block


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
