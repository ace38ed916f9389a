"""Values that are no records, as three middlewares have them, and the words that others have for them."""

from __future__ import annotations

from collections.abc import Mapping

PRIMITIVES: Mapping[str, tuple[str, str, str, str]] = {
    "bool": ("truth", "bool", "boolean", "Boolean"),
    "byte": ("whole", "std::uint8_t", "octet", "Octet"),
    "char": ("whole", "std::uint8_t", "octet", "Octet"),
    "uint8": ("whole", "std::uint8_t", "octet", "Octet"),
    "int8": ("whole", "std::int8_t", "short", "Short"),
    "int16": ("whole", "std::int16_t", "short", "Short"),
    "uint16": ("whole", "std::uint16_t", "unsigned short", "UShort"),
    "int32": ("whole", "std::int32_t", "long", "Long"),
    "uint32": ("whole", "std::uint32_t", "unsigned long", "ULong"),
    "int64": ("whole", "std::int64_t", "long long", "LongLong"),
    "uint64": ("whole", "std::uint64_t", "unsigned long long", "ULongLong"),
    "time": ("whole", "std::int64_t", "long long", "LongLong"),
    "duration": ("whole", "std::int64_t", "long long", "LongLong"),
    "float32": ("number", "float", "float", "Float"),
    "float64": ("number", "double", "double", "Double"),
    "string": ("text", "std::string", "string", "String"),
    "wstring": ("text", "std::string", "string", "String"),
}
"""What values are that are no records: their kind, and what C++, IDL and the mapping of IDL call them."""
ALIASES = {
    **dict.fromkeys(("double", "real", "edouble"), "float64"),
    **dict.fromkeys(("float", "efloat"), "float32"),
    **dict.fromkeys(("int", "integer", "eint"), "int32"),
    **dict.fromkeys(("boolean", "eboolean"), "bool"),
    **dict.fromkeys(("text", "estring"), "string"),
    "long": "int64",
    "short": "int16",
    "octet": "uint8",
    "unlimitednatural": "uint32",
}
"""What UML and programming languages call such values."""
