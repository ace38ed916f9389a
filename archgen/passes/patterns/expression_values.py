"""What expressions of rules come to, under the bindings of a match."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from archgen.compose.expanded_project import bind_type_name
from archgen.model.message_types import PART_KEYS
from archgen.passes.patterns.expressions import Call, Condition, ListOperand, Operand, TextOperand
from archgen.passes.patterns.matching import COMPONENTS, PatternView, join_words, resolve_text
from archgen.passes.patterns.pattern_shapes import INNER_KEY, Anything, Bindings, ComponentBody, Variable, ViewValue

_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|[A-Z]+|[0-9]+")
_TYPE_KEYS = frozenset({"type", "is", "same_as", *PART_KEYS})
"""Keys whose texts name types."""
_DATA_KEYS = frozenset({"parameters", "node", "hints", "properties"})
"""Keys below which nothing names a type."""


class WrongValueError(Exception):
    """An expression has no value: a function was given what it cannot take."""


def is_condition_true(comparison: Condition, bindings: Bindings, view: PatternView) -> bool:
    """Whether a comparison is true."""
    return _compare_sides(comparison, bindings, view) != comparison.is_negated


def _compare_sides(comparison: Condition, bindings: Bindings, view: PatternView) -> bool:
    left = comparison.left
    if not comparison.operator:
        name, wanted = (
            (evaluate_operand(each, bindings, view) for each in left.arguments) if isinstance(left, Call) else ("", "")
        )
        return isinstance(name, str) and isinstance(wanted, str) and view.is_a(name, wanted)
    value = evaluate_operand(left, bindings, view)
    other = evaluate_operand(comparison.right, bindings, view) if comparison.right else None
    match comparison.operator:
        case "==":
            return value == other
        case "!=":
            return value != other
        case "in":
            return _has_value(other, value)
        case "has":
            return _has_value(value, other)
        case _:
            return isinstance(value, str) and isinstance(other, str) and value.startswith(other)


def _has_value(holder: ViewValue, value: ViewValue) -> bool:
    """Whether a list has an item, or a mapping a key, or a text a part."""
    if isinstance(holder, list):
        return value in holder
    return isinstance(holder, (dict, str)) and isinstance(value, str) and value in holder


def evaluate_operand(operand: Operand, bindings: Bindings, view: PatternView) -> ViewValue:  # noqa: C901, PLR0911 - one for each function
    """Return what an operand stands for. Raise WrongValueError."""
    if isinstance(operand, TextOperand):
        if isinstance(operand.pattern, Variable):
            return bindings[operand.pattern.name]
        return "" if isinstance(operand.pattern, Anything) else _read_text(operand, bindings)
    if isinstance(operand, ListOperand):
        return [evaluate_operand(item, bindings, view) for item in operand.items]
    values = [evaluate_operand(item, bindings, view) for item in operand.arguments]
    if operand.function == "specialise":
        pairs = ((evaluate_operand(side, bindings, view) for side in pair) for pair in operand.names)
        stands_for = dict([_ask_text(side, operand) for side in pair] for pair in pairs)
        name = values[0]
        body = _find_element(name, view) if isinstance(name, str) else name
        if not isinstance(body, dict):
            raise WrongValueError(
                "`specialise` takes a type by its name, or all that it has: `$body` in `components: {$name: $body}`"
            )
        return bind_generic_type(body, stands_for)
    if operand.function == "without":
        return _leave_out(values[0], [_ask_text(value, operand) for value in values[1:]])
    texts = [_ask_text(value, operand) for value in values]
    match operand.function:
        case "snake":
            return "_".join(word.lower() for word in _WORD.findall(texts[0]))
        case "camel":
            return "".join(word[:1].upper() + word[1:] for word in _WORD.findall(texts[0]))
        case "without_package":
            return texts[0].rpartition("/")[2]
        case "unique":
            return _find_free_name(texts[0], view)
        case _:
            return join_words(texts)


def _leave_out(value: ViewValue, left_out: Sequence[str]) -> ViewValue:
    """Return a mapping without some of its keys, or a list without some of its items."""
    if isinstance(value, list):
        return [item for item in value if item not in left_out]
    if not isinstance(value, dict):
        raise WrongValueError("`without` takes a mapping or a list, and what it is to be without")
    kept = ComponentBody({key: each for key, each in value.items() if key not in left_out})
    kept.path = value.path if isinstance(value, ComponentBody) else ""
    return kept


def _ask_text(value: ViewValue, call: Call) -> str:
    if not isinstance(value, str):
        kind = "a list" if isinstance(value, list) else "nothing" if value is None else "a mapping"
        raise WrongValueError(f"`{call.function}` takes texts, and this is {kind}")
    return str(value)


def _read_text(operand: TextOperand, bindings: Bindings) -> str:
    text = resolve_text(operand.pattern, bindings)
    if text is None:
        raise WrongValueError("a text is made of texts, and one of these variables stands for a list or a mapping")
    return text


def _find_element(name: str, view: PatternView) -> dict[str, ViewValue] | None:
    """Return what a component or a conceptual type has, None where neither has the name."""
    body = view.get_element(COMPONENTS, name)
    return view.get_element("types", name) if body is None else body


def _find_free_name(name: str, view: PatternView) -> str:
    """Return a name that no component or conceptual type has: the name itself, else with a number behind it."""
    number, free_name = 1, name
    while _find_element(free_name, view) is not None:
        number += 1
        free_name = f"{name}_{number}"
    return free_name


def bind_generic_type(body: Mapping[str, ViewValue], stands_for: Mapping[str, str]) -> ComponentBody:
    """Return a generic type with what its names stand for in their places; a name that nobody binds stays generic."""
    special = ComponentBody(_bind_names(body, stands_for, is_component=True))
    special.path = body.path if isinstance(body, ComponentBody) else ""
    generic = special.pop("generic", None)
    if isinstance(generic, list):
        open_names: Sequence[ViewValue] = [name for name in generic if name not in stands_for]
        if open_names:
            special["generic"] = list(open_names)
    return special


def _bind_names(
    body: Mapping[str, ViewValue], stands_for: Mapping[str, str], *, is_component: bool = False
) -> dict[str, ViewValue]:
    bound: dict[str, ViewValue] = {}
    for key, value in body.items():
        if isinstance(value, dict) and is_component and key == INNER_KEY:
            bound[key] = {
                inner: _bind_names(each, stands_for, is_component=True) if isinstance(each, dict) else each
                for inner, each in value.items()
            }
        elif isinstance(value, dict) and is_component and key == "operations":
            bound[key] = {name: _bind_operation(each, stands_for) for name, each in value.items()}
        elif isinstance(value, dict):
            is_data = is_component and key in _DATA_KEYS
            bound[key] = dict(value) if is_data else _bind_names(value, stands_for)
        elif key in _TYPE_KEYS and isinstance(value, str):
            name = bind_type_name(value, stands_for)
            bound[key] = value if name == value else name
        else:
            bound[key] = value
    return bound


def _bind_operation(operation: ViewValue, stands_for: Mapping[str, str]) -> ViewValue:
    """Return an operation with its types bound: one for all that goes over, or those of fields by name."""
    if not isinstance(operation, dict):
        return operation
    bound = _bind_names(operation, stands_for)
    for key in PART_KEYS:
        fields = bound.get(key)
        if isinstance(fields, dict):
            bound[key] = {
                name: bind_type_name(each, stands_for) if isinstance(each, str) else each
                for name, each in fields.items()
            }
    return bound
