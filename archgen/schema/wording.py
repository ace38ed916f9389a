"""Phrase what is wrong with a value or a key, in our own words, with help for the commonest slips.

The validator's own messages quote the schema's patterns and Python values, which say nothing to people who write YAML.
"""

from __future__ import annotations

import re
from typing import Any, NamedTuple

from archgen.diagnostic import Diagnostic
from archgen.model import quantity
from archgen.source import NOWHERE
from archgen.suggest import did_you_mean
from archgen.syntax.tree import Entry, Listing, Scalar, Table, Value

NO_PLACE = NOWHERE
# A sign, digits with a point or a comma, and whatever follows them as the unit.
_NUMBER = re.compile(r"\s*([-+]?)\s*([0-9]+(?:[.,][0-9]+)?)\s*(\S*)\s*\Z", re.ASCII)
_SPELLED = {
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "msec": "ms", "msecs": "ms", "usec": "us", "µs": "us",
    "μs": "us", "nsec": "ns", "m": "min", "mins": "min", "minutes": "min", "hour": "h", "hours": "h", "fps": "Hz",
    "bps": "bit/s", "kbps": "kbit/s", "Mbps": "Mbit/s", "mbps": "Mbit/s", "Gbps": "Gbit/s", "gbps": "Gbit/s",
    "Mb/s": "Mbit/s", "Gb/s": "Gbit/s", "kb/s": "kbit/s", "b/s": "bit/s", "bytes": "B", "byte": "B",
}  # fmt: skip
_EXAMPLE_UNIT = {"duration": "ms", "frequency": "Hz", "size": "kB", "bandwidth": "Mbit/s"}
_YES = {
    "yes": "true",
    "on": "true",
    "y": "true",
    "1": "true",
    "no": "false",
    "off": "false",
    "n": "false",
    "0": "false",
}
SECTIONS_BY_ID = frozenset(
    {"groups", "nodes", "types", "requirements", "use_cases", "partners", "hosts", "containers", "links", "chains"}
    | {"views", "policies"}
)
"""The top-level sections that hold elements by id."""
_PLAIN_WORDS = {"array": "a list", "object": "a mapping", "integer": "a whole number", "boolean": "`true` or `false`"}


class Place(NamedTuple):
    """Where an error is: its path, the node there, what holds the node, and its entry if that is a mapping."""

    path: tuple[str | int, ...]
    value: Value
    parent: Table | Listing | None = None
    entry: Entry | None = None


def unknown_key(entry: Entry, part: dict[str, Any], path: tuple[str | int, ...]) -> Diagnostic:
    """Report a key that the schema does not have at its place, with the most likely meaning as help."""
    known = tuple(part.get("properties", ()))
    message = (
        f"no section is called `{entry.key}`" if not path else f"{_article(part['title'])} has no key `{entry.key}`"
    )
    help_line = _key_help(entry, known) or did_you_mean(entry.key, known) or f"its keys are {_listed(known)}"
    if not path and help_line.startswith("its keys"):
        help_line = f"the sections are {_listed(known)}"
    return Diagnostic("unknown-key", message, entry.at, help=help_line, element=element(path))


def _key_help(entry: Entry, known: tuple[str, ...]) -> str | None:
    if entry.key in {"name", "id"} and "title" in known:
        return "the key above is the id; write the name for people as `title`"
    if ":" in entry.key:
        before, after = entry.key.split(":", 1)
        if before in known:
            return f"write a blank after the colon: `{before}: {after}`"
    return None


def wrong_key(entry: Entry, part: dict[str, Any], path: tuple[str | int, ...]) -> Diagnostic:
    """Report a key that cannot be an id of what it names, with an id that could as help."""
    message = f"`{entry.key}` cannot be {_article(part.get('title', 'key').split(' of ')[0])}"
    better = next((key for key in better_keys(entry.key) if re.search(part.get("pattern", r"\Z."), key)), None)
    help_line = part.get("patternErrorMessage") or "it is too long"
    if len(entry.key) > part.get("maxLength", len(entry.key)):
        help_line = f"at most {part['maxLength']} characters are allowed"
    elif better and better != entry.key:
        help_line = f"{help_line}; write `{better}`"
    return Diagnostic("wrong-value", message, entry.at, help=help_line, element=element(path))


def better_keys(key: str) -> tuple[str, str]:
    """Return what a malformed id may have been meant to be: as the id of a requirement, and as any other id."""
    snake = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", key).lower()
    return re.sub(r"[^A-Za-z0-9._-]+", "-", key).strip("-"), re.sub(r"[^a-z0-9]+", "_", snake).strip("_")


