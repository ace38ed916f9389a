"""Resolve unquoted scalars by YAML 1.2's core schema, so that `no`, `on` and `1:30` are text.

PyYAML's own resolver follows YAML 1.1, where these are False, True and 90.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from archgen.syntax.yaml_tree import PlainValue

MAX_DIGITS = 30
"""Longer integers stay text: no element needs them, and converting them takes time that grows with their square."""
NON_TEXT_STARTS = frozenset("0123456789+-.~nNtTfF")
"""The characters that a scalar other than text can begin with; `resolve_scalar` is not called for any other."""
_SPECIAL_WORDS: dict[str, PlainValue] = {
    "~": None,
    **dict.fromkeys(("null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), math.inf),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), -math.inf),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), math.nan),
}
_NUMBER_PATTERN = re.compile(
    r"(?P<int>[-+]?[0-9]+)|0o(?P<oct>[0-7]+)|0x(?P<hex>[0-9a-fA-F]+)"
    r"|(?P<float>[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?)"
)
_NUMBER_BASES = {"int": 10, "oct": 8, "hex": 16}


def resolve_scalar(text: str) -> PlainValue:
    """Return the value of a plain scalar, which must not be empty."""
    if text in _SPECIAL_WORDS:
        return _SPECIAL_WORDS[text]
    match = _NUMBER_PATTERN.fullmatch(text)
    if match is None:
        return text
    if match.lastgroup == "float":
        number = float(text)
        # 1e999 would be infinite though nobody wrote .inf: it stays text, and the schema then refuses it.
        return number if math.isfinite(number) else text
    base = _NUMBER_BASES[match.lastgroup or "int"]
    return int(match[match.lastgroup or "int"], base) if len(text) <= MAX_DIGITS else text
