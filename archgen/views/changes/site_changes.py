"""What changed since an earlier version, as the site shows it: a page of its own, marks on pages, lists and pictures, and
both versions of what changed side by side.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Literal, get_args

from archgen.compare import Change, Comparison
from archgen.compare.comparison import BoundaryChange
from archgen.compare.text_meaning import find_differences
from archgen.frozen import dataclass, replace
from archgen.grouping import group_pairs
from archgen.views import inline_text
from archgen.views.changes.boundary_lines import write_boundary_lines
from archgen.views.changes.change_wording import CHANGE_SIGNS, choose_mark, text_runs
from archgen.views.changes.comparison_document import ComparisonDocument
from archgen.views.changes.comparison_outline import write_comparison_outline
from archgen.views.changes.figure_lines import FigureLine
from archgen.views.changes.named_elements import name_partners
from archgen.views.picture_shapes import Box, Drawing, ElementChange, Graph
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Facts,
    Inlines,
    Page,
    Paragraph,
    Section,
    Table,
    Text,
    split_anchor,
)

CHANGES_ANCHOR = "page:changes"
_PAGE_KINDS = frozenset(
    {
        *("component", "group", "node", "partner", "requirement", "use_case", "host", "container", "type", "message"),
        "chain",
    }
)
"""Kinds of elements with a page of their own: its anchor is `KIND:ID`."""
_PORT_KINDS = frozenset({"input", "output"})
_MARKED_PICTURES = frozenset({"overview", "components", "group", "component", "implementation", "ros", "view"})
_LISTING_KINDS = frozenset({"spanning", "groups"})
"""Kinds of pages whose tables list elements."""
_CHANGE_WORDS: Mapping[ElementChange, str] = {"added": "new", "changed": "changed", "renamed": "renamed"}


# Without slots: `cached_property` stores its values in the object's dictionary.
@dataclass(frozen=True)
class SiteChanges:
    """A comparison with an earlier version, and the document that tells it. `since` is what people call that version."""

    comparison: Comparison
    document: ComparisonDocument
    since: str

    @cached_property
    def changes_by_page(self) -> Mapping[str, tuple[Change, ...]]:
        """The changes of each page's element and its ports, by the page's anchor; removed elements have no page.

        What partners give each other has those of its output, as `interface:OUTPUT`.
        """
        changes_by_page: dict[str, list[Change]] = {}
        for change in self.comparison.changes:
            anchor = _find_page(change)
            if anchor:
                changes_by_page.setdefault(anchor, []).append(change)
            if change.element_kind == "output":
                changes_by_page.setdefault(f"interface:{change.element_id}", []).append(change)
        return {anchor: tuple(changes) for anchor, changes in changes_by_page.items()}

    @cached_property
    def kinds_by_page(self) -> Mapping[str, ElementChange]:
        """How each element that has a page changed, by the page's anchor."""
        return {anchor: _judge_changes(anchor, changes) for anchor, changes in self.changes_by_page.items()}

    @cached_property
    def changed_groups(self) -> frozenset[str]:
        """The anchors of the groups that changed, or in which something did."""
        changed = [(anchor, *split_anchor(anchor)) for anchor in self.kinds_by_page]
        names = (name.partition(".")[0] for _, kind, name in changed if kind == "component")
        removed = (
            change.element_id.partition(".")[0]
            for change in self.comparison.changes
            if change.element_kind == "component" and change.kind == "removed"
        )
        own = (anchor for anchor, kind, _ in changed if kind == "group")
        return frozenset((*own, *(f"group:{name}" for name in (*names, *removed))))

    def list_boundary_lines(self, partner_id: str) -> tuple[FigureLine, ...]:
        """Return what changed at the interfaces of a partner, in the words of the comparison."""
        own = [each for each in self.comparison.boundaries if partner_id in (*each.givers, *each.takers)]
        return write_boundary_lines(replace(self.comparison, boundaries=tuple(own)), name_partners(self.comparison))

    @cached_property
    def arrivals_by_component(self) -> Mapping[str, Sequence[BoundaryChange]]:
        """What comes to a component from other partners, where that is otherwise than before."""
        changed = {each.interface_id: each for each in self.comparison.boundaries}
        return group_pairs(
            (connection.input.rpartition(".")[0], changed[output])
            for connection in self.comparison.after.architecture.connections
            for output in connection.outputs
            if output in changed
        )

    def find_elements(self, anchor: str) -> tuple[list[str], list[str]]:
        """Return the components that a page is about, and the anchors of the pages that tell their changes: its own first."""
        kind, name = split_anchor(anchor)
        nodes = self.comparison.after.architecture.nodes
        if kind == "node" and name in nodes:
            return list(nodes[name].implements), [anchor, *(f"component:{each}" for each in nodes[name].implements)]
        if kind != "component":
            return [], [anchor]
        return [name], [anchor, *(f"node:{each.id}" for each in nodes.values() if name in each.implements)]

    @cached_property
    def kinds_in_pictures(self) -> Mapping[str, ElementChange]:
        """How the element of each box changed: groups, too, in which something did."""
        return {**dict.fromkeys(sorted(self.changed_groups), "changed"), **self.kinds_by_page}


