"""Sentences that name each figure and table by its number before it comes."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from archgen.frozen import replace
from archgen.views.shapes import Block, Figure, Inlines, Paragraph, Section, Table, Text

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
