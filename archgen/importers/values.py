"""Read single cells: rates, messages, topics, lists, requirements. What cannot be read is reported and left out."""

from __future__ import annotations

import re

from archgen.importers.cells import Cell
from archgen.importers.draft import Draft
from archgen.model.mapping import full_message
from archgen.model.quantity import parse

_RATE = re.compile(r"([0-9]{1,9}(?:[.,][0-9]{1,9})?)\s*(hz|khz|fps|1/s|s|ms|us|min)?\Z", re.IGNORECASE)
_UNITS = {"hz": "Hz", "khz": "kHz", "fps": "Hz", "1/s": "Hz", "s": "s", "ms": "ms", "us": "us", "min": "min"}
_TOPIC = re.compile(
    r"[~/]?[A-Za-z_][A-Za-z0-9_]*(?:/[A-Za-z_][A-Za-z0-9_]*)*\Z|~/[A-Za-z_][A-Za-z0-9_/]*[A-Za-z0-9_]\Z"
)
_PACKAGE = re.compile(r"[a-z][a-z0-9_]*\Z")
_REQUIREMENT = re.compile(r"[A-Za-z][A-Za-z0-9._-]*\Z")
_LONGEST_TYPE = 200


def formula(draft: Draft, cell: Cell | None) -> bool:
    """Return whether a cell holds a formula instead of its result, and report it."""
    if cell is None or not cell.text.startswith("="):
        return False
    draft.say(
        "wrong-value", f"`{_short(cell.line)}` is a formula and was not taken", cell.at, "export the table's values"
    )
    return True


def timing(draft: Draft, cell: Cell, unit: str) -> dict[str, str] | None:
    """Read a rate or a period: `10`, `10 Hz`, `0,5 Hz`, `100 ms`. `unit` is the one of the column."""
    found = _RATE.match(cell.line)
    written = _UNITS.get((found[2] or unit).lower()) if found else None
    if found and written:
        text = f"{found[1].replace(',', '.')} {written}"
        key, dimension = ("rate", "frequency") if written.endswith("Hz") else ("period", "duration")
        # 0 parses as a quantity, but is not a rate.
        if parse(text, dimension) and re.search("[1-9]", text):
            return {key: text}
    message = f"`{_short(cell.line)}` is no rate and no period, and was not taken"
    draft.say("wrong-value", message, cell.at, "write a number and a unit, such as 10 Hz or 100 ms")
    return None


def message(draft: Draft, cell: Cell) -> str | None:
    """Read a message: `sensor_msgs/LaserScan`, `sensor_msgs::msg::LaserScan`, `sensor_msgs.msg.LaserScan`."""
    name = full_message(re.sub(r"::|\.", "/", cell.line))
    if name is not None:
        draft.places.setdefault(name, cell.at)
    else:
        text = f"`{_short(cell.line)}` names no message and was not taken"
        draft.say("wrong-value", text, cell.at, "write package/msg/Name, such as sensor_msgs/msg/LaserScan")
    return name


def type_name(draft: Draft, cell: Cell) -> str | None:
    """Read a conceptual type."""
    if len(cell.line) <= _LONGEST_TYPE:
        name = full_message(re.sub(r"::", "/", cell.line)) or cell.line
        draft.places.setdefault(name, cell.at)
        return name
    text = f"a type's name has at most {_LONGEST_TYPE} characters: it was not taken"
    draft.say("wrong-value", text, cell.at, "give the data a short name")
    return None


def topic(draft: Draft, cell: Cell) -> str | None:
    """Read a topic's name."""
    if _TOPIC.match(cell.line):
        return cell.line
    draft.say(
        "wrong-value", f"`{_short(cell.line)}` is no topic's name and was not taken", cell.at, "write /camera/image"
    )
    return None


def package(draft: Draft, cell: Cell) -> str | None:
    """Read a package's name."""
    if _PACKAGE.match(cell.line):
        return cell.line
    text = f"`{_short(cell.line)}` is no package's name and was not taken"
    draft.say("wrong-value", text, cell.at, "write lower-case words joined by `_`")
    return None


def several(cell: Cell) -> list[str]:
    """Split a list in one cell at line ends and semicolons, else at commas outside of brackets."""
    if re.search(r"[\n\r;]", cell.text):
        # Where a list is split at line ends or semicolons, a comma is a part of an item.
        parts = re.split(r"[\n\r;]+", cell.text)
    else:
        parts = re.split(r",(?![^(\[]*[)\]])", cell.text)
    return [" ".join(part.strip(" \t-*\u2022").split()) for part in parts if part.strip(" \t-*\u2022")]


def requirements(draft: Draft, cell: Cell) -> list[str]:
    """Read ids of requirements, or one sentence."""
    found = several(cell)
    words = [word for part in found for word in part.split("/") if word.strip()]
    if all(_REQUIREMENT.match(word.strip()) for word in words):
        for word in words:
            draft.requirements.setdefault(word.strip(), None)
        return [word.strip() for word in words]
    if all(" " in part for part in found):
        return found if "\n" in cell.text or ";" in cell.text else [cell.line]
    made = []
    for part in found:
        made.append(part if " " in part or _REQUIREMENT.match(part) else f"Requirement {part}")
        if _REQUIREMENT.match(part):
            draft.requirements.setdefault(part, None)
    return made


def _short(text: str) -> str:
    return text if len(text) <= 40 else f"{text[:39]}\u2026"  # noqa: PLR2004 - enough to recognise it
