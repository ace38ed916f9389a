"""Check literals in interface definitions: whether a text is a value of a builtin type, in ROS 1 or in ROS 2.

The two differ: ROS 1 reads integers in base ten only, `True` and `False` with capitals, and `byte` as signed.

Read the type of a field in an interface definition: builtin or a message, perhaps bounded, perhaps an array.
"""

from __future__ import annotations

import re

from archgen.diagnostics import did_you_mean
from archgen.frozen import NamedTuple, dataclass

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


_NUMBER_TYPES = ("float32", "float64", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)))
# Types whose values can be written as text; time, duration and messages can have neither constants nor defaults.
_LITERAL_TYPES = frozenset({"bool", "byte", "char", "string", *_NUMBER_TYPES})
# Names without a package that stand for a message; the key says whether the grammar is that of ROS 1.
_TYPE_ALIASES = {
    True: {"Header": "std_msgs/msg/Header"},
    False: {"time": "builtin_interfaces/msg/Time", "duration": "builtin_interfaces/msg/Duration"},
}
# Types of C, Protocol Buffers and other languages that people write by habit.
_FOREIGN_TYPES = {"float": "float32", "double": "float64", "int": "int32", "uint": "uint32", "boolean": "bool"}
_ARRAY_SIZE = re.compile(r"\[(?:(<=)?([0-9]{1,19}))?\]\Z", re.ASCII)
_BOUNDED_STRING = re.compile(r"(w?string)<=([0-9]{1,19})\Z", re.ASCII)
# The two patterns of rosidl_adapter for the names of packages and messages. `Sample_` and the suffixes of generated
# messages are the only underscores that ROS 2 allows in a message's name.
_PACKAGE_NAME = re.compile(r"[a-z](?:_?[a-z0-9])*\Z", re.ASCII)
_MESSAGE_NAME = re.compile(r"(?:Sample_)?[A-Z][A-Za-z0-9]*(?:_(?:Request|Response|Goal|Result|Feedback))*\Z", re.ASCII)
# genmsg allows nearly anything.
_ROS1_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z", re.ASCII)


class TypeComplaint(NamedTuple):
    """What is wrong with a type, and what to write instead."""

    message: str
    help: str | None = None


@dataclass(frozen=True, slots=True)
class FieldType:
    """A field's type. `base` is the builtin type or a message's full name; `bound` is the greatest length of a string.

    `array` is the brackets as written, empty for a single value; `size` is the number in them: 3 for `[3]` and `[<=3]`,
    None for `[]`.
    """

    base: str
    is_builtin: bool
    bound: int | None = None
    array: str = ""
    size: int | None = None

    @property
    def name(self) -> str:
        """The type of one element: `string<=10`, `geometry_msgs/msg/Pose`."""
        return self.base if self.bound is None else f"{self.base}<={self.bound}"


def list_literal_types(*, ros1: bool) -> frozenset[str]:
    """Return the builtin types whose values can be written as literals: those that a constant may have."""
    return _LITERAL_TYPES if ros1 else _LITERAL_TYPES | {"wstring"}


def read_field_type(text: str, package: str, *, ros1: bool) -> FieldType | TypeComplaint:
    """Read a type as it is written in a definition of `package`, or say what is wrong with it."""
    bracket_index = text.find("[")
    base, array = (text, "") if bracket_index < 0 else (text[:bracket_index], text[bracket_index:])
    size_match = _ARRAY_SIZE.match(array) if array else None
    # ROS 1 knows no `[<=3]` but allows `[0]`; in ROS 2 it is the other way round.
    if array and (
        size_match is None or (size_match[1] and ros1) or (size_match[2] and not int(size_match[2]) and not ros1)
    ):
        return _explain_bad_array(array, ros1=ros1)
    if ros1 and array and base == "Header":
        element_type: FieldType | TypeComplaint = _read_message_type(
            base, package, ros1=ros1
        )  # only `Header` alone is special
    else:
        element_type = _read_element_type(base, package, ros1=ros1)
    if isinstance(element_type, TypeComplaint) or size_match is None:
        return element_type
    return FieldType(
        element_type.base,
        element_type.is_builtin,
        element_type.bound,
        array,
        int(size_match[2]) if size_match[2] else None,
    )


def _explain_bad_array(array: str, *, ros1: bool) -> TypeComplaint:
    if array.count("[") > 1 and array.endswith("]"):
        return TypeComplaint("arrays have one dimension only", "put the inner array into a message of its own")
    forms = "`[]` or `[3]`" if ros1 else "`[]`, `[3]` or `[<=3]`"
    return TypeComplaint(f"`{array}` is no size of an array", f"an array is written {forms}")


def _read_element_type(text: str, package: str, *, ros1: bool) -> FieldType | TypeComplaint:
    if text in list_literal_types(ros1=ros1) or (ros1 and text in {"time", "duration"}):
        return FieldType(text, is_builtin=True)
    if text in _TYPE_ALIASES[ros1]:
        return FieldType(_TYPE_ALIASES[ros1][text], is_builtin=False)
    if "<=" in text:
        return _read_bounded_string(text, ros1=ros1)
    if text in _FOREIGN_TYPES:
        return TypeComplaint(f"there is no type `{text}` in ROS", f"did you mean `{_FOREIGN_TYPES[text]}`?")
    return _read_message_type(text, package, ros1=ros1)


def _read_bounded_string(text: str, *, ros1: bool) -> FieldType | TypeComplaint:
    match = _BOUNDED_STRING.match(text)
    if ros1:
        return TypeComplaint("ROS 1 has no bounded strings", "write `string`")
    if match is None or not int(match[2]):
        return TypeComplaint(f"`{text}` is no bounded string", "it is written `string<=10`, with a length above 0")
    return FieldType(match[1], is_builtin=True, bound=int(match[2]))


def _read_message_type(text: str, package: str, *, ros1: bool) -> FieldType | TypeComplaint:
    """Resolve `Name` and `package/Name` to the full name `package/msg/Name`."""
    parts = text.split("/")
    if len(parts) == 3 and parts[1] == "msg":  # noqa: PLR2004  # pkg/msg/Name
        return TypeComplaint(
            f"inside definitions a message has two parts, not `{text}`", f"write `{parts[0]}/{parts[2]}`"
        )
    if len(parts) == 1:
        parts = [package, text]
    if len(parts) == 2 and _is_message_name(*parts, ros1=ros1):  # noqa: PLR2004  # pkg/Name
        return FieldType(f"{parts[0]}/msg/{parts[1]}", is_builtin=False)
    type_names = {*list_literal_types(ros1=ros1), "time", "duration"}
    form = "`Name` or `package/Name`" if ros1 else "`Name` or `package/Name`, letters and digits, a capital first"
    return TypeComplaint(f"`{text}` is no type", did_you_mean(text, type_names) or f"a message is written {form}")


def _is_message_name(package: str, name: str, *, ros1: bool) -> bool:
    if ros1:
        return bool(_ROS1_NAME.match(package) and _ROS1_NAME.match(name))
    return bool(_PACKAGE_NAME.match(package) and _MESSAGE_NAME.match(name))
