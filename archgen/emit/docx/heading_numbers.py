"""The number before a heading as text, for the table of contents: Word computes the one in the heading, and stores it nowhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from docx.oxml.ns import qn
from lxml import etree

from archgen.emit.docx.style_table import HEADING_LEVELS, StyleTable

_ROMAN_SIGNS = (
    (1000, "m"), (900, "cm"), (500, "d"), (400, "cd"), (100, "c"), (90, "xc"), (50, "l"), (40, "xl"), (10, "x"), (9, "ix"),
    (5, "v"), (4, "iv"), (1, "i"),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class LevelFormat:
    """What the number of a level looks like: a format of ECMA-376 17.18.59, and a text with `%1` for the first level's number."""

    number_format: str
    text: str


_TEXTS = tuple(".".join(f"%{n}" for n in range(1, level + 1)) for level in range(1, HEADING_LEVELS + 1))
HEADING_FORMATS = tuple(LevelFormat("decimal", text) for text in _TEXTS)
APPENDIX_FORMATS = (LevelFormat("upperLetter", _TEXTS[0]), *HEADING_FORMATS[1:])


def format_heading_number(formats: Sequence[LevelFormat], counts: Sequence[int]) -> str:
    """Return the number that Word shows before a heading: `2.1`, `A.3`. `counts` has a number for each level down to it."""
    text = formats[len(counts) - 1].text
    for level, count in enumerate(counts):
        text = text.replace(f"%{level + 1}", _format_count(formats[level].number_format, count))
    return text


def read_heading_formats(numbering: etree._Element, styles: StyleTable) -> tuple[LevelFormat, ...]:
    """Return what the numbers of a template's headings look like; nothing if its first heading has none."""
    path = "/".join(map(qn, ("w:pPr", "w:numPr", "w:numId")))
    bases = styles.list_bases(styles.find_heading_id(1))
    number = next((item for base in bases if (item := base.find(path)) is not None), None)
    list_id = "" if number is None else number.get(qn("w:val"), "0")
    instance = next((item for item in numbering.iterfind(qn("w:num")) if item.get(qn("w:numId")) == list_id), None)
    definition_id = "" if instance is None else _read_child_value(instance, "abstractNumId", "")
    levels = {
        level.get(qn("w:ilvl")): LevelFormat(
            _read_child_value(level, "numFmt", "decimal"), _read_child_value(level, "lvlText", "")
        )
        for definition in numbering.iterfind(qn("w:abstractNum"))
        if definition_id and definition.get(qn("w:abstractNumId")) == definition_id
        for level in definition.iterfind(qn("w:lvl"))
    }
    return tuple(levels.get(str(n), LevelFormat("none", "")) for n in range(HEADING_LEVELS)) if levels else ()


def _format_count(number_format: str, count: int) -> str:
    """Return a count in a format; in those that no heading has (words, other scripts) as digits."""
    lower_format = "lower" + number_format.removeprefix("upper")
    texts = {
        "none": "",
        "decimalZero": f"{count:02}",
        "lowerLetter": _format_letter(count),
        "lowerRoman": _format_roman(count),
    }
    if number_format.startswith("upper") and lower_format in texts:
        return texts[lower_format].upper()
    return texts.get(number_format, str(count))


def _format_letter(count: int) -> str:
    """Return a count as Word's letters: behind `z` comes `aa`, then `bb`."""
    return chr(ord("a") + (count - 1) % 26) * ((count - 1) // 26 + 1) if count else ""


def _format_roman(count: int) -> str:
    text = ""
    for value, sign in _ROMAN_SIGNS:
        while count >= value:
            text, count = text + sign, count - value
    return text


def _read_child_value(item: etree._Element, name: str, default: str) -> str:
    child = item.find(qn(f"w:{name}"))
    return default if child is None else child.get(qn("w:val"), default)