def _find_page(change: Change) -> str:
    """Return the anchor of the page that shows what changed, empty where there is none."""
    if change.element_kind == "port":
        return f"node:{change.element_id.partition('.')[0]}"
    if change.element_kind in _PORT_KINDS:
        return f"component:{change.element_id.rpartition('.')[0]}"
    is_gone = change.kind == "removed"
    return f"{change.element_kind}:{change.element_id}" if change.element_kind in _PAGE_KINDS and not is_gone else ""


def _judge_changes(anchor: str, changes: Iterable[Change]) -> ElementChange:
    """Say how an element changed as a whole: what happens to its ports changes it."""
    own_kinds = {
        change.kind
        for change in changes
        if change.key is None and f"{change.element_kind}:{change.element_id}" == anchor
    }
    if "added" in own_kinds:
        return "added"
    return "renamed" if own_kinds & {"renamed", "moved"} else "changed"


def mark_page(page: Page, site_changes: SiteChanges) -> Page:
    """Mark a page whose element changed, and the elements that its tables list."""
    section = page.section
    if page.kind in _LISTING_KINDS:
        section = _mark_lists(section, site_changes.kinds_by_page)
    anchor = page.anchor.rsplit(":", 2)[0] if page.kind == "interfaces" else page.anchor
    kind = site_changes.kinds_by_page.get(anchor)
    section = replace(section, blocks=(*_list_change_blocks(anchor, site_changes), *section.blocks))
    if kind is not None:
        page = replace(page, verdict=(*page.verdict, *_make_chip(kind, site_changes.since)))
    is_changed = page.is_changed or kind is not None or page.anchor in site_changes.changed_groups
    return replace(page, section=section, is_changed=is_changed)


def add_changes(pages: Iterable[Page], site_changes: SiteChanges, drawings: Mapping[str, Drawing]) -> tuple[Page, ...]:
    """Return the pages with marks and with both versions of what changed, and behind the first one the page of changes."""
    first_page, *other_pages = (mark_page(page, site_changes) for page in pages)
    anchors = {page.anchor for page in other_pages}
    return (first_page, _make_changes_page(site_changes, first_page, drawings, anchors), *other_pages)


def _make_changes_page(
    site_changes: SiteChanges, first_page: Page, drawings: Mapping[str, Drawing], anchors: Collection[str]
) -> Page:
    ids = {split_anchor(anchor)[1]: anchor for anchor in sorted(anchors) if split_anchor(anchor)[0] in _PAGE_KINDS}
    names = site_changes.document.element_titles
    # A port's id leads to its component.
    pages = {name: page for name in names if (page := ids.get(name) or ids.get(name.rpartition(".")[0]))}
    outline = write_comparison_outline(replace(site_changes.document, element_pages=pages))
    sections = tuple(
        _link_section(section, ids)
        for section in outline.sections
        if section.anchor != "changes:pictures" or any(graph.id in drawings for graph in site_changes.document.graphs)
    )
    blocks: tuple[Block, ...] = (*outline.notices, Facts(outline.facts))
    section = Section(CHANGES_ANCHOR, "Changes", blocks, sections)
    crumbs = (("Overview", first_page.anchor),)
    return Page(
        "changes.html", CHANGES_ANCHOR, "Changes", "spanning", section, crumbs, f"What changed: {outline.subtitle}"
    )


