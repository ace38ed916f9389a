"""Files of properties as Ice reads them: the rules of `Ice::Properties`, from the manual of Ice 3.4 and later."""

from __future__ import annotations

_ESCAPED = "\\#="
_BLANKS = " \t\r"


def read_properties(text: str) -> dict[str, str]:
    """Return the properties of a file. Raise ValueError for a line that is neither one nor a comment, and for a key twice."""
    properties: dict[str, str] = {}
    for line in text.split("\n"):
        key, rest = _read_part(line, "#=")
        if not key and not rest:
            continue
        if not rest.startswith("="):
            msg = f"no property: {line!r}"
            raise ValueError(msg)
        value, _ = _read_part(rest[1:], "#")
        if key in properties:
            msg = f"a property twice: {key!r}"
            raise ValueError(msg)
        properties[key] = value
    return properties


def _read_part(text: str, ends: str) -> tuple[str, str]:
    """Return what stands before one of the characters that end it, without blanks around it, and the rest."""
    result, blanks, position = "", "", 0
    while position < len(text):
        character = text[position]
        following = text[position + 1 : position + 2]
        if character in ends:
            return result, "" if character == "#" else text[position:]
        if character == "\\" and following == " ":
            result, blanks = f"{result}{blanks} ", ""
            position += 1
        elif character in _BLANKS:
            blanks += character if result else ""
        else:
            is_escape = character == "\\" and following != "" and following in _ESCAPED
            position += is_escape
            result, blanks = f"{result}{blanks}{text[position]}", ""
        position += 1
    return result, ""
