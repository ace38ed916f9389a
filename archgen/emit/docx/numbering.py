"""Numbered headings, lettered appendices, bullets and numbered lists: Word's numbering, and its text for the table of contents."""

from __future__ import annotations

from dataclasses import dataclass, field

from lxml import etree

from archgen.emit.docx.markup import W
from archgen.emit.docx.styles import HEADINGS, Styles, tag

_BULLETS = ("•", "◦", "▪")
_ORDERED = ("decimal", "lowerLetter", "lowerRoman")
_INDENT = 360
_HEADING_INDENTS = (567, 851, 1021, 1191, 1361, 1531, 1701, 1871, 2041)
_ROMAN = ((1000, "m"), (900, "cm"), (500, "d"), (400, "cd"), (100, "c"), (90, "xc"), (50, "l"), (40, "xl"), (10, "x"), (9, "ix"), (5, "v"), (4, "iv"), (1, "i"))  # fmt: skip
_FORMATS = ("decimal",) * HEADINGS
LEVELS = 9


@dataclass(slots=True)
class Numbering:
    """The numbering part of a document, growing while lists are met.

    `headings` and `appendices` are (format, text) of each level: what a heading's number looks like.
    """

    root: etree._Element
    headings: tuple[tuple[str, str], ...] = ()
    appendices: tuple[tuple[str, str], ...] = ()
    appendix: int = 0
    bullet: int = 0
    ordered: int = 0
    taken: set[int] = field(default_factory=set)

    def list_from(self, start: int, depth: int = 0) -> int:
        """Give the id of a new numbered list whose items at a depth begin at a number."""
        overrides = "".join(
            f'<w:lvlOverride w:ilvl="{level}"><w:startOverride w:val="{start if level == depth else 1}"/></w:lvlOverride>'
            for level in range(LEVELS)
        )
        return self.instance(self.ordered, overrides)

    def instance(self, abstract: int, overrides: str = "") -> int:
        """Give the id of a new list that looks as a definition says."""
        number = max(self.taken, default=0) + 1
        self.taken.add(number)
        xml = f'<w:num xmlns:w="{W}" w:numId="{number}"><w:abstractNumId w:val="{abstract}"/>{overrides}</w:num>'
        _insert(self.root, etree.fromstring(xml), ("numIdMacAtCleanup",))
        return number

    def abstract(self, levels: str, kind: str = "multilevel") -> int:
        """Give the id of a new definition of a list from its levels."""
        known = {
            int(text)
            for item in self.root.iterfind(tag("abstractNum"))
            if (text := item.get(tag("abstractNumId"), "")).isdecimal()
        }
        number = max(known, default=-1) + 1
        xml = f'<w:abstractNum xmlns:w="{W}" w:abstractNumId="{number}"><w:multiLevelType w:val="{kind}"/>{levels}</w:abstractNum>'
        _insert(self.root, etree.fromstring(xml), ("num", "numIdMacAtCleanup"))
        return number


def settle(root: etree._Element | None, styles: Styles) -> Numbering:
    """Bring headings, appendices and lists into a document's numbering; a template's own numbered headings stay."""
    root = etree.Element(tag("numbering"), nsmap={"w": W}) if root is None else root
    numbering = Numbering(root)
    numbering.taken = {
        int(text) for item in root.iterfind(tag("num")) if (text := item.get(tag("numId"), "")).isdecimal()
    }
    own = _own_headings(root, styles)
    if own:
        numbering.headings = own
    else:
        numbering.headings = tuple(zip(_FORMATS, _texts(), strict=True))
        _bind(numbering, styles)
    numbering.appendices = tuple(zip(("upperLetter", *_FORMATS[1:]), _texts(), strict=True))
    numbering.appendix = numbering.instance(numbering.abstract(_heading_levels(numbering.appendices)))
    bullets = "".join(
        _level(n, "bullet", _BULLETS[n % len(_BULLETS)], (_INDENT * (n + 1), _INDENT)) for n in range(LEVELS)
    )
    numbering.bullet = numbering.instance(numbering.abstract(bullets, "hybridMultilevel"))
    ordered = "".join(
        _level(n, _ORDERED[n % len(_ORDERED)], f"%{n + 1}.", (_INDENT * (n + 1), _INDENT)) for n in range(LEVELS)
    )
    numbering.ordered = numbering.abstract(ordered)
    return numbering


