"""Check literals in interface definitions: whether a text is a value of a builtin type, in ROS 1 or in ROS 2.

The two differ: ROS 1 reads integers in base ten only, `True` and `False` with capitals, and `byte` as signed.
"""

from __future__ import annotations

import re

from archgen.syntax.interface_types import FieldType

FLOATS = frozenset({"float32", "float64"})
STRINGS = frozenset({"string", "wstring"})
_BITS = {f"{sign}int{bits}": (sign == "u", bits) for sign in ("", "u") for bits in (8, 16, 32, 64)}
# The number of digits is bounded: int() takes time that grows with their square, and no type holds as many.
_INTEGER = {
    "ROS 1": re.compile(r"[+-]?[0-9]{1,40}\Z", re.ASCII),
    "ROS 2": re.compile(r"[+-]?(?:[0-9]{1,40}|0[xX][0-9a-fA-F]{1,40}|0[oO][0-7]{1,40}|0[bB][01]{1,80})\Z", re.ASCII),
}
_QUOTED = re.compile(r"""(["'])((?:\\\1|(?!\1).)*)\1[ ]*,?""")
_BARE = re.compile(r"([^,\"'][^,]*),?")


def complaint(type_: str, text: str, bound: int | None, *, ros1: bool) -> str | None:
    """Return what is wrong with a value of a builtin type, or None. `bound` is the greatest length of a string."""
    if type_ in STRINGS:
        return None if ros1 else _string(text, bound)
    if type_ == "bool":
        return _bool(text, ros1=ros1)
    if type_ in FLOATS:
        return _float(text)
    return _integer(type_, text, ros1=ros1)


def default_complaint(type_: FieldType, text: str) -> str | None:
    """Return what is wrong with a field's default in ROS 2 (a literal, or an array of them in brackets), or None."""
    if not type_.array:
        return complaint(type_.base, text, type_.bound, ros1=False)
    if not (text.startswith("[") and text.endswith("]") and len(text) > 1):
        return "an array's value stands in brackets, as in `[1, 2]`"
    inner = text[1:-1]
    if type_.base in STRINGS:
        elements = _strings(inner)
        if elements is None:
            return "the strings of an array are separated by commas, and quotes are closed"
    else:
        elements = [element.strip() for element in inner.split(",")] if inner else []
    bounded = type_.array.startswith("[<=")
    if type_.size is not None and len(elements) != type_.size and not (bounded and len(elements) < type_.size):
        return f"{len(elements)} values for an array of {'at most' if bounded else 'exactly'} {type_.size}"
    reasons = (complaint(type_.base, element, type_.bound, ros1=False) for element in elements)
    return next((reason for reason in reasons if reason), None)


def _strings(inner: str) -> list[str] | None:
    """Split a comma-separated list of strings, quoted or bare; None if it is malformed."""
    found = list[str]()
    place = 0
    while inner[place:].strip(" "):
        place += len(inner[place:]) - len(inner[place:].lstrip(" "))
        match = _QUOTED.match(inner, place)
        bare = None if match else _BARE.match(inner, place)
        if match:
            found.append(match[2].replace("\\" + match[1], match[1]))
        elif bare:
            found.append(bare[1].strip())
        else:
            return None
        place = (match or bare).end()  # type: ignore[union-attr]  # one of the two matched
    return found


def _string(text: str, bound: int | None) -> str | None:
    # As rosidl_adapter reads it: quotes are optional, and only the kind that encloses the text must be escaped in it.
    for quote in "\"'":
        if text.startswith(quote) and text.endswith(quote):
            text = text[1:-1]
            if re.search(rf"(?<!\\){quote}", text):
                return f"a quote inside is written `\\{quote}`"
            text = text.replace("\\" + quote, quote)
            break
    if bound is not None and len(text) > bound:
        return f"{len(text)} characters for a string of at most {bound}"
    return None


def _bool(text: str, *, ros1: bool) -> str | None:
    if ros1:
        return None if text in {"True", "False"} or _INTEGER["ROS 1"].match(text) else "a bool is `True` or `False`"
    return None if text.lower() in {"true", "false", "0", "1"} else "a bool is `true` or `false`"


def _float(text: str) -> str | None:
    try:
        float(text)
    except ValueError:
        return "a number is needed, with a point for the decimals"
    return None


def limits(type_: str, *, ros1: bool) -> tuple[int, int]:
    """Return the smallest and the largest value of an integer type; `char` is unsigned, `byte` only in ROS 2."""
    unsigned, bits = _BITS.get(type_, (type_ == "char" or not ros1, 8))
    return (0, 2**bits - 1) if unsigned else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)


def _integer(type_: str, text: str, *, ros1: bool) -> str | None:
    if not _INTEGER["ROS 1" if ros1 else "ROS 2"].match(text):
        return "an integer is needed, in base ten" if ros1 else "an integer is needed"
    smallest, largest = limits(type_, ros1=ros1)
    sign, digits = text[: len(text) - len(text.lstrip("+-"))], text.lstrip("+-")
    # int(text, 0) understands 0x, 0o and 0b, but refuses a leading zero such as 007, which is base ten in ROS.
    value = int(digits) if digits.isdigit() else int(digits, 0)
    value = -value if sign == "-" else value
    return None if smallest <= value <= largest else f"{type_} holds {smallest} to {largest}"
