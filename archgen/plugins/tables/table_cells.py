"""Tables as they were read, whatever file they stood in: cells with their places, rows, and what says nothing yet; and what
the words that head columns mean, in the spellings and languages that teams use.

What became of each cell of a table: taken for a key of an element, not taken with a reason, or left out on purpose. A cell
that nobody accounts for counts as not taken, and what is said to be taken is looked up in the data that are written: a cell
cannot get lost without a word.
"""

from __future__ import annotations

import json
import re
import shlex
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from archgen.plugin.findings import Diagnostic, Severity
from archgen.plugin.importing import Span, find_closest, title_from_id

MAX_BYTES = 8 * 1024 * 1024
"""The most bytes that a table in plain text may have."""
MAX_CELLS = 100_000
"""The most non-empty cells that a table may have. 10,000 components with their connections have fewer."""
MAX_COLUMNS = 200
# Spreadsheets and web pages leave no-break, zero-width and byte order characters in cells.
_ODD_BLANKS = str.maketrans({"\xa0": " ", "\u202f": " ", "\u2009": " ", "\u200b": None, "\ufeff": None, "\xad": None})
_EMPTY_WORDS = frozenset(
    {"", "-", "--", "\u2013", "\u2014", "?", "n/a", "na", "tbd", "tbc", "tba", "todo", "...", "\u2026"}
    | {"n.a.", "n. a.", "k.a.", "k. a.", "n.v.", "n/d", "s/o", "à définir", "por definir"}
)
"""What a cell holds that says nothing yet."""


@dataclass(frozen=True, slots=True)
class TableCell:
    """A cell with content. `text` has no blanks around it; `is_number` where a workbook stores it as a number."""

    text: str
    span: Span
    is_number: bool = False

    @property
    def one_line(self) -> str:
        """The text on one line, with single blanks between its words."""
        return " ".join(self.text.split())

    def with_text(self, text: str) -> TableCell:
        """Return a part of the cell as a cell of its own, in the same place."""
        return replace(self, text=text)

    @property
    def quotation(self) -> str:
        """The beginning of the text as findings quote it."""
        text = self.one_line
        return text if len(text) <= 40 else f"{text[:39]}\u2026"  # noqa: PLR2004 - enough to recognise it


TableRow = Mapping[int, TableCell]
"""The cells of a row that have content, by column (from 0)."""


@dataclass(slots=True)
class TableSheet:
    """One table as it was read: a text file, a sheet of a workbook or a table of a document.

    `rows` has an empty row wherever rows are blank; `placeholders` are the cells that say nothing yet (`tbd`).
    """

    name: str
    rows: list[TableRow] = field(default_factory=list)
    placeholders: list[TableCell] = field(default_factory=list)
    count: int = 0

    def add_cell(
        self, row: dict[int, TableCell], column: int, text: str, span: Span, *, is_number: bool = False
    ) -> None:
        """Add a cell to a row, unless it is empty. Raise TableTooLargeError."""
        if not text:
            return
        self.count += 1
        if self.count > MAX_CELLS or column >= MAX_COLUMNS:
            raise TableTooLargeError(span, columns=column >= MAX_COLUMNS)
        cell = TableCell(text, span, is_number)
        if text.lower() in _EMPTY_WORDS:
            self.placeholders.append(cell)
        else:
            row[column] = cell


def clean_text(text: str) -> str:
    """Return a cell's content without odd blanks, and without blanks around it."""
    cleaned = text.translate(_ODD_BLANKS).strip()
    # The apostrophe keeps a spreadsheet from taking the text for a formula; `archgen list` writes it as well.
    return cleaned[1:].strip() if cleaned[:1] == "'" and cleaned[1:].lstrip()[:1] in {"=", "+", "-", "@"} else cleaned


class TableTooLargeError(Exception):
    """A table has more cells or columns than anybody can mean. `diagnostic` says which limit was exceeded."""

    def __init__(self, span: Span, *, columns: bool) -> None:
        super().__init__()
        limit = f"more than {MAX_COLUMNS} columns" if columns else f"more than {MAX_CELLS:,} cells"
        self.diagnostic = make_error("too-large", f"the table has {limit}", span, "take out what archgen need not know")


def make_error(rule: str, message: str, span: Span, help_line: str) -> Diagnostic:
    """Return an error about a table as a whole: nothing is imported then."""
    return Diagnostic(rule, message, span, Severity.ERROR, help=help_line)


def make_warning(rule: str, message: str, span: Span, help_line: str) -> Diagnostic:
    """Return a warning about how a table could be read."""
    return Diagnostic(rule, message, span, Severity.WARNING, help=help_line)


