"""Read single cells: rates, messages, topics, lists, requirements. What cannot be read is reported and left out."""

from __future__ import annotations

import re
from itertools import pairwise

from archgen.plugin.model import parse_quantity
from archgen.plugin.ros import full_message_name
from archgen.plugins.tables.imported_project import MAX_LISTED, ImportedProject
from archgen.plugins.tables.table_cells import TableCell

_NUMBER = r"[0-9]{1,3}(?:[ '\u2019.,][0-9]{3})+(?![0-9])|[0-9]{1,9}"
_RATE_PATTERN = re.compile(
    rf"(?P<every>every|each|alle|jede|toutes les|tous les|chaque|cada|todos los)?\s*(?P<number>(?:{_NUMBER})(?:[.,][0-9]{{1,9}})?)\s*"
    r"(?P<unit>[a-z\u00b5\u03bc/][a-z0-9/ ]{0,20}|1/s|1/min)?\Z",
    re.IGNORECASE,
)
_UNIT_SPELLINGS = {
    "Hz": "hz; hertz; fps; 1/s; /s; x/s; per second; times per second; pro sekunde; mal pro sekunde; par seconde; "
    "fois par seconde; por segundo; veces por segundo; images/s; bilder/s; frames/s",
    "kHz": "khz; kilohertz",
    "s": "s; sec; sek; second; seconds; sekunde; sekunden; seconde; secondes; segundo; segundos",
    "ms": "ms; msec; milliseconds; millisekunden; millisecondes; milisegundos",
    "us": "us; \u00b5s; \u03bcs; microseconds; mikrosekunden; microsecondes; microsegundos",
    "min": "min; minute; minutes; minuten; minuto; minutos",
}
_UNIT_BY_SPELLING = {
    spelling.strip(): unit for unit, spellings in _UNIT_SPELLINGS.items() for spelling in spellings.split(";")
}
# `1.000`: a thousand in German, one in English.
_AMBIGUOUS_NUMBER = re.compile(r"[1-9][0-9]{0,2}[.,][0-9]{3}\Z")
_TOPIC_PATTERN = re.compile(
    r"[~/]?[A-Za-z_][A-Za-z0-9_]*(?:/[A-Za-z_][A-Za-z0-9_]*)*\Z|~/[A-Za-z_][A-Za-z0-9_/]*[A-Za-z0-9_]\Z"
)
_PACKAGE_PATTERN = re.compile(r"[a-z][a-z0-9_]*\Z")
_REQUIREMENT_PATTERN = re.compile(r"[A-Za-z][A-Za-z0-9._-]*\Z")
_MAX_TYPE_LENGTH = 200
_ERROR_PATTERN = re.compile(r"#(?:REF|NAME|VALUE|NUM|DIV/0|N/A|NULL|BEZUG|WERT|ZAHL|NV)[!?]?\Z|Err:[0-9]{3}\Z")


def reject_formula(project: ImportedProject, cell: TableCell | None) -> bool:
    """Return whether a cell holds a formula instead of its result, or an error as its result, and report it."""
    if cell is None or not (cell.text.startswith("=") or _ERROR_PATTERN.match(cell.text)):
        return False
    kind = "a formula" if cell.text.startswith("=") else "the error of a formula"
    message = f"`{cell.quotation}` is {kind} and was not taken"
    project.reject_cell("wrong-value", message, cell, "export the table's values")
    return True


def read_timing(project: ImportedProject, cell: TableCell, unit: str) -> dict[str, str] | None:
    """Read a rate or a period: `10`, `10 Hz`, `0,5 Hz`, `100 ms`, `alle 100 ms`. `unit` is the one of the column."""
    match = _RATE_PATTERN.match(cell.one_line)
    unit_name = _UNIT_BY_SPELLING.get((match["unit"] or unit).strip().lower()) if match else None
    message = f"`{cell.quotation}` is no rate and no period, and was not taken"
    help_line = "write a number and a unit, such as 10 Hz or 100 ms"
    if match and unit_name:
        key, dimension = ("rate", "frequency") if unit_name.endswith("Hz") else ("period", "duration")
        number = _read_number(match["number"])
        if number is None or (_AMBIGUOUS_NUMBER.match(match["number"]) and not cell.is_number):
            message = (
                f"`{cell.quotation}` has a separator that may stand before thousands or decimals, and was not taken"
            )
            help_line = "write the number without a thousands separator, and with a point"
        # 0 parses as a quantity, but is not a rate; and `every 10 Hz` means nothing.
        elif (
            re.search("[1-9]", number)
            and not (match["every"] and key == "rate")
            and parse_quantity(f"{number} {unit_name}", dimension)
        ):
            return {key: f"{number} {unit_name}"}
    project.reject_cell("wrong-value", message, cell, help_line)
    return None


