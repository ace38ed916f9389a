"""What is set while a launch file is walked through: arguments, namespace, remaps, parameters; and what values become by it.

Work out the short expressions of `$(eval ...)` and `PythonExpression` that are plain values, comparisons and
arithmetic.
"""

from __future__ import annotations

import ast
import math
import posixpath
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field
from typing import Any

from archgen.plugin.importing import WorkBudget
from archgen.plugins.ros.launch.launch_entities import LaunchCondition
from archgen.plugins.ros.launch.launch_values import (
    MAX_TEXT,
    OPEN,
    VERY_LONG,
    LaunchValue,
    Substitution,
    UnknownValue,
    describe_launch_value,
    is_plain,
    name_object,
    write_plain,
)
from archgen.plugins.ros.launch.python_parsing import parse_expression
from archgen.plugins.ros.launch.python_values import calculate_number, compare_values, is_open

PlainResult = bool | str | int | float | list[Any] | None
ArgumentLookup = Callable[[str], str | None]
_MAX_DIGITS = 30
_TEXT_METHODS = frozenset({"lower", "upper", "strip", "lstrip", "rstrip", "title", "startswith", "endswith"})


def evaluate_expression(text: str, look_up: ArgumentLookup) -> PlainResult:
    """Return the value of an expression; None where only running it would tell. `look_up` knows arguments by name.

    A text that is filled in at the launch may be what comes of it; nothing is concluded from it.
    """
    expression = parse_expression(text)
    return None if expression is None else _evaluate_node(expression, look_up, 0)


def _evaluate_node(node: ast.expr, look_up: ArgumentLookup, depth: int) -> PlainResult:  # noqa: C901, PLR0911, PLR0912
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
        case ast.Attribute(value=ast.Name(id="math"), attr="pi" | "tau" | "e" as name):
            constant: float = getattr(math, name)
            return constant
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return calculate_number(ast.Sub(), 0, _evaluate_node(operand, look_up, depth + 1))
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            verdict = _judge_truth(_evaluate_node(operand, look_up, depth + 1))
            return None if verdict is None else not verdict
        case ast.BoolOp(op=joint, values=values):
            return _join_verdicts(joint, [_judge_truth(_evaluate_node(value, look_up, depth + 1)) for value in values])
        case ast.IfExp(test=test, body=body, orelse=other):
            verdict = _judge_truth(_evaluate_node(test, look_up, depth + 1))
            return None if verdict is None else _evaluate_node(body if verdict else other, look_up, depth + 1)
        case ast.BinOp(left=left, op=sign, right=right):
            return _calculate(sign, *(_evaluate_node(side, look_up, depth + 1) for side in (left, right)))
        case ast.Compare(left=left, ops=[comparison], comparators=[right]):
            sides = [_evaluate_node(side, look_up, depth + 1) for side in (left, right)]
            return None if None in sides else compare_values(comparison, *sides)
        case ast.Call(func=ast.Attribute(value=owner, attr=name), args=arguments, keywords=[]) if name in _TEXT_METHODS:
            texts = [_evaluate_node(each, look_up, depth + 1) for each in (owner, *arguments)]
            return _call_text_method(name, texts)
        case ast.List(elts=items) | ast.Tuple(elts=items):
            listed = [_evaluate_node(each, look_up, depth + 1) for each in items]
            return None if None in listed else listed
        case ast.Subscript(value=ast.Dict(keys=keys, values=items), slice=place):
            names = [None if key is None else _evaluate_node(key, look_up, depth + 1) for key in keys]
            wanted = _evaluate_node(place, look_up, depth + 1)
            is_known = None not in [wanted, *names] and not is_open([wanted, *names])
            chosen = next((each for name, each in zip(names, items, strict=True) if is_known and name == wanted), None)
            return None if chosen is None else _evaluate_node(chosen, look_up, depth + 1)
    return None


def _judge_truth(value: PlainResult) -> bool | None:
    return None if value is None or is_open(value) else bool(value)


def _join_verdicts(joint: ast.boolop, verdicts: list[bool | None]) -> bool | None:
    decisive = isinstance(joint, ast.Or)
    if decisive in verdicts:
        return decisive
    return None if None in verdicts else not decisive