ElementPath = tuple[str, ...]
"""Where an element stands in the data: `("groups", "sensing", "components", "camera")`."""


class CellUse(NamedTuple):
    """What a cell was taken for: a key of an element, and the words that the element must then have."""

    key: str
    element: ElementPath
    words: str


@dataclass(slots=True)
class CellLedger:
    """The accounts of all cells, by the cells' places."""

    cells: dict[Span, TableCell] = field(default_factory=dict)
    key_by_cell: dict[Span, str] = field(default_factory=dict)
    """The meaning of the column in which a cell stands."""
    _known_uses: set[tuple[Span, CellUse]] = field(default_factory=set)
    uses: dict[Span, list[CellUse]] = field(default_factory=dict)
    reasons: dict[Span, str] = field(default_factory=dict)
    """Why cells, or parts of them, were not taken."""
    listed: dict[Span, str] = field(default_factory=dict)
    """The reasons for cells that have no finding of their own: the summary lists these cells."""
    omissions: dict[Span, str] = field(default_factory=dict)
    """Why cells were left out on purpose."""

    def add_cell(self, cell: TableCell, key: str = "") -> None:
        """Open the account of a cell."""
        self.cells.setdefault(cell.span, cell)
        if key:
            self.key_by_cell.setdefault(cell.span, key)

    def take_cell(self, cell: TableCell, key: str, element: ElementPath, words: str = "") -> None:
        """Note that a cell was taken, and which words the element must have because of it."""
        use = CellUse(key, element, words)
        if (cell.span, use) not in self._known_uses:
            self._known_uses.add((cell.span, use))
            self.uses.setdefault(cell.span, []).append(use)

    def reject_cell(self, cell: TableCell, reason: str) -> None:
        """Note that a cell, or a part of it, was not taken."""
        self.reasons.setdefault(cell.span, reason)

    def list_cell(self, cell: TableCell, reason: str) -> None:
        """Note that a cell was not taken where a finding about its row, column or table says so already."""
        self.add_cell(cell)
        if cell.span not in self.reasons:
            self.reasons[cell.span] = self.listed[cell.span] = reason

    def omit_cell(self, cell: TableCell, reason: str) -> None:
        """Note that a cell was left out on purpose: it says nothing, or what follows from the rest."""
        self.add_cell(cell)
        self.omissions.setdefault(cell.span, reason)

    def has_account(self, cell: TableCell) -> bool:
        """Return whether something is noted about a cell."""
        return cell.span in self.uses or cell.span in self.reasons or cell.span in self.omissions

    def list_element(self, element: ElementPath, reason: str) -> None:
        """Note that all cells of an element were not taken, since it is not written."""
        for span, cell_uses in self.uses.items():
            if any(use.element == element for use in cell_uses) and span in self.cells:
                self.list_cell(self.cells[span], reason)

    def prove_uses(self, sections: Mapping[str, Any]) -> Iterator[tuple[TableCell, CellUse | None]]:
        """Drop what the data do not have. Yield the cells that this concerns, and those without an account (None)."""
        words_by_element: dict[ElementPath, frozenset[str]] = {}
        for span, cell in self.cells.items():
            proved_uses: list[CellUse] = []
            lost_use = None
            for use in self.uses.pop(span, ()):
                if use.element not in words_by_element:
                    words_by_element[use.element] = frozenset(_list_words(_look_up(sections, use.element)))
                present_words = words_by_element[use.element]
                if present_words and (not use.words or use.words in present_words):
                    proved_uses.append(use)
                else:
                    lost_use = lost_use or use
            if proved_uses:
                self.uses[span] = proved_uses
            if span not in self.reasons and span not in self.omissions and (lost_use or not proved_uses):
                yield cell, lost_use


def _look_up(sections: Mapping[str, Any], element: ElementPath) -> Any:  # noqa: ANN401 - any value of the language
    """Return an element with its id; None where it is not in the data."""
    value: Any = sections
    for name in element:
        if not isinstance(value, Mapping) or name not in value:
            return None
        value = value[name]
    # A title that follows from the id is not written.
    follows = {} if isinstance(value, Mapping) and "title" in value else {title_from_id(element[-1]): None}
    return {**follows, element[-1]: value}


def _list_words(value: Any) -> Iterator[str]:  # noqa: ANN401 - as above
    """Yield all keys and texts of a value; of a reference also each of its ids."""
    if isinstance(value, Mapping):
        for key, inner_value in value.items():
            yield str(key)
            yield from _list_words(inner_value)
    elif isinstance(value, str):
        yield value
        if "." in value and " " not in value:
            yield from value.split(".")
    elif isinstance(value, list | tuple):
        for inner_value in value:
            yield from _list_words(inner_value)


