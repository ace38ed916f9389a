"""Word's numbering, which python-docx leaves to its users: numbered headings, lettered appendices, bullets, numbered lists."""

from __future__ import annotations

from collections.abc import Sequence

from docx.oxml.ns import nsdecls, qn
from docx.oxml.parser import parse_xml
from lxml import etree

from archgen.emit.docx.style_table import HEADING_LEVELS, StyleTable
from archgen.frozen import dataclass, field

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
_HEADING_FORMATS = tuple(LevelFormat("decimal", text) for text in _TEXTS)
_APPENDIX_FORMATS = (LevelFormat("upperLetter", _TEXTS[0]), *_HEADING_FORMATS[1:])


def format_heading_number(formats: Sequence[LevelFormat], counts: Sequence[int]) -> str:
    """Return the number that Word shows before a heading: `2.1`, `A.3`. `counts` has a number for each level down to it."""
    text = formats[len(counts) - 1].text
    for level, count in enumerate(counts):
        text = text.replace(f"%{level + 1}", _format_count(formats[level].number_format, count))
    return text


def _read_heading_formats(numbering: etree._Element, styles: StyleTable) -> tuple[LevelFormat, ...]:
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


LIST_LEVELS = 9
"""Levels that a list has in Word (ECMA-376 17.9.6)."""
_BULLETS = ("•", "◦", "▪")
_ORDERED_FORMATS = ("decimal", "lowerLetter", "lowerRoman")
_LIST_INDENT = 360
_HEADING_INDENTS = (567, 851, 1021, 1191, 1361, 1531, 1701, 1871, 2041)
"""Twips from the margin to a heading's words: room for its number."""
_BEFORE_NUMBER = [
    qn(f"w:{name}") for name in ("pStyle", "keepNext", "keepLines", "pageBreakBefore", "framePr", "widowControl")
]
"""What stands before the number in a paragraph's properties (ECMA-376 17.3.1.26): Word refuses another order."""
_BEHIND_PROPERTIES = ("rPr", "tblPr", "trPr", "tcPr", "tblStylePr")


@dataclass(slots=True)
class ListNumbering:
    """The numbering part of a document, which grows with the lists of the report.

    `headings` and `appendices` say what a heading's number looks like at each level. `appendix` and `bullet` are the ids of
    lists, `ordered` that of the definition of numbered lists.
    """

    root: etree._Element
    headings: tuple[LevelFormat, ...] = _HEADING_FORMATS
    appendices: tuple[LevelFormat, ...] = _APPENDIX_FORMATS
    appendix: int = 0
    bullet: int = 0
    ordered: int = 0
    list_ids: set[int] = field(default_factory=set)

    def add_ordered_list(self, start: int, depth: int = 0) -> int:
        """Return the id of a new numbered list whose items at a depth begin at a number."""
        # Without the overrides the list would go on where the last one of its definition ended.
        overrides = "".join(
            f'<w:lvlOverride w:ilvl="{level}"><w:startOverride w:val="{start if level == depth else 1}"/></w:lvlOverride>'
            for level in range(LIST_LEVELS)
        )
        return self.add_list(self.ordered, overrides)

    def add_list(self, definition: int, overrides: str = "") -> int:
        """Return the id of a new list that looks as a definition says."""
        number = max(self.list_ids, default=0) + 1
        self.list_ids.add(number)
        content = f'<w:abstractNumId w:val="{definition}"/>{overrides}'
        new = parse_xml(f'<w:num {nsdecls("w")} w:numId="{number}">{content}</w:num>')
        _insert_before(self.root, new, ("numIdMacAtCleanup",))
        return number

    def add_definition(self, levels: str, kind: str = "multilevel") -> int:
        """Return the id of a new definition of a list from its levels."""
        number = max(_read_ids(self.root, "abstractNum", "abstractNumId"), default=-1) + 1
        content = f'<w:multiLevelType w:val="{kind}"/>{levels}'
        new = parse_xml(f'<w:abstractNum {nsdecls("w")} w:abstractNumId="{number}">{content}</w:abstractNum>')
        # All definitions stand before the lists (ECMA-376 17.9.17).
        _insert_before(self.root, new, ("num", "numIdMacAtCleanup"))
        return number