def _link_section(section: Section, ids: Mapping[str, str]) -> Section:
    """Link the ids of elements that have a page; a port's id leads to its component."""

    def link(runs: Inlines) -> Inlines:
        return tuple(
            replace(run, ref=ids.get(run.text) or ids.get(run.text.rpartition(".")[0])) if run.code else run
            for run in runs
        )

    return replace(
        section,
        blocks=tuple(_link_block(block, link) for block in section.blocks),
        sections=tuple(_link_section(inner, ids) for inner in section.sections),
    )


def _link_block(block: Block, link: Callable[[Inlines], Inlines]) -> Block:
    if isinstance(block, Bullets):
        return replace(block, items=tuple(map(link, block.items)))
    if isinstance(block, Table):
        return replace(block, rows=tuple(tuple(map(link, row)) for row in block.rows))
    return block


def _make_chip(kind: ElementChange, since: str = "") -> Inlines:
    words = _CHANGE_WORDS.get(kind, "changed")
    return (
        Text(f"{words} · since {since}" if since else words, status="changed", ref=CHANGES_ANCHOR if since else None),
    )


def _mark_lists(section: Section, kinds: Mapping[str, ElementChange]) -> Section:
    """Put a chip behind the name of each changed element that a table lists."""
    return replace(
        section,
        blocks=tuple(_mark_table(block, kinds) if isinstance(block, Table) else block for block in section.blocks),
        sections=tuple(_mark_lists(inner, kinds) for inner in section.sections),
    )


def _mark_table(table: Table, kinds: Mapping[str, ElementChange]) -> Table:
    rows = tuple(
        ((*row[0], Text(" "), *_make_chip(kind)), *row[1:])
        if row[0] and (kind := kinds.get(row[0][0].ref or "")) is not None
        else row
        for row in table.rows
    )
    return replace(table, rows=rows)


def _list_change_blocks(anchor: str, site_changes: SiteChanges) -> Iterator[Block]:
    """Yield what changed of an element, both versions side by side (not of one that is new as a whole), and what comes to it."""
    components, anchors = site_changes.find_elements(anchor)
    of_several = anchors[1:] if len(anchors) > 2 else ()  # noqa: PLR2004 - its own, and that of one other
    rows = tuple(
        ((Text(split_anchor(each)[1], code=True), Text(" · "), *what), *values)
        if each in of_several
        else (what, *values)
        for each in anchors
        for change in site_changes.changes_by_page.get(each, ())
        for what, *values in _list_rows(change, each)
    )
    if rows:
        columns = (Column("What", 1.2), Column(f"Before ({site_changes.since})", 2), Column("Now", 2))
        yield Table(f"table:since/{anchor}", f"Changed since {site_changes.since}", columns, rows)
    arriving = tuple({each: None for name in components for each in site_changes.arrivals_by_component.get(name, ())})
    comparison = replace(site_changes.comparison, boundaries=arriving)
    if lines := write_boundary_lines(comparison, name_partners(comparison)) if arriving else ():
        yield Paragraph((Text(f"What comes to it otherwise since {site_changes.since}", strong=True),))
        yield Bullets(tuple(tuple(text_runs(line.text)) for line in lines))


def _list_rows(change: Change, anchor: str) -> Iterator[tuple[Inlines, ...]]:
    """Yield the row of a change; what came or went has one side."""
    is_own = f"{change.element_kind}:{change.element_id}" == anchor
    # A port by its own name: the page says whose it is.
    name = "" if is_own else f"{change.element_kind} {change.element_id.rpartition('.')[2]}"
    if change.key is not None:
        what = " · ".join(filter(None, (name, change.key.replace(".", " · "))))
        yield inline_text.to_inlines(what), *_show_values(change.before, change.after)
    elif change.kind in {"renamed", "moved"}:
        old, new = Text(change.old_id or "", code=True), Text(change.element_id, code=True)
        yield inline_text.to_inlines(" ".join(filter(None, (name, change.kind)))), (old,), (new,)
    elif not is_own:
        sign = Text(CHANGE_SIGNS[change.kind], strong=True, change=choose_mark(change.kind))
        sentence = (sign, Text(" "), *text_runs(change.text))
        before, after = (sentence, ()) if change.kind == "removed" else ((), sentence)
        yield inline_text.to_inlines(name), before, after
    for part in change.parts:
        yield from _list_rows(part, anchor)