HEADING_WORDS: Mapping[str, Mapping[str, str]] = json.loads(
    Path(__file__).with_name("heading_words.json").read_text("utf-8")
)
"""The columns' headings by language and key. Plurals in `s` and spellings without accents need no entry of their own."""
TARGETS = tuple(HEADING_WORDS["English"])
"""What a column may mean."""
TOTAL_WORDS = frozenset(
    {"total", "totals", "subtotal", "subtotals", "sum", "grandtotal"}
    | {"summe", "summen", "gesamt", "gesamtsumme", "zwischensumme", "insgesamt", "anzahl"}
    | {"totaux", "soustotal", "somme", "totalgeneral", "nombre", "suma", "totales", "subtotales"}
)
"""What a row of totals begins with, folded."""
_GERMAN_SPELLINGS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss"})
_LIGATURES = str.maketrans({"œ": "oe", "æ": "ae", "ß": "ss"})


def fold_heading(text: str) -> str:
    """Fold a heading: case, camel case, accents, blanks, hyphens and punctuation do not tell two apart."""
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", unicodedata.normalize("NFC", text))
    plain = unicodedata.normalize("NFKD", spaced.casefold().translate(_LIGATURES)).encode("ascii", "ignore").decode()
    # A heading in another script keeps its letters, so that it can be mapped by hand.
    return "".join(re.findall(r"[a-z0-9]+", plain)) or "".join(text.casefold().split())


def _fold_spellings(word: str) -> Iterator[str]:
    """Yield the folded spellings of one heading: singular and plural, umlauts as `ae` or `a`."""
    for spelling in (word, word.casefold().translate(_GERMAN_SPELLINGS)):
        folded = fold_heading(spelling)
        yield folded
        # A plural of one or two letters would be a word of its own: `as`, `ids` apart.
        if len(folded) > 2 or folded == "id":  # noqa: PLR2004 - as above
            yield f"{folded}s"


def _index_words() -> Mapping[str, str]:
    index: dict[str, str] = {}
    for words_by_key in HEADING_WORDS.values():
        for key, words in words_by_key.items():
            for word in words.split(";"):
                for folded in _fold_spellings(word):
                    index.setdefault(folded, key)
            index.setdefault(fold_heading(key), key)
    return index


KEY_BY_HEADING = _index_words()
"""The key by folded heading, of all languages."""


_MIN_GUESSED_LENGTH = 5
HeadingMap = Mapping[str, str]
"""What the user says that headings mean: the key by folded heading."""
_ANCHOR_KEYS = frozenset({"component", "title", "id", "from", "to", "node", "group", "input", "output"})
"""A row of headings has one of these, unless it heads a table of requirements or types."""
_UNIT_PATTERN = re.compile(
    r"(?:[(\[/,]\s*+|(?<!\s)\s++(?:(?:in|en)\s++|[/,]\s*+)?)(?P<unit>k?hz|[m\u00b5\u03bcu]?s|fps|min|1/(?:s|min))\s*+[)\]]?\s*+\Z",
    re.IGNORECASE,
)
_KEYS_WITH_UNIT = frozenset({"rate", "period"})
_BRACKET_PATTERN = re.compile(r"[(\[]\s*+([A-Za-z\u00b5\u03bc/0-9]++)\s*+[)\]]\s*+\Z")
_DETAIL_PATTERN = re.compile(r"[(\[].*\Z", re.DOTALL)

LIST_TABLES: Mapping[tuple[str, ...], tuple[str, Mapping[str, str]]] = {
    ("id", "title", "owner", "role", "inputs", "outputs", "nodes", "place"): (
        "component",
        {"id": "component", "title": "title", "owner": "owner", "role": "role"},
    ),
    ("id", "title", "owner", "components", "place"): ("group", {"id": "group", "title": "title", "owner": "owner"}),
    ("input", "from", "kind", "types", "messages", "edges", "from_owner", "to_owner", "place"): (
        "connection",
        {"input": "to", "from": "from", "types": "type"},
    ),
    ("output", "input", "type", "message", "place"): (
        "connection",
        {"output": "from", "input": "to", "type": "type", "message": "message"},
    ),
    ("id", "implements", "owner", "package", "status", "host", "ros_name", "place"): (
        "node",
        {"id": "node", "implements": "component", "package": "package", "status": "status", "place": "place"},
    ),
    ("id", "title", "use_cases", "served_by", "place"): ("requirement", {"id": "requirement", "title": "title"}),
    ("id", "title", "parent", "kind", "priority", "use_cases", "served_by", "verified_by", "state", "place"): (
        "requirement",
        {"id": "requirement", "title": "title"},
    ),
    ("type", "message", "size", "remarks"): ("type", {"type": "type", "message": "message"}),
}
"""The tables that `archgen list` writes: what a row is, and what its columns mean. The other columns can be derived."""