def _call_text_method(name: str, texts: Sequence[PlainResult]) -> PlainResult:
    if not all(isinstance(text, str) and OPEN not in text for text in texts):
        return None
    try:
        result: PlainResult = getattr(texts[0], name)(*texts[1:])
    except TypeError:  # an argument too few, or too many
        return None
    return result


def _calculate(sign: ast.operator, left: PlainResult, right: PlainResult) -> str | int | float | None:
    if isinstance(left, str) and isinstance(right, str):
        return left + right if isinstance(sign, ast.Add) else None
    return calculate_number(sign, left, right)


def _convert_value(kind: str, value: PlainResult) -> PlainResult:
    if value is None or isinstance(value, list):
        return None
    if kind == "str":
        return str(value)
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


_TRUE_WORDS = frozenset({"true", "1", "yes", "on"})
_FALSE_WORDS = frozenset({"false", "0", "no", "off", ""})
_MAX_DEPTH = 40


@dataclass(slots=True)
class LaunchScope:
    """What a group takes back at its end."""

    configurations: dict[str, LaunchValue] = field(default_factory=dict)
    """Values of arguments: text, or what only running it would tell."""
    namespace: str | UnknownValue = ""
    remaps: tuple[tuple[str, str], ...] = ()
    parameters: tuple[LaunchValue, ...] = ()
    """Parameters for all nodes, in the order in which they are set: mappings, and files."""
    environment: Mapping[str, str] = field(default_factory=dict)
    conditions: tuple[tuple[str, bool | None], ...] = ()
    """The conditions around, as words, each with its verdict by the defaults."""