def wrong(kind: str, place: Place, part: dict[str, Any]) -> Diagnostic:
    """Report a value of the wrong type, or one that is not allowed; `kind` is the validator's name for the error."""
    name, value = _name(place), place.value
    if kind == "type":
        rule, message, help_line = _wrong_type(name, value, part)
    else:
        rule, (message, help_line) = "wrong-value", _wrong_value(kind, name, value, part)
    # A container's own span can cover a whole section: its key is shown instead. An entry of a list has no key.
    at = value.at
    if isinstance(value, Table | Listing) and place.entry is not None and value is place.entry.value:
        at = place.entry.at
    return Diagnostic(rule, message, at, help=help_line, element=element(place.path))


def _wrong_type(name: str, value: Value, part: dict[str, Any]) -> tuple[str, str, str | None]:
    expected = _expected(part)
    dimension = _dimension(part)
    if isinstance(value, Scalar):
        if dimension:
            return "wrong-value", *_wrong_quantity(name, value.text, dimension, part)
        if value.value is None:
            return "wrong-type", f"{name} is empty, but must be {expected}", None
        help_line = _scalar_help(value.text, part)
        return "wrong-type", f"{name} is `{_short(value.text)}`, but must be {expected}", help_line
    found = "a list" if isinstance(value, Listing) else "a mapping"
    return "wrong-type", f"{name} is {found}, but must be {expected}", _container_help(name, value, part)


def _scalar_help(text: str, part: dict[str, Any]) -> str | None:
    types = part.get("type", ())
    if "boolean" in types:
        return _yes_or_no(text.lower())
    if "integer" in types:
        digits = re.match(r"\s*([0-9]+)", text)
        return f"write `{digits[1]}`, without quotes, point or unit" if digits else "write a number without unit"
    if "array" in types:
        return f"write `[{_in_list(text)}]`"
    if "propertyNames" in part:
        return "write one `id: ...` line for each below it, or `{}` for none"
    if "patternErrorMessage" in part:
        return str(part["patternErrorMessage"])
    return f"its keys are {_listed(tuple(part['properties']))}" if part.get("properties") else None


def _yes_or_no(word: str) -> str | None:
    if word in _YES:
        return f"write `{_YES[word]}`"
    return f"write `{word}`, without quotes" if word in {"true", "false"} else None


_PLAIN = re.compile(r"[A-Za-z0-9_/][\w ./@+-]*\Z", re.ASCII)


def _in_list(text: str) -> str:
    """Return a text as an entry of a list in brackets: quoted where YAML would read it as something else."""
    return _short(text) if _PLAIN.match(text) else f'"{_short(text)}"'


def _container_help(name: str, value: Value, part: dict[str, Any]) -> str | None:
    if isinstance(value, Listing) and "object" in part.get("type", ()):
        if not value.items:
            return "write `{}` for none"
        if "propertyNames" in part or isinstance(part.get("additionalProperties"), dict):
            return f"{name} is keyed by id: write `id: ...` lines instead of a list"
        return f"its keys are {_listed(tuple(part['properties']))}" if part.get("properties") else None
    if isinstance(value, Table) and "array" in part.get("type", ()):
        return "write a list: [a, b], or one entry a line, each after `- `"
    if isinstance(value, Table) and value.at.line == value.at.end_line:
        return "text with braces must be quoted"
    return str(part["patternErrorMessage"]) if "patternErrorMessage" in part else None


def _wrong_value(kind: str, name: str, value: Value, part: dict[str, Any]) -> tuple[str, str | None]:
    text = value.text if isinstance(value, Scalar) else ""
    dimension = _dimension(part)
    if kind == "pattern" and dimension:
        return _wrong_quantity(name, text, dimension, part)
    if kind == "const":
        return f"this archgen reads version {part[kind]} of the language, not `{_short(text)}`", f"write `{part[kind]}`"
    if kind in {"maxLength", "minLength"}:
        return f"{name} is too {'long' if kind == 'maxLength' else 'short'}", f"the limit is {part[kind]} characters"
    if text != text.strip() and re.search(part.get("pattern", ""), text.strip()):
        return f"{name} has a blank at its beginning or end", f"write `{text.strip()}`"
    return f"{name} cannot be `{_short(text)}`", _value_help(kind, text, part)


def _value_help(kind: str, text: str, part: dict[str, Any]) -> str | None:
    if kind == "enum":
        options = [option for option in part["enum"] if option is not None]
        return did_you_mean(text, options) or f"it is one of {_listed(options)}"
    if kind in {"minimum", "maximum"}:
        return f"it is at {'least' if kind == 'minimum' else 'most'} {part[kind]}"
    return part.get("patternErrorMessage")