def label(formats: tuple[tuple[str, str], ...], counts: list[int]) -> str:
    """Give the number that Word shows before a heading: `2.1`, `A.3`."""
    text = formats[len(counts) - 1][1]
    for level, count in enumerate(counts):
        text = text.replace(f"%{level + 1}", _spelt(formats[level][0], count))
    return text


def _spelt(form: str, count: int) -> str:
    if form in {"upperLetter", "lowerLetter"}:
        letter = chr(ord("a") + (count - 1) % 26) * ((count - 1) // 26 + 1) if count else ""
        return letter.upper() if form == "upperLetter" else letter
    if form in {"upperRoman", "lowerRoman"}:
        return _roman(count).upper() if form == "upperRoman" else _roman(count)
    return "" if form == "none" else f"{count:02}" if form == "decimalZero" else str(count)


def _roman(count: int) -> str:
    text = ""
    for value, sign in _ROMAN:
        while count >= value:
            text, count = text + sign, count - value
    return text


def _texts() -> tuple[str, ...]:
    return tuple(".".join(f"%{n}" for n in range(1, level + 1)) for level in range(1, HEADINGS + 1))


def _heading_levels(formats: tuple[tuple[str, str], ...], styles: Styles | None = None) -> str:
    parts = []
    for n, (form, text) in enumerate(formats):
        style = f'<w:pStyle w:val="{styles.heading(n + 1)}"/>' if styles else ""
        parts.append(_level(n, form, text, (_HEADING_INDENTS[n], _HEADING_INDENTS[n]), style))
    return "".join(parts)


def _level(level: int, form: str, text: str, indents: tuple[int, int], style: str = "") -> str:
    return (
        f'<w:lvl w:ilvl="{level}"><w:start w:val="1"/><w:numFmt w:val="{form}"/>{style}<w:lvlText w:val="{text}"/><w:lvlJc w:val="left"/>'
        f'<w:pPr><w:ind w:left="{indents[0]}" w:hanging="{indents[1]}"/></w:pPr></w:lvl>'
    )


def _bind(numbering: Numbering, styles: Styles) -> None:
    """Make the heading styles carry the numbers."""
    number = numbering.instance(numbering.abstract(_heading_levels(numbering.headings, styles)))
    for level in range(HEADINGS):
        style = styles.element(styles.heading(level + 1))
        if style is None:
            continue
        properties = style.find(tag("pPr"))
        if properties is None:
            properties = etree.Element(tag("pPr"))
            _insert(style, properties, ("rPr", "tblPr", "trPr", "tcPr", "tblStylePr"))
        for old in properties.findall(tag("numPr")):
            properties.remove(old)
        xml = f'<w:numPr xmlns:w="{W}"><w:ilvl w:val="{level}"/><w:numId w:val="{number}"/></w:numPr>'
        before = ("pStyle", "keepNext", "keepLines", "pageBreakBefore", "framePr", "widowControl")
        place = sum(1 for item in properties if item.tag in {tag(name) for name in before})
        properties.insert(place, etree.fromstring(xml))


def _own_headings(root: etree._Element, styles: Styles) -> tuple[tuple[str, str], ...]:
    """Give what the numbers of a template's headings look like; nothing if its first heading has none."""
    number = next(
        (
            found
            for item in styles.chain(styles.heading(1))
            if (found := item.find(f"{tag('pPr')}/{tag('numPr')}/{tag('numId')}")) is not None
        ),
        None,
    )
    chosen = "" if number is None else number.get(tag("val"), "0")
    instance = next((item for item in root.iterfind(tag("num")) if item.get(tag("numId")) == chosen), None)
    abstract = None if instance is None else instance.find(tag("abstractNumId"))
    if abstract is None:
        return ()
    wanted = abstract.get(tag("val"))
    levels = [
        item
        for found in root.iterfind(tag("abstractNum"))
        if found.get(tag("abstractNumId")) == wanted
        for item in found.iterfind(tag("lvl"))
    ]
    known = {item.get(tag("ilvl")): (_child(item, "numFmt", "decimal"), _child(item, "lvlText", "")) for item in levels}
    return tuple(known.get(str(n), ("none", "")) for n in range(HEADINGS)) if known else ()


def _child(item: etree._Element, name: str, default: str) -> str:
    found = item.find(tag(name))
    return default if found is None else found.get(tag("val"), default)


def _insert(parent: etree._Element, new: etree._Element, before: tuple[str, ...]) -> None:
    """Put an element before the first of those that the schema wants behind it."""
    later = {tag(name) for name in before}
    place = next((index for index, item in enumerate(parent) if item.tag in later), len(parent))
    parent.insert(place, new)
