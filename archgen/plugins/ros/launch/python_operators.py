"""What operators of Python make of values that are known, or are filled in at the launch."""

from __future__ import annotations

import ast
import operator
import posixpath
from collections.abc import Callable
from typing import Any

from archgen.plugins.ros.launch.launch_values import OPEN, LaunchValue, Substitution, UnknownValue, join_values

_MAX_NUMBER = 1e15
_NUMBERS = (int, float)
_TEXTS = (str, Substitution)
_COMPARISONS: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.In: lambda left, right: left in right,
    ast.NotIn: lambda left, right: left not in right,
    ast.Is: lambda left, right: left is right or left == right,
    ast.IsNot: lambda left, right: not (left is right or left == right),
}
_ARITHMETIC: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
}


def combine_values(  # noqa: PLR0911 - a kind of values each
    sign: ast.operator, left: LaunchValue, right: LaunchValue
) -> LaunchValue | None:
    """Return what an operator makes of two values; None where that is not known."""
    if isinstance(left, UnknownValue) or isinstance(right, UnknownValue):
        # A list stays a list: what is known of it counts.
        is_listed = isinstance(sign, ast.Add) and (isinstance(left, list | tuple) or isinstance(right, list | tuple))
        sides = [list(each) if isinstance(each, list | tuple) else [each] for each in (left, right)]
        return [*sides[0], *sides[1]] if is_listed else None
    if isinstance(sign, ast.Div) and isinstance(left, _TEXTS) and isinstance(right, _TEXTS):
        if isinstance(left, str) and isinstance(right, str):
            return posixpath.join(left, right)
        return Substitution("path", (left, right))
    if isinstance(sign, ast.Add) and isinstance(left, _TEXTS) and isinstance(right, _TEXTS):
        return join_values([left, right])
    if isinstance(sign, ast.Add) and isinstance(left, list | tuple) and isinstance(right, list | tuple):
        return [*left, *right]
    if isinstance(sign, ast.BitOr) and isinstance(left, dict) and isinstance(right, dict):
        return left | right
    if isinstance(sign, ast.Mod) and isinstance(left, str):
        return fill_text(left.split("%s"), list(right) if isinstance(right, tuple) else [right], "%")
    return calculate_number(sign, left, right)


def fill_text(pieces: list[str], values: list[LaunchValue], mark: str) -> LaunchValue | None:
    """Return a text with values between its pieces; None where another `mark` in it says how they are written."""
    fits = all(isinstance(value, str | int | float | Substitution) for value in values)
    if len(pieces) != len(values) + 1 or mark in "".join(pieces) or not fits:
        return None
    parts: list[LaunchValue] = [pieces[0]]
    for value, piece in zip(values, pieces[1:], strict=True):
        # In a text Python writes `True`, not `true`.
        parts += [str(value) if isinstance(value, bool) else value, piece]
    return join_values([part for part in parts if part != ""] or [""])


def calculate_number(sign: ast.operator, left: object, right: object) -> int | float | None:
    """Return a number that is calculated of two numbers; None for other values, and for numbers beyond all bounds."""
    calculate = _ARITHMETIC.get(type(sign))
    if calculate is None or not isinstance(left, int | float) or not isinstance(right, int | float):
        return None
    if not max(abs(left), abs(right)) < _MAX_NUMBER:
        return None
    try:
        found: int | float = calculate(left, right)
    except (ArithmeticError, ValueError):
        return None
    return found


def compare_values(sign: ast.cmpop, left: LaunchValue, right: LaunchValue) -> bool | None:
    """Return how two values compare; None where that is not known."""
    compare = _COMPARISONS.get(type(sign))
    if compare is None or any(map(is_open, (left, right))):
        return None
    try:
        return bool(compare(left, right))
    except TypeError:
        return None


def is_open(value: LaunchValue) -> bool:
    """Whether a value is not known here, or is more than a plain value or a list of such."""
    items = list(value) if isinstance(value, list | tuple | dict) else [value]
    return not all(
        item is None or isinstance(item, bool | int | float) or (isinstance(item, str) and OPEN not in item)
        for item in items
    )
