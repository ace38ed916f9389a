"""Sentences that name each figure and table by its number before it comes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from archgen.views.shapes import Block, Figure, Inlines, Paragraph, Section, Table, Text

_COMPONENT_WORDS = ("shows its neighbours", "lists its ports")
_GROUP_WORDS = ("shows its components and what they exchange", "tells what each is for")
_NODE_WORDS = ("shows its nodes with their neighbours", "lists what they use")
_CHAIN_WORDS = ("shows how the time adds up", "says why")
_WORDS = (
    ("component:", _COMPONENT_WORDS),
    ("group:", _GROUP_WORDS),
    ("implementation:", _NODE_WORDS),
    ("chain:", _CHAIN_WORDS),
)


def mention_section(section: Section) -> Section:
    """Return a section, and those below it, with a sentence before the first figure or table of each."""
    blocks = list(section.blocks)
    places = [index for index, block in enumerate(blocks) if _is_numbered(block)]
    if places:
        blocks.insert(places[0], Paragraph(_write_sentence(section.anchor, [blocks[index] for index in places])))
    return replace(section, blocks=tuple(blocks), sections=tuple(mention_section(each) for each in section.sections))


def _is_numbered(block: Block) -> bool:
    return isinstance(block, (Figure, Table)) and block.numbered


def _write_sentence(anchor: str, blocks: Sequence[Block]) -> Inlines:
    figures = [_name_block(block) for block in blocks if isinstance(block, Figure)]
    tables = [_name_block(block) for block in blocks if isinstance(block, Table)]
    words = next((words for prefix, words in _WORDS if anchor.startswith(prefix)), None)
    if words and len(figures) <= 1 and len(tables) <= 1:
        parts = [
            (name, Text(f" {word}")) for names, word in zip((figures, tables), words, strict=True) for name in names
        ]
        return (*_join(parts, ", "), Text("."))
    names = [(name,) for name in (*figures, *tables)]
    return (Text("See "), *_join(names, ", "), Text("."))


def _name_block(block: Block) -> Text:
    if isinstance(block, Figure):
        return Text("the figure", ref=block.anchor, is_number=True)
    return Text("the table", ref=block.anchor if isinstance(block, Table) else None, is_number=True)


def _join(parts: Sequence[Inlines], separator: str) -> Inlines:
    """Join parts; the last one behind "and"."""
    runs: list[Text] = []
    for index, part in enumerate(parts):
        if index:
            runs.append(Text(" and " if index == len(parts) - 1 else separator))
        runs += part
    return tuple(runs)