@dataclass(frozen=True, slots=True)
class TableHeadings:
    """A row of headings.

    `key_by_column` are the meanings, `unit_by_key` the units in brackets. `kind` is set where `archgen list` wrote the
    table: its ids are complete paths. `cells` are the headings themselves, `unknown_columns` those without a meaning;
    `first_columns` has the columns that would have one if another column had not got it, and that other column.
    """

    key_by_column: Mapping[int, str]
    unit_by_key: Mapping[str, str]
    unknown_columns: Mapping[int, TableCell]
    kind: str = ""
    cells: TableRow = field(default_factory=dict)
    first_columns: Mapping[int, int] = field(default_factory=dict)

    def __contains__(self, key: object) -> bool:
        return key in self.key_by_column.values()


def parse_heading_map(texts: tuple[str, ...]) -> HeadingMap:
    """Read `Baugruppe=group`, once for each heading. Raise ValueError."""
    heading_map: dict[str, str] = {}
    for text in texts:
        heading, equals, target = (part.strip() for part in text.rpartition("="))
        if not equals or not heading or not target:
            raise ValueError(f"'{text}' is no heading with its meaning: write \"Baugruppe=group\"")
        key = KEY_BY_HEADING.get(fold_heading(target))
        if key is None:
            nearest = find_closest(fold_heading(target), KEY_BY_HEADING)
            guess = f"did you mean {KEY_BY_HEADING[nearest]}? " if nearest else ""
            raise ValueError(f"'{target}' is nothing that a column can mean. {guess}Columns mean: {', '.join(TARGETS)}")
        if heading_map.setdefault(fold_heading(heading), key) != key:
            raise ValueError(f"'{heading}' is mapped twice, to {heading_map[fold_heading(heading)]} and to {key}")
    return heading_map


def read_headings(row: TableRow, heading_map: HeadingMap | None = None) -> TableHeadings | None:
    """Read a row as headings; None where it is not one."""
    heading_map = heading_map or {}
    list_table = LIST_TABLES.get(tuple(cell.text for _, cell in sorted(row.items()))) if 0 in row else None
    if list_table:
        kind, key_by_text = list_table
        listed_keys = {column: key_by_text[cell.text] for column, cell in row.items() if cell.text in key_by_text}
        return TableHeadings(listed_keys, {}, {}, kind, row)
    all_keys = _find_keys(row, heading_map)
    keys = _drop_repeated(row, all_keys, heading_map)
    # At least half of the cells must be headings: a row of data may hold a word like `input` or `output` by chance.
    if len(keys) < 2 or not _has_anchor(set(keys.values())) or 2 * len(keys) < len(row):  # noqa: PLR2004 - two make a table
        return None
    fixed_columns = {column for column in keys if _is_mapped(row[column], heading_map)}
    units = {
        key: unit for column, key in keys.items() if key in _KEYS_WITH_UNIT and (unit := _unit_of_heading(row[column]))
    }
    unknown_columns = {column: cell for column, cell in row.items() if column not in keys}
    column_by_key = {key: column for column, key in keys.items()}
    first_columns = {column: column_by_key[key] for column, key in all_keys.items() if column not in keys}
    meanings = _choose_component_column(_choose_signal_meaning(keys), fixed_columns)
    return TableHeadings(meanings, units, unknown_columns, "", row, first_columns)


def read_new_headings(row: TableRow, heading_map: HeadingMap | None = None) -> TableHeadings | None:
    """Read a row right below data as new headings: every cell of it must be a known heading."""
    # Nearly every row is data: one unknown cell says so, and the others need no look.
    is_listed = tuple(cell.text for _, cell in sorted(row.items())) in LIST_TABLES
    if not is_listed and not all(key_of_heading(cell.one_line, heading_map) for cell in row.values()):
        return None
    new_headings = read_headings(row, heading_map)
    return new_headings if new_headings and (new_headings.kind or not new_headings.unknown_columns) else None