def prepare_numbering(root: etree._Element, styles: StyleTable) -> ListNumbering:
    """Bring headings, appendices and lists into a document's numbering; a template's own numbered headings stay."""
    numbering = ListNumbering(root, list_ids=_read_ids(root, "num", "numId"))
    template_formats = _read_heading_formats(root, styles)
    # A partner's house may number "Part I": then our numbers would contradict every reference in its cover.
    if template_formats:
        numbering.headings = template_formats
    else:
        _number_heading_styles(numbering, styles)
    numbering.appendix = numbering.add_list(numbering.add_definition(_format_heading_levels(_APPENDIX_FORMATS)))
    levels = range(LIST_LEVELS)
    bullets = [_format_list_level(n, "bullet", _BULLETS[n % len(_BULLETS)]) for n in levels]
    numbering.bullet = numbering.add_list(numbering.add_definition("".join(bullets), "hybridMultilevel"))
    ordered = [_format_list_level(n, _ORDERED_FORMATS[n % len(_ORDERED_FORMATS)], f"%{n + 1}.") for n in levels]
    numbering.ordered = numbering.add_definition("".join(ordered))
    return numbering


def _number_heading_styles(numbering: ListNumbering, styles: StyleTable) -> None:
    """Make the heading styles carry the numbers."""
    # Level and style name each other (ECMA-376 17.9.23): the level its style, and the style below the list and the level.
    number = numbering.add_list(numbering.add_definition(_format_heading_levels(_HEADING_FORMATS, styles)))
    for level in range(HEADING_LEVELS):
        style = styles.find_style(styles.find_heading_id(level + 1))
        if style is None:
            continue
        properties = style.find(qn("w:pPr"))
        if properties is None:
            properties = parse_xml(f"<w:pPr {nsdecls('w')}/>")
            _insert_before(style, properties, _BEHIND_PROPERTIES)
        for old in properties.findall(qn("w:numPr")):
            properties.remove(old)
        content = f'<w:ilvl w:val="{level}"/><w:numId w:val="{number}"/>'
        place = sum(1 for item in properties if item.tag in _BEFORE_NUMBER)
        properties.insert(place, parse_xml(f"<w:numPr {nsdecls('w')}>{content}</w:numPr>"))


def _format_heading_levels(formats: Sequence[LevelFormat], styles: StyleTable | None = None) -> str:
    levels = []
    for level, (level_format, indent) in enumerate(zip(formats, _HEADING_INDENTS, strict=True)):
        style = f'<w:pStyle w:val="{styles.find_heading_id(level + 1)}"/>' if styles else ""
        levels.append(_format_level(level, level_format, (indent, indent), style))
    return "".join(levels)


def _format_list_level(level: int, number_format: str, text: str) -> str:
    return _format_level(level, LevelFormat(number_format, text), (_LIST_INDENT * (level + 1), _LIST_INDENT))


def _format_level(level: int, level_format: LevelFormat, indents: tuple[int, int], style: str = "") -> str:
    """Return the definition of a level (ECMA-376 17.9.6); `indents` are the left and the hanging one in twips."""
    return (
        f'<w:lvl w:ilvl="{level}"><w:start w:val="1"/><w:numFmt w:val="{level_format.number_format}"/>{style}'
        f'<w:lvlText w:val="{level_format.text}"/><w:lvlJc w:val="left"/>'
        f'<w:pPr><w:ind w:left="{indents[0]}" w:hanging="{indents[1]}"/></w:pPr></w:lvl>'
    )


def _read_ids(root: etree._Element, name: str, attribute: str) -> set[int]:
    ids = (item.get(qn(f"w:{attribute}"), "") for item in root.iterfind(qn(f"w:{name}")))
    return {int(text) for text in ids if text.isdecimal()}


def _insert_before(parent: etree._Element, new: etree._Element, later_names: tuple[str, ...]) -> None:
    """Put an element before the first of those that the schema wants behind it."""
    later = {qn(f"w:{name}") for name in later_names}
    place = next((index for index, item in enumerate(parent) if item.tag in later), len(parent))
    parent.insert(place, new)
