"""Types and values of properties and parameters: what UML's primitive types and literals are in the language."""

from __future__ import annotations

import re
from decimal import Decimal, InvalidOperation

from archgen.plugin.importing import XmlElement
from archgen.plugins.xmi.import_ledger import OWN_PREFIX, name_conceptual_type
from archgen.plugins.xmi.uml_index import Reference, UmlIndex, get_id, get_kind

_PARAMETER_TYPES = {
    **dict.fromkeys(("boolean", "bool", "eboolean"), "boolean"),
    **dict.fromkeys(("string", "std::string", "char*", "qstring", "estring", "text"), "string"),
    **dict.fromkeys(("real", "float", "double", "float32", "float64", "efloat", "edouble", "long double"), "float"),
    **dict.fromkeys(("integer", "int", "long", "short", "unlimitednatural", "natural", "unsigned", "eint"), "integer"),
    **dict.fromkeys((f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)), "integer"),
    **dict.fromkeys((f"{sign}int{bits}_t" for sign in ("", "u") for bits in (8, 16, 32, 64)), "integer"),
    **dict.fromkeys(("unsigned int", "unsigned long", "long long", "size_t", "byte", "elong"), "integer"),
}
"""The type of a parameter, by what tools call it in small letters."""
_FIELD_TYPES = {"boolean": "bool", "string": "string", "float": "float64", "integer": "int64"}
_EXACT_FIELD_TYPES = frozenset(
    {
        "bool",
        "char",
        "float32",
        "float64",
        "wstring",
        *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)),
    }
)
_NARROW_FIELD_TYPES = {"float": "float32", "int": "int32", "short": "int16", "byte": "uint8"}
_BOUNDED_TEXT = re.compile(r"w?string<=[0-9]{1,9}\Z")
_NOTHING = frozenset({"void", "none", "nothing", ""})
_UNIT = re.compile(r"([0-9]+(?:\.[0-9]+)?)\s*(ns|us|ms|s|min|h|Hz|kHz)\Z")
_MAX_DIGITS = 15


def find_type_name(index: UmlIndex, element: XmlElement) -> str:
    """Return the name of the type of a property, port or parameter; empty where it says none."""
    reference = index.find_reference(element, "type")
    name = name_referenced(reference) if reference else ""
    return "" if name.lower() in _NOTHING else name


def name_referenced(reference: Reference) -> str:
    """Return the name of a type that something refers to, as the language writes it."""
    is_own = reference.element is not None and get_id(reference.element).startswith(OWN_PREFIX)
    # What archgen wrote is a name of the language: its brackets are generics.
    return reference.name if is_own else name_conceptual_type(reference.name)


def find_parameter_type(type_name: str) -> str | None:
    """Return what a parameter of a type of UML is in the language; None for what is no primitive type."""
    return _PARAMETER_TYPES.get(type_name.removeprefix("const ").removesuffix("&").strip().lower())


def find_field_type(type_name: str) -> str | None:
    """Return the type of a message's field for a primitive type of UML; None for what is none."""
    if type_name in _EXACT_FIELD_TYPES or _BOUNDED_TEXT.match(type_name):
        return type_name
    kind = find_parameter_type(type_name)
    return _NARROW_FIELD_TYPES.get(type_name.lower()) or _FIELD_TYPES.get(kind or "")


def is_many(element: XmlElement) -> bool:
    """Whether a property has more than one value."""
    return write_array(element) != ""


def write_array(element: XmlElement) -> str:
    """Return the brackets of an array for the multiplicity of a property: `[]`, `[3]`, `[<=5]`; empty for one value."""
    lower, upper = _read_bound(element, "lower"), _read_bound(element, "upper")
    if upper in {"*", "-1"}:
        return "[]"
    is_number = upper.isascii() and upper.isdigit() and len(upper) <= _MAX_DIGITS
    if not is_number or int(upper) < 2:  # noqa: PLR2004 - one is no array
        return ""
    return f"[{int(upper)}]" if lower == upper else f"[<={int(upper)}]"


def _read_bound(element: XmlElement, side: str) -> str:
    bound = element.find(f"{side}Value")
    # UML2 leaves out the value of a bound that is 0.
    written = bound.attributes.get("value", "0") if bound is not None else element.attributes.get(side, "1")
    return written.strip()


def read_default(index: UmlIndex, element: XmlElement) -> str | None:
    """Return the default of a property as text; None where it has none.

    A literal without a value has that of its kind: tools leave out `0`, `0.0` and `false`.
    """
    default = element.find("defaultValue")
    if default is None:
        return element.attributes.get("default")
    kind = get_kind(default)
    if kind == "InstanceValue":
        instance = index.find_reference(default, "instance")
        return (instance.name if instance else "") or None
    value = default.attributes.get("value") or default.attributes.get("body")
    if value is None:
        child = default.find("value") or default.find("body")
        value = child.text.strip() if child is not None else None
    absent = {"LiteralInteger": "0", "LiteralUnlimitedNatural": "0", "LiteralReal": "0.0", "LiteralBoolean": "false"}
    return absent.get(kind) if value is None else value


def convert_value(text: str, kind: str) -> object:
    """Return a default as a value of a parameter's type. Raise ValueError where it is none."""
    words = text.strip()
    if kind == "boolean":
        if words.lower() not in {"true", "false"}:
            raise ValueError(words)
        return words.lower() == "true"
    if kind == "string":
        has_quotes = len(words) > 1 and words[0] == words[-1] and words[0] in "\"'"
        return words[1:-1] if has_quotes else text
    if len(words) > _MAX_DIGITS + 10 or "_" in words or not words.isascii():
        # Python reads more than the tools write: `1_000`, digits of other scripts.
        raise ValueError(words)
    if kind == "integer":
        return int(words, 0) if words.lower().startswith("0x") else int(words)
    value = float(words.removesuffix("f"))
    if value - value != 0:
        raise ValueError(words)
    return value


def read_period(text: str) -> dict[str, object] | None:
    """Return `timing` for the default of a property `sample`: a number is in seconds, 0 is not periodic.

    None where the text is no period.
    """
    words = text.strip().strip("\"'")
    if found := _UNIT.match(words):
        key = "rate" if found[2].endswith("Hz") else "period"
        return {key: f"{found[1]} {found[2]}"} if Decimal(found[1]) else {}
    try:
        seconds = Decimal(words)
    except InvalidOperation:
        return None
    if not seconds.is_finite() or seconds < 0 or seconds > _LONGEST or seconds * 1_000_000_000 % 1:
        return None
    return {"period": write_whole_duration(seconds)} if seconds else {}


def write_whole_duration(seconds: Decimal) -> str:
    """Return a duration with the greatest unit in which it is whole, else in ns: `20 ms`."""
    for factor, unit in ((1, "s"), (1_000, "ms"), (1_000_000, "us")):
        if (amount := seconds * factor) == amount.to_integral_value():
            return f"{int(amount)} {unit}"
    return f"{int(seconds * 1_000_000_000)} ns"


_LONGEST = Decimal(86_400 * 365)