class LaunchContext:
    """The scope at the place that is walked through. `used` are the arguments that were filled in since it was emptied."""

    def __init__(self, budget: WorkBudget) -> None:
        self.budget = budget
        self.scope = LaunchScope()
        self.is_ros_1 = False
        self.used: dict[str, str] = {}
        self.environment: Mapping[str, str] = {}
        """Variables of the environment in which the launch file is started, as far as they were given."""
        self.asked: set[str] = set()
        """The arguments that ROS 2 was asked for, which needs no declaration of them."""
        self._scopes: list[LaunchScope] = []

    def push(self, *, keeps_others: bool = True) -> None:
        """Begin a scope, with the arguments of the one around it or without."""
        self._scopes.append(self.scope)
        self.scope = copy(self.scope)
        self.scope.configurations = dict(self.scope.configurations) if keeps_others else {}

    def pop(self) -> None:
        """End a scope."""
        self.scope = self._scopes.pop()

    def resolve(self, value: LaunchValue, depth: int = 0) -> str | UnknownValue:
        """Return a value as text, with arguments filled in; `$(...)` stays for what only the robot knows."""
        # One value may stand in another one many times over.
        if depth > _MAX_DEPTH or not self.budget.pay():
            return UnknownValue("values nested very deep")
        if isinstance(value, str | UnknownValue):
            return value
        if isinstance(value, Substitution):
            return self._resolve_substitution(value, depth + 1)
        if isinstance(value, list | tuple):
            return self._join(value, depth + 1)
        if isinstance(value, Mapping):
            return UnknownValue("a mapping where a text is expected")
        return write_plain(value) if is_plain(value) else name_object(value)

    def _join(self, parts: Sequence[LaunchValue], depth: int, *, is_path: bool = False) -> str | UnknownValue:
        texts: list[str] = []
        for part in parts:
            text = self.resolve(part, depth)
            if isinstance(text, UnknownValue):
                return text
            texts.append(text)
        if sum(map(len, texts)) > MAX_TEXT:
            return VERY_LONG
        # As os.path.join has it: an absolute part begins anew, an empty one adds nothing.
        return posixpath.join("", *texts) if is_path else "".join(texts)

    def _resolve_substitution(self, value: Substitution, depth: int) -> str | UnknownValue:  # noqa: PLR0911 - a kind each
        match value.kind:
            case "join":
                return self._join(value.parts, depth)
            case "path":
                return self._join(value.parts, depth, is_path=True)
            case "typed" | "text_of":
                return self.resolve(value.parts[0], depth)
            case "var":
                return self._resolve_argument(value, depth)
            case "share" | "prefix":
                package = self.resolve(value.parts[0], depth)
                word = "find" if self.is_ros_1 else f"find-pkg-{value.kind}"
                return package if isinstance(package, UnknownValue) else f"$({word} {package})"
            case "env":
                return self._resolve_variable(value, depth)
            case "eval":
                return self._evaluate(value.parts[0], depth)
            case "not" | "and" | "or" | "equals" | "differs":
                verdict = self.judge(value, depth)
                return UnknownValue(describe_launch_value(value)) if verdict is None else write_plain(verdict)
            case kind:
                return self._join(
                    [f"$({kind}", *(f" {describe_launch_value(part)}" for part in value.parts), ")"], depth
                )

    def _resolve_argument(self, value: Substitution, depth: int) -> str | UnknownValue:
        name = self.resolve(value.parts[0], depth)
        if isinstance(name, UnknownValue):
            return name
        word = "arg" if self.is_ros_1 else "var"
        if not self.is_ros_1:
            self.asked.add(name)
        known = self.scope.configurations.get(name, value.parts[1] if len(value.parts) > 1 else None)
        if known is None:
            self.used[name] = ""
            return f"$({word} {name})"
        text = self.resolve(known, depth)
        if isinstance(text, str):
            self.used[name] = text
        return text

    def _resolve_variable(self, value: Substitution, depth: int) -> str | UnknownValue:
        name = self.resolve(value.parts[0], depth)
        if isinstance(name, UnknownValue):
            return name
        own = self.scope.environment.get(name, self.environment.get(name))
        if own is not None:
            return own
        if len(value.parts) > 1 and value.parts[1] is not None:
            return self.resolve(value.parts[1], depth)
        return f"$(env {name})"

    def _evaluate(self, expression: LaunchValue, depth: int) -> str | UnknownValue:
        """Return what an expression of Python comes to, if it is one of comparisons, `and`, `or`, `not` and plain values."""
        text = self.resolve(expression, depth)
        if isinstance(text, UnknownValue):
            return text
        found = evaluate_expression(text, self._look_up)
        # As Python writes it: `True`, which a comparison with another expression's outcome needs.
        return str(found) if found is not None else UnknownValue(f"$(eval {describe_launch_value(expression)})")

    def _look_up(self, name: str) -> str | None:
        """Return the value of an argument that an expression of ROS 1 names; None where it is not known."""
        known = self.resolve(Substitution("var", (name,)), 1) if self.is_ros_1 else None
        return known if isinstance(known, str) and OPEN not in known else None

    def judge(self, value: LaunchValue, depth: int = 0) -> bool | None:
        """Return whether a value counts as true; None where only running it would tell."""
        if depth > _MAX_DEPTH:
            return None
        if isinstance(value, bool):
            return value
        if isinstance(value, Substitution) and value.kind in {"not", "and", "or", "equals", "differs"}:
            return self._judge_operation(value, depth + 1)
        text = self.resolve(value, depth + 1)
        if isinstance(text, UnknownValue) or OPEN in text:
            return None
        word = text.strip().lower()
        return True if word in _TRUE_WORDS else False if word in _FALSE_WORDS else None

    def _judge_operation(self, value: Substitution, depth: int) -> bool | None:
        if value.kind in {"equals", "differs"}:
            left, right = (self.resolve(part, depth) for part in value.parts[:2])
            if isinstance(left, UnknownValue) or isinstance(right, UnknownValue) or OPEN in left + right:
                return None
            return (left.strip() == right.strip()) == (value.kind == "equals")
        verdicts = [self.judge(part, depth) for part in value.parts]
        if value.kind == "not":
            return None if verdicts[0] is None else not verdicts[0]
        decisive = value.kind == "or"
        if decisive in verdicts:
            return decisive
        return None if None in verdicts else not decisive

    def judge_condition(self, condition: LaunchCondition) -> tuple[str, bool | None]:
        """Return a condition as words, and whether it holds by the defaults."""
        verdict = self.judge(condition.value)
        if condition.is_negated:
            verdict = None if verdict is None else not verdict
        word = "unless" if condition.is_negated else "if"
        return f"{word} {describe_launch_value(condition.value)}", verdict
