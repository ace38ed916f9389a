"""What names stand for while a launch file in Python is read: modules, functions, and names that are looked up outward."""

from __future__ import annotations

import ast
import operator
import posixpath
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from archgen.plugin import dataclass as frozen_dataclass
from archgen.plugins.ros.launch.launch_values import OPEN, LaunchValue, Substitution, UnknownValue, join_values


@frozen_dataclass(frozen=True, slots=True)
class ImportedName:
    """A module, or something of one, by its dotted name."""

    name: str

    @property
    def last(self) -> str:
        """Its own name."""
        return self.name.rpartition(".")[2]


@dataclass(slots=True, eq=False)
class NameScope:
    """The names of a function or of the file."""

    outer: NameScope | None = None
    values: dict[str, LaunchValue] = field(default_factory=dict)
    returned: list[LaunchValue] = field(default_factory=list)
    """What may be returned, where a condition is not known."""

    def find(self, name: str) -> tuple[bool, LaunchValue]:
        """Return whether a name is known, and what it stands for."""
        scope: NameScope | None = self
        while scope is not None:
            if name in scope.values:
                return True, scope.values[name]
            scope = scope.outer
        return False, None


@dataclass(slots=True, eq=False)
class FunctionValue:
    """A function of the file, or of a module beside it: then `reader` knows that one's lines."""

    definition: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
    scope: NameScope
    reader: object


@dataclass(slots=True, eq=False)
class ModuleValue:
    """A module that lies beside the launch file."""

    name: str
    scope: NameScope


@dataclass(slots=True, eq=False)
class RecordValue:
    """An object that holds values by its attributes' names; what its methods, without arguments, give stands there, too."""

    values: dict[str, LaunchValue]
    methods: frozenset[str]


@dataclass(slots=True, eq=False)
class BoundMethod:
    """A method of a value."""

    owner: LaunchValue
    name: str


@dataclass(slots=True, eq=False)
class CallArguments:
    """The arguments of a call."""

    positional: list[LaunchValue]
    named: dict[str, LaunchValue]

    def get(self, position: int | None, *names: str) -> LaunchValue:
        """Return an argument by its place or by one of its names; None where it is absent."""
        if position is not None and position < len(self.positional):
            return self.positional[position]
        return next((self.named[name] for name in names if name in self.named), None)


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
