"""The report for paper: the outline of all documents, with its blocks put together, and what few read moved to annexes.

Nothing is left out that the outline says; tests/views/test_printed_report.py compares the two, and names what is said in
another place or shorter.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.frozen import replace
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
from archgen.views.tables import functional_tables

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
    used_messages = collect_messages(lookup.architecture, functional_tables.shown_types(lookup), shown_topics(lookup))
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


_COMPONENT_WORDS = ("shows its neighbours", "lists its ports")
_GROUP_WORDS = ("shows its components and what they exchange", "tells what each is for")
_NODE_WORDS = ("shows its nodes with their neighbours", "lists what they use")
_CHAIN_WORDS = ("shows how the time adds up", "says why")
_SECTION_WORDS = {
    "component": _COMPONENT_WORDS,
    "group": _GROUP_WORDS,
    "implementation": _NODE_WORDS,
    "chain": _CHAIN_WORDS,
}
_BLOCK_WORDS = {
    "figure:overview": "shows the groups and what runs between them",
    "table:worst_chains": "lists the chains of effect with what is left of their deadlines",
    "table:partner_progress": "counts how far the components of each partner are described",
    "figure:composed/": "shows what is inside",
    "table:ports/": "lists the ports",
    "table:components/": "tells what each is for",
    "table:component_types": "lists them",
    "table:type_ports/": "lists its ports",
    "table:instances/": "lists what is made from it",
    "figure:hosts": "shows the hosts and the processes on them",
    "table:hosts": "lists what runs on which host",
    "table:links": "lists how the hosts are connected",
    "figure:ros": "shows all nodes",
    "figure:start_up": "shows what starts after what",
    "table:start/": "lists what starts in a phase, how, and what it waits for",
    "figure:frames": "shows what each frame is placed in, and who writes it",
    "table:variants": "lists what each is built on, and how much is different in it",
    "table:frames": "lists how often, and whose data is in it",
    "table:periods": "sorts what the nodes do by how often they do it",
    "table:chains": "compares the bound of each chain with its deadline",
    "figure:views/": "shows this part of the architecture by itself",
    "table:flows/": "lists what flows in it",
    "table:parameters": "lists the parameters of each node with their values",
    "table:message_fields": "lists them with their types and meanings",
    "figure:timing": "shows how often all nodes do something",
    "table:timing": "says of each activity how often it comes and how long its response takes",
    "table:fused": "lists the inputs that are used together, and how old they may be",
    "table:edges": "lists where a reader takes less than what its source publishes",
    "table:services-load": "lists how long a caller may wait for its answer",
    "figure:load/": "shows what one host spends its time on",
    "figure:load": "compares the load of all hosts",
    "table:load": "says whether each host is in time",
    "table:traffic": "adds up what crosses each link",
    "table:bandwidth": "lists what each topic adds to it",
    "table:types": "says which ROS message carries each type",
    "table:connections": "lists who sends what to whom",
    "figure:sequences/": "shows who says what to whom",
    "table:steps/": "lists the steps with what they run along",
    "table:use_cases": "says what happens in each use case",
    "table:requirements": "traces each requirement to what serves it",
    "table:own_requirements": "lists what components ask of themselves",
    "table:property/": "lists what has it",
    "table:properties": "lists what else elements say of themselves",
    "table:glossary": "lists them",
    "table:open_points": "lists them with what to do",
    "table:size": "counts the parts of the architecture",
    "table:progress": "counts how far each part is described",
    "table:history_parts": "says which part has grown",
    "table:history": "shows how it has grown",
    "figure:history": "draws its growth",
}
"""What a figure or table is for, by its anchor, or by the part of it before a slash."""
_MIN_RANGE = 3
"""So many pictures of one kind are named by the first and the last of them."""


def mention_section(section: Section) -> Section:
    """Return a section, and those below it, with a sentence before the first figure or table of each."""
    blocks = list(section.blocks)
    places = [index for index, block in enumerate(blocks) if _is_numbered(block)]
    mentioned = [blocks[index] for index in places]
    sections = section.sections
    if any(each.kind == "summary" for each in sections):
        # The summary has two pages: one sentence does for all of it.
        mentioned += [block for each in sections for block in each.blocks if _is_numbered(block)]
    else:
        sections = tuple(mention_section(each) for each in sections)
    if places:
        blocks.insert(places[0], Paragraph(_write_sentence(section.kind, mentioned)))
    return replace(section, blocks=tuple(blocks), sections=sections)


def _is_numbered(block: Block) -> bool:
    return isinstance(block, (Figure, Table)) and block.numbered


def _write_sentence(section_kind: str, blocks: Sequence[Block]) -> Inlines:
    figures = [_name_block(block) for block in blocks if isinstance(block, Figure)]
    tables = [_name_block(block) for block in blocks if isinstance(block, Table)]
    words = _SECTION_WORDS.get(section_kind)
    # A composed component's picture shows something else than a component's.
    words = None if any(_find_purpose(block) == _BLOCK_WORDS["figure:composed/"] for block in blocks) else words
    if words and len(figures) <= 1 and len(tables) <= 1:
        parts = [
            (name, Text(f" {word}")) for names, word in zip((figures, tables), words, strict=True) for name in names
        ]
        return (*_join_parts(parts, ", "), Text("."))
    return _write_purposes(blocks)


def _write_purposes(blocks: Sequence[Block]) -> Inlines:
    """Say what each figure and table is for; those of one kind together."""
    clauses: list[Inlines] = []
    unexplained: list[Inlines] = []
    for words, same_blocks in itertools.groupby(blocks, key=_find_purpose):
        names = [(_name_block(block),) for block in same_blocks]
        if not words:
            unexplained += names
            continue
        is_range = len(names) >= _MIN_RANGE
        named = _join_parts([names[0], names[-1]], ", ", " to ") if is_range else _join_parts(names, ", ")
        clauses.append((*named, Text(f" {words if len(names) == 1 else _to_plural(words)}")))
    if unexplained:
        clauses.append((Text("see also " if clauses else "See "), *_join_parts(unexplained, ", ")))
    return (*_join_parts(clauses, "; ", "; "), Text("."))


def _find_purpose(block: Block) -> str:
    if not isinstance(block, Figure | Table):
        return ""
    return _BLOCK_WORDS.get(block.anchor) or _BLOCK_WORDS.get(f"{block.kind}/", "")


def _to_plural(words: str) -> str:
    """Return a verb with its object after several subjects: `show ...`."""
    verb, _, rest = words.partition(" ")
    return f"{verb.removesuffix('s')} {rest}"


def _name_block(block: Block) -> Text:
    if isinstance(block, Figure):
        return Text("the figure", ref=block.anchor, is_number=True)
    return Text("the table", ref=block.anchor if isinstance(block, Table) else None, is_number=True)


def _join_parts(parts: Sequence[Inlines], separator: str, last_separator: str = " and ") -> Inlines:
    """Join parts; the last one behind "and"."""
    runs: list[Text] = []
    for index, part in enumerate(parts):
        if index:
            runs.append(Text(last_separator if index == len(parts) - 1 else separator))
        runs += part
    return tuple(runs)