def _read_number(text: str) -> str | None:
    """Return a number without thousands separators and with a decimal point; None where the two are mixed up."""
    separators = re.findall(r"[^0-9]", text)
    if len(separators) > 1 or (separators and separators[0] in " '\u2019"):
        # The last separator is the decimal one where it is not like those before.
        decimal = separators[-1] if separators[-1] in ".," and separators.count(separators[-1]) == 1 else ""
        if len(set(separators)) > 1 + bool(decimal):
            return None
        whole, _, fraction = text.rpartition(decimal) if decimal else (text, "", "")
        return re.sub("[^0-9]", "", whole) + (f".{fraction}" if fraction else "")
    return text.replace(",", ".")


def read_message_cell(project: ImportedProject, cell: TableCell) -> str | None:
    """Read a message: `sensor_msgs/LaserScan`, `sensor_msgs::msg::LaserScan`, `sensor_msgs.msg.LaserScan`."""
    name = full_message_name(re.sub(r"::|\.", "/", cell.one_line))
    if name is not None:
        project.add_message_cell(name, cell)
    else:
        text = f"`{cell.quotation}` names no message and was not taken"
        project.reject_cell("wrong-value", text, cell, "write package/msg/Name, such as sensor_msgs/msg/LaserScan")
    return name


def read_type_name(project: ImportedProject, cell: TableCell) -> str | None:
    """Read a conceptual type."""
    if len(cell.one_line) <= _MAX_TYPE_LENGTH:
        name = full_message_name(re.sub(r"::", "/", cell.one_line)) or cell.one_line
        project.add_message_cell(name, cell)
        return name
    text = f"a type's name has at most {_MAX_TYPE_LENGTH} characters: `{cell.quotation}` was not taken"
    project.reject_cell("wrong-value", text, cell, "give the data a short name")
    return None


def join_cell_lines(cell: TableCell) -> str:
    """Return a text of several lines without blanks at the ends of its lines."""
    return "\n".join(line.rstrip() for line in cell.text.splitlines())


def read_topic(project: ImportedProject, cell: TableCell) -> str | None:
    """Read a topic's name."""
    return _read_name(project, cell, _TOPIC_PATTERN, "topic", "write /camera/image")


def read_package(project: ImportedProject, cell: TableCell) -> str | None:
    """Read a package's name."""
    return _read_name(project, cell, _PACKAGE_PATTERN, "package", "write lower-case words joined by `_`")


def _read_name(
    project: ImportedProject, cell: TableCell, pattern: re.Pattern[str], kind: str, help_line: str
) -> str | None:
    if pattern.match(cell.one_line):
        return cell.one_line
    project.reject_cell("wrong-value", f"`{cell.quotation}` is no {kind}'s name and was not taken", cell, help_line)
    return None


def _split_outside_brackets(text: str) -> list[str]:
    """Split at commas; those before a closing bracket that no opening one precedes are within brackets."""
    commas: list[int] = []
    undecided_commas: list[int] = []
    for sign in re.finditer(r"[,()\[\]]", text):
        if sign[0] == ",":
            undecided_commas.append(sign.start())
            continue
        if sign[0] in "([":
            commas += undecided_commas
        undecided_commas = []
    commas += undecided_commas
    return [text[start + 1 : end] for start, end in pairwise([-1, *commas, len(text)])]


def list_items(project: ImportedProject, cell: TableCell) -> list[str]:
    """Return the items of a cell, as many as the project's budget has; what it does not take is told once."""
    items = split_cell_list(cell)
    if project.budget.pay(len(items)):
        return items
    kept = items[: project.budget.left]
    project.budget.pay(len(kept))
    if project.budget.tell_excess():
        message = f"cells list more than {MAX_LISTED:,} things: what comes later was not taken"
        project.reject_cell("too-large", message, cell, "take the lists over in several tables")
    return kept


def split_cell_list(cell: TableCell) -> list[str]:
    """Split a list in one cell at line ends and semicolons, else at commas outside of brackets."""
    # Where a list is split at line ends or semicolons, a comma is a part of an item.
    items = re.split(r"[\n\r;]+", cell.text)
    items = items if len(items) > 1 else _split_outside_brackets(cell.text)
    return [" ".join(item.strip(" \t-*\u2022").split()) for item in items if item.strip(" \t-*\u2022")]


def read_requirements(project: ImportedProject, cell: TableCell) -> list[str]:
    """Read ids of requirements, or one sentence."""
    items = split_cell_list(cell)
    words = [word for item in items for word in item.split("/") if word.strip()]
    if all(_REQUIREMENT_PATTERN.match(word.strip()) for word in words):
        for word in words:
            project.requirements.setdefault(word.strip(), None)
        return [word.strip() for word in words]
    if all(" " in item for item in items):
        return items if "\n" in cell.text or ";" in cell.text else [cell.one_line]
    sentences = []
    for item in items:
        sentences.append(item if " " in item or _REQUIREMENT_PATTERN.match(item) else f"Requirement {item}")
        if _REQUIREMENT_PATTERN.match(item):
            project.requirements.setdefault(item, None)
    return sentences
