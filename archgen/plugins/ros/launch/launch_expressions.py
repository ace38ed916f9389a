"""Work out the short expressions of `$(eval ...)` and `PythonExpression` that are plain values, comparisons and arithmetic."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable

from archgen.plugins.ros.launch.launch_values import OPEN
from archgen.plugins.ros.launch.python_operators import calculate_number, compare_values
from archgen.plugins.ros.launch.python_parsing import parse_expression

PlainResult = bool | str | int | float | None
ArgumentLookup = Callable[[str], str | None]
_MAX_DEPTH = 40
_MAX_DIGITS = 30


def evaluate_expression(text: str, look_up: ArgumentLookup) -> PlainResult:
    """Return the value of an expression; None where only running it would tell. `look_up` knows arguments by name."""
    expression = None if OPEN in text else parse_expression(text)
    return None if expression is None else _evaluate_node(expression, look_up, 0)


def _evaluate_node(node: ast.expr, look_up: ArgumentLookup, depth: int) -> PlainResult:  # noqa: C901, PLR0911
    if depth > _MAX_DEPTH:
        return None
    match node:
        case ast.Constant(value=bool() | int() | float() | str() as value):
            return value
        case ast.Name(id="true" | "True"):
            return True
        case ast.Name(id="false" | "False"):
            return False
        case ast.Name(id=name) | ast.Call(func=ast.Name(id="arg"), args=[ast.Constant(value=str() as name)]):
            known = look_up(name)
            return None if known is None else _read_word(known)
        case ast.Call(func=ast.Name(id="int" | "float" | "str" as kind), args=[argument], keywords=[]):
            return _convert_value(kind, _evaluate_node(argument, look_up, depth + 1))
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return calculate_number(ast.Sub(), 0, _evaluate_node(operand, look_up, depth + 1))
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            found = _evaluate_node(operand, look_up, depth + 1)
            return None if found is None else not found
        case ast.BoolOp(op=joint, values=values):
            return _join_verdicts(joint, [_evaluate_node(value, look_up, depth + 1) for value in values])
        case ast.IfExp(test=test, body=body, orelse=other):
            verdict = _evaluate_node(test, look_up, depth + 1)
            return None if verdict is None else _evaluate_node(body if verdict else other, look_up, depth + 1)
        case ast.BinOp(left=left, op=sign, right=right):
            return _calculate(sign, *(_evaluate_node(side, look_up, depth + 1) for side in (left, right)))
        case ast.Compare(left=left, ops=[comparison], comparators=[right]):
            sides = [_evaluate_node(side, look_up, depth + 1) for side in (left, right)]
            return None if None in sides else compare_values(comparison, *sides)
    return None


def _join_verdicts(joint: ast.boolop, values: list[PlainResult]) -> bool | None:
    decisive = isinstance(joint, ast.Or)
    if any(value is not None and bool(value) == decisive for value in values):
        return decisive
    return None if None in values else not decisive


def _calculate(sign: ast.operator, left: PlainResult, right: PlainResult) -> str | int | float | None:
    if isinstance(left, str) and isinstance(right, str):
        return left + right if isinstance(sign, ast.Add) else None
    return calculate_number(sign, left, right)


def _convert_value(kind: str, value: PlainResult) -> PlainResult:
    if value is None or kind == "str":
        return None if value is None else str(value)
    try:
        number = float(value) if len(str(value)) < _MAX_DIGITS else None
    except ValueError:
        return None
    if number is None or kind == "float":
        return number
    # As Python has it: a text with a point is no whole number.
    is_whole = not isinstance(value, str) or value.strip().lstrip("+-").isdecimal()
    return int(value) if is_whole and math.isfinite(number) else None


def _read_word(text: str) -> bool | str | int | float:
    word = text.strip().lower()
    if word in {"true", "false"}:
        return word == "true"
    for kind in (int, float):
        try:
            return kind(text) if len(text) < _MAX_DIGITS else text
        except ValueError:
            continue
    return text
