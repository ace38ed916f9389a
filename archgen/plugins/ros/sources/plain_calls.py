"""What operators and functions of the languages themselves give, of values that are known."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from types import MappingProxyType

from archgen.plugins.ros.sources.walk_values import Value, WalkedObject, join_texts, settle

MAX_ITEMS = 64
"""How many items of a list are walked through."""
_MAX_COMPARED = 1000
_COMPARISONS: Mapping[str, Callable[[Value, Value], Value]] = MappingProxyType(
    {
        "==": operator.eq,
        "!=": operator.ne,
        ">": operator.gt,
        "<": operator.lt,
        ">=": operator.ge,
        "<=": operator.le,
        "in": lambda left, right: left in right,
        "not in": lambda left, right: left not in right,
    }
)
_ARITHMETIC: Mapping[str, Callable[[Value, Value], Value]] = MappingProxyType(
    {"/": operator.truediv, "*": operator.mul, "-": operator.sub}
)
OPERATORS = frozenset({*_COMPARISONS, *_ARITHMETIC, "and", "or", "not", "%"})
_PLAIN = (str, int, float, list, dict, type(None))


def judge(value: Value) -> bool | None:
    """Return whether a value counts as true; None where that is not known."""
    settled = settle(value)
    return bool(settled) if isinstance(settled, _PLAIN) else None


def list_items(value: Value) -> list[Value] | None:
    """Return what a loop over a value takes; None where that is not known."""
    settled = settle(value)
    return settled if isinstance(settled, list) else list(settled) if isinstance(settled, dict) else None


def operate(sign: str, values: Sequence[Value]) -> Value:  # noqa: PLR0911 - a kind of operators each
    """Return what an operator makes of values; NotImplemented where that is not known."""
    verdicts = [judge(each) for each in values]
    if sign == "not":
        return NotImplemented if verdicts[0] is None else not verdicts[0]
    if sign in {"and", "or"}:
        decisive = sign == "or"
        if decisive in verdicts:
            return values[verdicts.index(decisive)] if decisive and verdicts[0] is not None else decisive
        return NotImplemented if None in verdicts else values[-1]
    if len(values) == 1:
        return NotImplemented
    left, right = (settle(each) for each in values)
    if sign == "%" and isinstance(left, str):
        return fill_text(left, "%s", right if isinstance(right, list) else values[1:])
    if sign == "/" and isinstance(left, str):
        return join_texts([values[0], "/", values[1]])
    is_number = sign not in _COMPARISONS
    if not is_number and (_count_leaves(left) > _MAX_COMPARED or _count_leaves(right) > _MAX_COMPARED):
        return NotImplemented
    if sign == "%" or not all(isinstance(each, int | float if is_number else _PLAIN) for each in (left, right)):
        return NotImplemented
    try:
        return (_ARITHMETIC if is_number else _COMPARISONS)[sign](left, right)
    except (TypeError, ArithmeticError):
        return NotImplemented


def _count_leaves(value: Value) -> int:
    """Return how many values lists and mappings hold that may stand in one another many times over; some more than counts."""
    count, pending = 0, [value]
    while pending and count <= _MAX_COMPARED:
        each = pending.pop()
        count += 1
        pending += each.values() if isinstance(each, dict) else each if isinstance(each, list) else ()
    return count


def add_up(values: Sequence[Value]) -> Value:
    """Return what `+` makes of values; NotImplemented where it is longer than anybody writes."""
    settled = [settle(each) for each in values]
    if all(isinstance(each, int | float) for each in settled):
        return reduce(operator.add, settled, 0)
    if all(isinstance(each, list) for each in settled):
        return [item for each in settled for item in each][:MAX_ITEMS]
    return join_texts(values)


def fill_text(text: str, mark: str, values: Sequence[Value]) -> Value:
    """Return a text with values at its marks; NotImplemented where something else says how they are written."""
    pieces = text.split(mark)
    if len(pieces) != len(values) + 1 or mark[0] in "".join(pieces):
        return NotImplemented
    return join_texts([part for piece, value in zip(pieces, [*values, ""], strict=True) for part in (piece, value)])


def call_plainly(whole: Value, name: str, arguments: Sequence[Value]) -> Value:
    """Return what a method of a plain value gives, or a function of Python; NotImplemented where that is not known."""
    settled = settle(whole)
    kind = next((each for each in (str, dict, list) if isinstance(settled, each)), None)
    known = _METHODS.get((kind, name)) if kind else _FUNCTIONS.get(name)
    if known is None:
        return NotImplemented
    try:
        return known(settled, *arguments) if kind else known(*arguments)
    except (TypeError, ValueError, KeyError, IndexError, AttributeError):
        return NotImplemented


def _join(text: str, items: Value) -> Value:
    return join_texts(
        [part for place, item in enumerate(settle(items)) for part in ((text, item) if place else (item,))]
    )


def _set_attribute(whole: Value, name: Value, value: Value) -> Value:
    if isinstance(whole, WalkedObject) and isinstance(settle(name), str):
        whole.fields[settle(name)] = value
    return None


def _count_up(*arguments: Value) -> Value:
    return list(range(*(settle(each) for each in arguments))[:MAX_ITEMS])


_METHODS: Mapping[tuple[type | None, str], Callable[..., Value]] = MappingProxyType(
    {
        (str, "format"): lambda text, *values: fill_text(text, "{}", values),
        (str, "join"): _join,
        (str, "lower"): str.lower,
        (str, "upper"): str.upper,
        (str, "strip"): lambda text, *signs: text.strip(*map(settle, signs)),
        (str, "lstrip"): lambda text, *signs: text.lstrip(*map(settle, signs)),
        (str, "rstrip"): lambda text, *signs: text.rstrip(*map(settle, signs)),
        (str, "startswith"): lambda text, start: text.startswith(settle(start)),
        (str, "endswith"): lambda text, end: text.endswith(settle(end)),
        (str, "empty"): lambda text: not text,
        (dict, "items"): lambda mapping: [list(pair) for pair in mapping.items()],
        (dict, "values"): lambda mapping: list(mapping.values()),
        (dict, "keys"): list,
        (dict, "get"): lambda mapping, key, default=None: mapping.get(settle(key), default),
        (list, "append"): list.append,
        (list, "push_back"): list.append,
        (list, "emplace_back"): list.append,
    }
)
_FUNCTIONS: Mapping[str, Callable[..., Value]] = MappingProxyType(
    {
        "setattr": _set_attribute,
        "format": lambda text, *values: fill_text(settle(text), "{}", values),
        "enumerate": lambda items: [[place, item] for place, item in enumerate(settle(items))],
        "zip": lambda *lists: [list(each) for each in zip(*map(settle, lists), strict=False)],
        "range": _count_up,
    }
)
