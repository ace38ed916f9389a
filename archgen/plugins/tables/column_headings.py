"""The meaning of a table's column headings, in the spellings and languages that teams use.

The words that head the columns of tables, by language and meaning, and how spellings of one word are folded.
"""

from __future__ import annotations

import json
import re
import shlex
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from archgen.plugin.importing import find_closest
from archgen.plugins.tables.table_cells import TableCell, TableRow

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