def _dimension(part: dict[str, Any]) -> str | None:
    """Return the dimension of a quantity, or None for other values.

    The schema has no field for it: the second word of its `patternErrorMessage` ("a duration is ...") decides.
    """
    words = str(part.get("patternErrorMessage", "")).split(" ")
    return _DIMENSIONS.get(words[1]) if words[1:] else None


_DIMENSIONS = {"duration": "duration", "rate": "frequency", "size": "size", "bandwidth": "bandwidth"}


def _wrong_quantity(name: str, text: str, dimension: str, part: dict[str, Any]) -> tuple[str, str]:
    explained = str(part["patternErrorMessage"])
    match = _NUMBER.match(text)
    if match is None:
        return f"{name} cannot be `{_short(text)}`", explained
    sign, number, unit = match.groups()
    if sign == "-":
        return f"{name} cannot be negative", explained
    number = number.replace(",", ".")
    if not unit:
        return f"`{_short(text)}` has no unit", f"write `{number} {_EXAMPLE_UNIT[dimension]}`; {explained}"
    if unit in quantity.UNITS[dimension]:
        if max(map(len, number.split("."))) > quantity.DIGITS:
            return f"{name} has too many digits", f"at most {quantity.DIGITS} are read before and after the point"
        return f"{name} cannot be `{_short(text)}`", f"write `{number} {unit}`"
    return _wrong_unit(name, number, unit, dimension, explained)


def _wrong_unit(name: str, number: str, unit: str, dimension: str, explained: str) -> tuple[str, str]:
    better, message = _better_unit(unit, dimension), f"{name} has no unit `{_short(unit)}`"
    other = _OTHER_KEY.get((name.strip("`"), unit))
    if other:
        return message, f"write `{other}: {number} {unit}`"
    if dimension in {"size", "bandwidth"} and better and unit.lower() == better.lower():
        return message, f"write `{number} {better}`; case counts: kB is 1000 bytes, KiB is 1024"
    return message, f"write `{number} {better}`; case counts" if better else explained


_OTHER_KEY = {("rate", unit): "period" for unit in quantity.UNITS["duration"]} | {
    ("period", unit): "rate" for unit in quantity.UNITS["frequency"]
}
"""The key that was meant where somebody writes `rate: 20 ms` or `period: 50 Hz`, by key and unit."""


def _better_unit(unit: str, dimension: str) -> str | None:
    units = quantity.UNITS[dimension]
    # A known other spelling first, then the case: `MS` may be meant as ms, and `mbps` is nothing but a spelling.
    spelled = _SPELLED.get(unit)
    if spelled in units:
        return spelled
    folded = [known for known in units if known.lower() == unit.lower()]
    return folded[0] if folded else None


def _expected(part: dict[str, Any]) -> str:
    types = [kind for kind in _types(part) if kind != "null"]
    words = ["text"] if "string" in types else []
    if "enum" in part:
        words = [f"one of {_listed([option for option in part['enum'] if option is not None])}"]
    words += [
        _PLAIN_WORDS[kind] for kind in types if kind in _PLAIN_WORDS and not ("string" in types and kind == "boolean")
    ]
    if "number" in types and "boolean" not in types:
        words = ["a number", *(word for word in words if word != "text")]
    return " or ".join((", ".join(words[:-1]), words[-1])) if len(words) > 1 else words[0]


def _types(part: dict[str, Any]) -> list[str]:
    found = part.get("type", [])
    return [found] if isinstance(found, str) else found


def _name(place: Place) -> str:
    keys = [step for step in place.path if isinstance(step, str)]
    if not keys:
        return "the file"
    return f"an entry of `{keys[-1]}`" if isinstance(place.path[-1], int) else f"`{keys[-1]}`"


def element(path: tuple[str | int, ...]) -> str | None:
    """Return the id of the element that a path leads into, or None outside of all elements."""
    if len(path) < 2:  # noqa: PLR2004 - a section and an id
        return None
    if path[0] == "groups" and len(path) > 3 and path[2] == "components":  # noqa: PLR2004
        return f"{path[1]}.{path[3]}"
    return str(path[1]) if path[0] in SECTIONS_BY_ID else None


def _article(title: str) -> str:
    word = title if title[:3].isupper() else title[0].lower() + title[1:]
    return f"{'an' if word[0] in 'aeioAEIO' else 'a'} {word}"


def _listed(words: tuple[str, ...] | list[str]) -> str:
    return ", ".join(f"`{word}`" for word in words)


_LONGEST = 60


def _short(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 3]}..."