def _show_values(before: object, after: object) -> tuple[Inlines, Inlines]:
    """Show two values side by side, with what differs between two texts marked."""
    if not isinstance(before, str) or not isinstance(after, str):
        return _show_value(before), _show_value(after)
    old_words, new_words = before.split(), after.split()
    differences = tuple(find_differences(old_words, new_words))
    return (
        _mark_words(old_words, ((start, end) for start, end, _, _ in differences), "removed"),
        _mark_words(new_words, ((start, end) for _, _, start, end in differences), "added"),
    )


def _mark_words(
    words: Sequence[str], stretches: Iterable[tuple[int, int]], mark: Literal["added", "removed"]
) -> Inlines:
    """Return words as a text in which some stretches are marked."""
    runs, position = list[Text](), 0
    for start, end in stretches:
        runs += [Text(" ".join(words[position:start])), Text(" ".join(words[start:end]), change=mark)]
        position = end
    runs.append(Text(" ".join(words[position:])))
    present_runs = [run for run in runs if run.text]
    return tuple(run for at, each in enumerate(present_runs) for run in ((Text(" "), each) if at else (each,)))


def _show_value(value: object) -> Inlines:
    """Show a value as plain words, each entry of a list or mapping on a line of its own."""
    if value is None:
        return (Text("not written", muted=True),)
    lines = list(_list_lines(value))
    return tuple(Text(line, line_break=at > 0) for at, line in enumerate(lines)) or (Text("empty", muted=True),)


def _list_lines(value: object, depth: int = 0) -> Iterator[str]:
    """Yield the lines of a value in normal form."""
    indent = "\N{NO-BREAK SPACE}" * 2 * depth
    if isinstance(value, Mapping):
        for key, item in value.items():
            inner = list(_list_lines(item, depth + 1))
            is_short = not isinstance(item, (Mapping, list, tuple)) and len(inner) == 1
            yield f"{indent}{key}: {inner[0].strip()}" if is_short else f"{indent}{key}:"
            yield from () if is_short else inner
    elif isinstance(value, (list, tuple)):
        for item in value:
            yield from _list_lines(item, depth)
    elif isinstance(value, bool):
        yield f"{indent}{'yes' if value else 'no'}"
    else:
        yield from (f"{indent}{line}" for line in str(value).splitlines())


def mark_drawings(drawings: Mapping[str, Drawing], site_changes: SiteChanges) -> dict[str, Drawing]:
    """Return drawings in which what is new or changed stands out as in the pictures of a comparison, and those pictures."""
    marked = {name: mark_drawing(drawing, site_changes) for name, drawing in drawings.items()}
    return marked | {graph.id: graph for graph in site_changes.document.graphs}


def mark_drawing(drawing: Drawing, site_changes: SiteChanges) -> Drawing:
    """Return a drawing in which what is new or changed stands out."""
    if not isinstance(drawing, Graph) or drawing.kind not in _MARKED_PICTURES:
        return drawing
    return _mark_graph(drawing, site_changes.kinds_in_pictures)


def _mark_graph(graph: Graph, kinds: Mapping[str, ElementChange]) -> Graph:
    if not any(box.ref in kinds for box in graph.boxes if box.ref):
        return graph
    boxes = tuple(_mark_box(box, kinds) for box in graph.boxes)
    changes = {box.change for box in boxes}
    legend = (*graph.legend, *(f"change:{kind}" for kind in get_args(ElementChange) if kind in changes))
    return replace(graph, boxes=boxes, legend=legend)


def _mark_box(box: Box, kinds: Mapping[str, ElementChange]) -> Box:
    kind = kinds.get(box.ref) if box.ref else None
    # A sign before the title, so that nothing depends on colour.
    return replace(box, change=kind, title=f"{CHANGE_SIGNS[kind]} {box.title}") if kind else box