def key_of_heading(text: str, heading_map: HeadingMap | None = None) -> str | None:
    """Return the key that a heading means, with or without what it has in brackets, its unit, or its translation."""
    for folded in list_spellings(text):
        if key := (heading_map or {}).get(folded) or KEY_BY_HEADING.get(folded):
            return key
    # `Komponente / Component`: both halves mean the same.
    keys = [KEY_BY_HEADING.get(fold_heading(part)) for part in _UNIT_PATTERN.sub("", text).split("/")]
    return keys[0] if len(set(keys)) == 1 else None


def list_spellings(text: str) -> tuple[str, ...]:
    """Return the folded spellings by which a heading may be known: whole, without brackets, without its unit."""
    return tuple(map(fold_heading, (text, _DETAIL_PATTERN.sub("", text), _UNIT_PATTERN.sub("", text))))


def suggest_meaning(heading: str) -> str | None:
    """Return the key that an unknown heading most likely means."""
    folded = fold_heading(_DETAIL_PATTERN.sub("", heading))
    # With one slip, a short word is close to some short word of one of the languages.
    nearest = find_closest(folded, KEY_BY_HEADING) if len(folded) >= _MIN_GUESSED_LENGTH else None
    return KEY_BY_HEADING[nearest] if nearest else None


def write_map_option(heading: str, meaning: str | None) -> str:
    """Return the option that maps a heading, as it is typed: a table of others must not put commands into a shell."""
    text = f"{heading}={meaning or 'MEANING'}"
    return f'--map "{text}"' if re.fullmatch(r"[\w .:,;/()=#%&+-]+", text) else f"--map {shlex.quote(text)}"


def _has_anchor(keys: set[str]) -> bool:
    """Return whether columns name elements: components, nodes, ports; or requirements or types with what they mean."""
    return bool(_ANCHOR_KEYS & keys) or {"type", "message"} <= keys or {"requirement", "description"} <= keys


def _find_keys(row: TableRow, heading_map: HeadingMap) -> dict[int, str]:
    keys = {column: key for column, cell in row.items() if (key := key_of_heading(cell.one_line, heading_map))}
    # A single letter heads a column (`De`, `A`) only opposite the other end: components are called A, too.
    if "from" not in keys.values():
        keys = {column: key for column, key in keys.items() if len(fold_heading(row[column].one_line)) > 1}
    # Where `Type` is there as well, `Signal` or `Data` names what flows; alone it is the type.
    has_type = "type" in keys.values()
    return {column: "type" if key == "signal" and not has_type else key for column, key in keys.items()}


def _drop_repeated(row: TableRow, keys: Mapping[int, str], heading_map: HeadingMap) -> dict[int, str]:
    """Leave one column of each meaning: the one that the user maps to it, else the first."""
    column_by_key: dict[str, int] = {}
    for column, key in sorted(keys.items(), key=lambda item: (not _is_mapped(row[item[0]], heading_map), item)):
        column_by_key.setdefault(key, column)
    return {column: key for column, key in sorted(keys.items()) if column_by_key[key] == column}


def _is_mapped(cell: TableCell, heading_map: HeadingMap) -> bool:
    return any(spelling in heading_map for spelling in list_spellings(cell.one_line))


def _choose_signal_meaning(keys: Mapping[int, str]) -> dict[int, str]:
    """Take a column `Signal` beside a column `Type` for the outputs that are connected, where no other column is."""
    if "output" in keys.values():
        return dict(keys)
    return {column: "output" if key == "signal" else key for column, key in keys.items()}


def _unit_of_heading(cell: TableCell) -> str:
    in_brackets = _BRACKET_PATTERN.search(cell.one_line)
    match = _UNIT_PATTERN.search(cell.one_line)
    return in_brackets[1] if in_brackets else match["unit"] if match else ""


def _choose_component_column(keys: Mapping[int, str], fixed_columns: set[int]) -> dict[int, str]:
    """Choose what names a component where no column is called so: a name, a title or an id."""
    present_keys = set(keys.values())
    connects = {"from", "to"} <= present_keys
    if not _ANCHOR_KEYS & present_keys:
        return dict(keys)
    # In a table of components a column `Description` usually says what each of them does.
    if "functionality" not in present_keys and not connects:
        keys = {
            column: "functionality" if key == "description" and column not in fixed_columns else key
            for column, key in keys.items()
        }
    if "component" in present_keys or connects:
        return dict(keys)
    name = next((key for key in ("title", "id") if key in present_keys), "")
    if name and "node" not in present_keys:
        return {
            column: "component" if key == name and column not in fixed_columns else key for column, key in keys.items()
        }
    return dict(keys)
