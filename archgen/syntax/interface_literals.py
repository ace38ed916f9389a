"""Check literals in interface definitions: whether a text is a value of a builtin type, in ROS 1 or in ROS 2.

The two differ: ROS 1 reads integers in base ten only, `True` and `False` with capitals, and `byte` as signed.
"""

from __future__ import annotations

import re

from archgen.syntax.interface_types import FieldType

FLOAT_TYPES = frozenset({"float32", "float64"})
STRING_TYPES = frozenset({"string", "wstring"})
_INTEGER_BITS = {f"{sign}int{bits}": (sign == "u", bits) for sign in ("", "u") for bits in (8, 16, 32, 64)}
# The number of digits is bounded: int() takes time that grows with their square, and no type holds as many.
_INTEGER_PATTERNS = {
    "ROS 1": re.compile(r"[+-]?[0-9]{1,40}\Z", re.ASCII),
    "ROS 2": re.compile(r"[+-]?(?:[0-9]{1,40}|0[xX][0-9a-fA-F]{1,40}|0[oO][0-7]{1,40}|0[bB][01]{1,80})\Z", re.ASCII),
}
_QUOTED_STRING = re.compile(r"""(["'])((?:\\\1|(?!\1).)*)\1[ ]*,?""")
_BARE_STRING = re.compile(r"([^,\"'][^,]*),?")


def explain_bad_literal(type_name: str, text: str, bound: int | None, *, ros1: bool) -> str | None:
    """Return what is wrong with a value of a builtin type, or None. `bound` is the greatest length of a string."""
    if type_name in STRING_TYPES:
        return None if ros1 else _explain_bad_string(text, bound)
    if type_name == "bool":
        return _explain_bad_bool(text, ros1=ros1)
    if type_name in FLOAT_TYPES:
        return _explain_bad_float(text)
    return _explain_bad_integer(type_name, text, ros1=ros1)


def explain_bad_default(field_type: FieldType, text: str) -> str | None:
    """Return what is wrong with a field's default in ROS 2 (a literal, or an array of them in brackets), or None."""
    if not field_type.array:
        return explain_bad_literal(field_type.base, text, field_type.bound, ros1=False)
    if not (text.startswith("[") and text.endswith("]") and len(text) > 1):
        return "an array's value stands in brackets, as in `[1, 2]`"
    inner_text = text[1:-1]
    if field_type.base in STRING_TYPES:
        elements = _split_strings(inner_text)
        if elements is None:
            return "the strings of an array are separated by commas, and quotes are closed"
    else:
        elements = [element.strip() for element in inner_text.split(",")] if inner_text else []
    is_bounded = field_type.array.startswith("[<=")
    if (
        field_type.size is not None
        and len(elements) != field_type.size
        and not (is_bounded and len(elements) < field_type.size)
    ):
        return f"{len(elements)} values for an array of {'at most' if is_bounded else 'exactly'} {field_type.size}"
    reasons = (explain_bad_literal(field_type.base, element, field_type.bound, ros1=False) for element in elements)
    return next((reason for reason in reasons if reason), None)


def _split_strings(inner_text: str) -> list[str] | None:
    """Split a comma-separated list of strings, quoted or bare; None if it is malformed."""
    strings = list[str]()
    offset = 0
    while inner_text[offset:].strip(" "):
        offset += len(inner_text[offset:]) - len(inner_text[offset:].lstrip(" "))
        match = _QUOTED_STRING.match(inner_text, offset)
        bare_match = None if match else _BARE_STRING.match(inner_text, offset)
        if match:
            strings.append(match[2].replace("\\" + match[1], match[1]))
        elif bare_match:
            strings.append(bare_match[1].strip())
        else:
            return None
        offset = (match or bare_match).end()  # type: ignore[union-attr]  # one of the two matched
    return strings


def _explain_bad_string(text: str, bound: int | None) -> str | None:
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


def _explain_bad_bool(text: str, *, ros1: bool) -> str | None:
    if ros1:
        return (
            None
            if text in {"True", "False"} or _INTEGER_PATTERNS["ROS 1"].match(text)
            else "a bool is `True` or `False`"
        )
    return None if text.lower() in {"true", "false", "0", "1"} else "a bool is `true` or `false`"


def _explain_bad_float(text: str) -> str | None:
    try:
        float(text)
    except ValueError:
        return "a number is needed, with a point for the decimals"
    return None


def integer_limits(type_name: str, *, ros1: bool) -> tuple[int, int]:
    """Return the smallest and the largest value of an integer type; `char` is unsigned, `byte` only in ROS 2."""
    is_unsigned, bits = _INTEGER_BITS.get(type_name, (type_name == "char" or not ros1, 8))
    return (0, 2**bits - 1) if is_unsigned else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)


def _explain_bad_integer(type_name: str, text: str, *, ros1: bool) -> str | None:
    if not _INTEGER_PATTERNS["ROS 1" if ros1 else "ROS 2"].match(text):
        return "an integer is needed, in base ten" if ros1 else "an integer is needed"
    smallest, largest = integer_limits(type_name, ros1=ros1)
    sign, digits = text[: len(text) - len(text.lstrip("+-"))], text.lstrip("+-")
    # int(text, 0) understands 0x, 0o and 0b, but refuses a leading zero such as 007, which is base ten in ROS.
    value = int(digits) if digits.isdigit() else int(digits, 0)
    value = -value if sign == "-" else value
    return None if smallest <= value <= largest else f"{type_name} holds {smallest} to {largest}"
