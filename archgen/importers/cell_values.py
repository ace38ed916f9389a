"""Read single cells: rates, messages, topics, lists, requirements. What cannot be read is reported and left out."""

from __future__ import annotations

import re

from archgen.importers.imported_project import ImportedProject
from archgen.importers.table_cells import TableCell
from archgen.model.message_types import full_message_name
from archgen.model.quantity import parse_quantity

_RATE_PATTERN = re.compile(r"([0-9]{1,9}(?:[.,][0-9]{1,9})?)\s*(hz|khz|fps|1/s|s|ms|us|min)?\Z", re.IGNORECASE)
_UNIT_NAMES = {"hz": "Hz", "khz": "kHz", "fps": "Hz", "1/s": "Hz", "s": "s", "ms": "ms", "us": "us", "min": "min"}
_TOPIC_PATTERN = re.compile(
    r"[~/]?[A-Za-z_][A-Za-z0-9_]*(?:/[A-Za-z_][A-Za-z0-9_]*)*\Z|~/[A-Za-z_][A-Za-z0-9_/]*[A-Za-z0-9_]\Z"
)
_PACKAGE_PATTERN = re.compile(r"[a-z][a-z0-9_]*\Z")
_REQUIREMENT_PATTERN = re.compile(r"[A-Za-z][A-Za-z0-9._-]*\Z")
_MAX_TYPE_LENGTH = 200


def reject_formula(project: ImportedProject, cell: TableCell | None) -> bool:
    """Return whether a cell holds a formula instead of its result, and report it."""
    if cell is None or not cell.text.startswith("="):
        return False
    project.add_warning(
        "wrong-value",
        f"`{_shorten_text(cell.one_line)}` is a formula and was not taken",
        cell.span,
        "export the table's values",
    )
    return True


def read_timing(project: ImportedProject, cell: TableCell, unit: str) -> dict[str, str] | None:
    """Read a rate or a period: `10`, `10 Hz`, `0,5 Hz`, `100 ms`. `unit` is the one of the column."""
    match = _RATE_PATTERN.match(cell.one_line)
    unit_name = _UNIT_NAMES.get((match[2] or unit).lower()) if match else None
    if match and unit_name:
        text = f"{match[1].replace(',', '.')} {unit_name}"
        key, dimension = ("rate", "frequency") if unit_name.endswith("Hz") else ("period", "duration")
        # 0 parses as a quantity, but is not a rate.
        if parse_quantity(text, dimension) and re.search("[1-9]", text):
            return {key: text}
    message = f"`{_shorten_text(cell.one_line)}` is no rate and no period, and was not taken"
    project.add_warning("wrong-value", message, cell.span, "write a number and a unit, such as 10 Hz or 100 ms")
    return None


def read_message(project: ImportedProject, cell: TableCell) -> str | None:
    """Read a message: `sensor_msgs/LaserScan`, `sensor_msgs::msg::LaserScan`, `sensor_msgs.msg.LaserScan`."""
    name = full_message_name(re.sub(r"::|\.", "/", cell.one_line))
    if name is not None:
        project.first_spans.setdefault(name, cell.span)
    else:
        text = f"`{_shorten_text(cell.one_line)}` names no message and was not taken"
        project.add_warning("wrong-value", text, cell.span, "write package/msg/Name, such as sensor_msgs/msg/LaserScan")
    return name


def read_type_name(project: ImportedProject, cell: TableCell) -> str | None:
    """Read a conceptual type."""
    if len(cell.one_line) <= _MAX_TYPE_LENGTH:
        name = full_message_name(re.sub(r"::", "/", cell.one_line)) or cell.one_line
        project.first_spans.setdefault(name, cell.span)
        return name
    text = f"a type's name has at most {_MAX_TYPE_LENGTH} characters: it was not taken"
    project.add_warning("wrong-value", text, cell.span, "give the data a short name")
    return None


def read_topic(project: ImportedProject, cell: TableCell) -> str | None:
    """Read a topic's name."""
    if _TOPIC_PATTERN.match(cell.one_line):
        return cell.one_line
    project.add_warning(
        "wrong-value",
        f"`{_shorten_text(cell.one_line)}` is no topic's name and was not taken",
        cell.span,
        "write /camera/image",
    )
    return None


def read_package(project: ImportedProject, cell: TableCell) -> str | None:
    """Read a package's name."""
    if _PACKAGE_PATTERN.match(cell.one_line):
        return cell.one_line
    text = f"`{_shorten_text(cell.one_line)}` is no package's name and was not taken"
    project.add_warning("wrong-value", text, cell.span, "write lower-case words joined by `_`")
    return None


def split_list(cell: TableCell) -> list[str]:
    """Split a list in one cell at line ends and semicolons, else at commas outside of brackets."""
    if re.search(r"[\n\r;]", cell.text):
        # Where a list is split at line ends or semicolons, a comma is a part of an item.
        items = re.split(r"[\n\r;]+", cell.text)
    else:
        items = re.split(r",(?![^(\[]*[)\]])", cell.text)
    return [" ".join(item.strip(" \t-*\u2022").split()) for item in items if item.strip(" \t-*\u2022")]


def read_requirements(project: ImportedProject, cell: TableCell) -> list[str]:
    """Read ids of requirements, or one sentence."""
    items = split_list(cell)
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


def _shorten_text(text: str) -> str:
    return text if len(text) <= 40 else f"{text[:39]}\u2026"  # noqa: PLR2004 - enough to recognise it
