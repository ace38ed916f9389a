"""Work out expressions of launch files in Python from their syntax tree, as far as their text alone says what they are."""

from __future__ import annotations

import ast
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from archgen.plugin.importing import CHARACTERS_IN_A_STEP, Span
from archgen.plugins.ros.launch.launch_context import LaunchContext
from archgen.plugins.ros.launch.launch_entities import LaunchAction
from archgen.plugins.ros.launch.launch_values import LaunchValue, Substitution, UnknownValue, copy_value, join_values
from archgen.plugins.ros.launch.python_values import (
    BoundMethod,
    CallArguments,
    FunctionValue,
    ImportedName,
    ModuleValue,
    NameScope,
    RecordValue,
    combine_values,
    compare_values,
    is_open,
)

if TYPE_CHECKING:
    from archgen.plugins.ros.launch.launch_run import LaunchRun

MAX_DEPTH = 60
_MAX_QUOTED = 80
_NUMBERS = (int, float)
_FINDERS = frozenset(
    {
        *(ast.Constant, ast.Name, ast.Attribute, ast.NamedExpr, ast.Lambda),
        *(ast.List, ast.Tuple, ast.Set, ast.Dict, ast.BinOp),
    }
)
"""Expressions that make nothing, or whose parts are paid for each by itself."""
_WORD = "launch file"
_KNOWN_VALUES = {
    "os.sep": "/",
    "os.path.sep": "/",
    "os.pathsep": ":",
    "math.pi": math.pi,
    "math.tau": math.tau,
    "math.e": math.e,
}


class ExpressionReader(ABC):
    """Reads expressions. `context` is there while a function is read that is called at the launch."""

    def __init__(self, path: Path, text: str, run: LaunchRun) -> None:
        self.file = run.files.show_path(path)
        self.own_name = run.files.name_file(path)
        """What launch files call it."""
        self.context: LaunchContext | None = None
        self._path = path
        self._run = run
        self._lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        self.budget = run.budget.halve()
        self.depth = 0
        self._expression_readers: dict[type[ast.expr], Callable[[Any, NameScope], LaunchValue]] = {
            ast.Constant: self._read_constant,
            ast.Name: self._read_name,
            ast.Attribute: self._read_attribute,
            ast.List: self._read_list,
            ast.Tuple: self._read_tuple,
            ast.Set: self._read_list,
            ast.Dict: self._read_dict,
            ast.JoinedStr: self._read_joined_text,
            ast.BinOp: self._read_operation,
            ast.UnaryOp: self._read_unary_operation,
            ast.BoolOp: self._read_truth_operation,
            ast.Compare: self._read_comparison,
            ast.IfExp: self._read_choice,
            ast.Subscript: self._read_subscript,
            ast.Lambda: self._read_lambda,
            ast.NamedExpr: self._read_named_expression,
            ast.Call: self._read_call,
        }
        """Who reads which kind of expression; any other kind is quoted."""

    def find_variable(self, name: LaunchValue, *default: LaunchValue) -> LaunchValue:
        """Return what a variable of the environment is, where that was given; else what the launch will find."""
        known = self._run.context.environment.get(name) if isinstance(name, str) else None
        return Substitution("env", (name, *default)) if known is None else known

    @abstractmethod
    def call(self, function: LaunchValue, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        """Return what a call gives; made by the reader of calls."""

    def quote(self, node: ast.AST) -> UnknownValue:
        """Return an expression that only running it would tell, as it is written."""
        line_number = getattr(node, "lineno", 0)
        if not 0 < line_number <= len(self._lines):
            return UnknownValue(type(node).__name__, line_number, self.file)
        line, start = self._lines[line_number - 1], getattr(node, "col_offset", 0)
        is_one_line = getattr(node, "end_lineno", line_number) == line_number
        end = getattr(node, "end_col_offset", None) if is_one_line else None
        if line.isascii():
            text = line[start:end].strip()
        else:
            # Python counts bytes, for which the whole line is looked at again.
            self.budget.pay(len(line) // CHARACTERS_IN_A_STEP)
            text = line.encode("utf-8", "replace")[start:end].decode("utf-8", "replace").strip()
        shown = text if len(text) <= _MAX_QUOTED else f"{text[:_MAX_QUOTED]}..."
        return UnknownValue(shown if is_one_line or shown.endswith("...") else f"{shown}...", line_number, self.file)

    def place(self, node: ast.AST) -> Span:
        """Return where a part of the file stands."""
        line, byte_offset = getattr(node, "lineno", 1), getattr(node, "col_offset", 0)
        text = self._lines[line - 1] if line <= len(self._lines) else ""
        column = byte_offset + 1
        if not text.isascii():
            self.budget.pay(len(text) // CHARACTERS_IN_A_STEP)
            column = len(text.encode("utf-8", "replace")[:byte_offset].decode("utf-8", "replace")) + 1
        return Span(self.file, line, column, line, column + 1)

    def tell_lost(self, word: str, message: str, node: ast.AST) -> None:
        """Note what is left out because only running it would tell."""
        self._run.add_note(word, message, self.place(node))

    def tell_noted(self, word: str, message: str, node: ast.AST) -> None:
        """Note what is taken otherwise than it is written."""
        self._run.add_note(word, message, self.place(node), fate="noted")

    def pay(self, node: ast.AST, steps: int = 1) -> bool:
        """Whether the budget has so many steps for what is done once; the first time that it has not is told."""
        return self.budget.pay(steps) or self._run.tell_excess(_WORD, self.place(node))

    def pay_to_repeat(self, node: ast.AST, steps: int = 1) -> bool:
        """Whether the budget has so many steps for what is done again, or makes something larger."""
        return self.budget.pay_to_repeat(steps) or self._run.tell_excess(_WORD, self.place(node))

    def pay_for(self, made: LaunchValue, node: ast.AST) -> bool:
        """Whether the budget has the steps that a text, list or mapping costs which is made of others."""
        if isinstance(made, str):
            return self.pay_to_repeat(node, len(made) // CHARACTERS_IN_A_STEP)
        return not isinstance(made, list | tuple | dict) or self.pay_to_repeat(node, len(made))

    def copy(self, value: LaunchValue) -> LaunchValue:
        """Return a value that nothing changes afterwards, as an action takes it."""
        return copy_value(value, self.budget.pay)

    def evaluate(self, node: ast.expr, scope: NameScope) -> LaunchValue:
        """Return what an expression stands for."""
        reader = self._expression_readers.get(type(node))
        if reader is None or self.depth >= MAX_DEPTH or not self.pay(node):
            return self.quote(node)
        self.depth += 1
        try:
            value = reader(node, scope)
        finally:
            self.depth -= 1
        return value if type(node) in _FINDERS or self.pay_for(value, node) else self.quote(node)

    def force(self, value: LaunchValue) -> LaunchValue:
        """Return a value with its substitutions filled in, where that is possible here."""
        if isinstance(value, Substitution) and self.context is not None:
            return self.context.resolve(value)
        return value

    def judge(self, value: LaunchValue) -> bool | None:
        """Return whether Python takes a value for true; None where that is not known."""
        found = self.force(value)
        if found is None or isinstance(found, bool | int | float | str | list | tuple | dict):
            return None if isinstance(found, str) and "$(" in found else bool(found)
        return True if isinstance(found, LaunchAction | FunctionValue | ImportedName) else None

    def _read_constant(self, node: ast.Constant, _scope: NameScope) -> LaunchValue:
        is_plain = node.value is None or isinstance(node.value, bool | int | float | str)
        return node.value if is_plain else self.quote(node)

    def _read_name(self, node: ast.Name, scope: NameScope) -> LaunchValue:
        is_known, value = scope.find(node.id)
        return value if is_known else ImportedName(node.id)

    def _read_attribute(self, node: ast.Attribute, scope: NameScope) -> LaunchValue:
        owner = self.evaluate(node.value, scope)
        if isinstance(owner, ImportedName):
            name = f"{owner.name}.{node.attr}"
            return _KNOWN_VALUES.get(name) or ImportedName(name)
        if isinstance(owner, ModuleValue):
            is_known, value = owner.scope.find(node.attr)
            return value if is_known else ImportedName(f"{owner.name}.{node.attr}")
        if isinstance(owner, UnknownValue):
            return self.quote(node)
        if isinstance(owner, RecordValue) and node.attr not in owner.methods:
            return owner.values.get(node.attr, self.quote(node))
        if node.attr in {"parent", "name"} and isinstance(owner, str | Substitution):
            return self._read_path_part(node, owner)
        return BoundMethod(owner, node.attr)

    def _read_path_part(self, node: ast.Attribute, owner: str | Substitution) -> LaunchValue:
        if isinstance(owner, str):
            head, _, tail = owner.rstrip("/").rpartition("/")
            return head if node.attr == "parent" else tail
        if owner.kind == "path" and len(owner.parts) > 1:
            return Substitution("path", owner.parts[:-1]) if node.attr == "parent" else owner.parts[-1]
        return self.quote(node)

    def _read_list(self, node: ast.List | ast.Set, scope: NameScope) -> LaunchValue:
        return self._read_items(node.elts, scope)

    def _read_tuple(self, node: ast.Tuple, scope: NameScope) -> LaunchValue:
        return tuple(self._read_items(node.elts, scope))

    def _read_items(self, nodes: list[ast.expr], scope: NameScope) -> list[LaunchValue]:
        found: list[LaunchValue] = []
        for node in nodes:
            value = self.evaluate(node.value if isinstance(node, ast.Starred) else node, scope)
            if not isinstance(node, ast.Starred):
                found.append(value)
            elif isinstance(value, list | tuple) and self.pay_for(value, node):
                found += value
            elif isinstance(value, list) and not found:
                # What doubles in every line would fill the memory: it stays as it is.
                return value
            else:
                found.append(self.quote(node))
        return found

    def _read_dict(self, node: ast.Dict, scope: NameScope) -> LaunchValue:
        found: dict[LaunchValue, LaunchValue] = {}
        for key_node, value_node in zip(node.keys, node.values, strict=True):
            value = self.evaluate(value_node, scope)
            if key_node is None:
                if not isinstance(value, Mapping) or not self.pay_for(value, node):
                    return self.quote(node)
                found |= value
                continue
            key = self.evaluate(key_node, scope)
            if isinstance(key, UnknownValue | list | dict):
                return self.quote(node)
            try:
                found[key] = value
            except TypeError:
                return self.quote(node)
        return found

    def _read_joined_text(self, node: ast.JoinedStr, scope: NameScope) -> LaunchValue:
        parts: list[LaunchValue] = []
        for part in node.values:
            value = (
                self.evaluate(part.value, scope) if isinstance(part, ast.FormattedValue) else self.evaluate(part, scope)
            )
            is_formatted = isinstance(part, ast.FormattedValue) and part.format_spec is not None
            if isinstance(value, list | dict) and not is_open([*value, *getattr(value, "values", list)()]):
                value = str(value)
            if is_formatted or not isinstance(value, str | int | float | bool | Substitution):
                return self.quote(node)
            # In a text Python writes `True`, not `true`.
            parts.append(str(value) if isinstance(value, bool) else value)
        return join_values(parts) if parts else ""

    def _read_operation(self, node: ast.BinOp, scope: NameScope) -> LaunchValue:
        left, right = self.evaluate(node.left, scope), self.evaluate(node.right, scope)
        return self.combine(node.op, left, right, node)

    def combine(self, sign: ast.operator, left: LaunchValue, right: LaunchValue, node: ast.AST) -> LaunchValue:
        """Return what an operator makes of two values."""
        if not (self.pay_for(left, node) and self.pay_for(right, node)):
            return left if isinstance(left, list) else self.quote(node)
        made = combine_values(sign, left, right)
        return self.quote(node) if made is None else made

    def _read_unary_operation(self, node: ast.UnaryOp, scope: NameScope) -> LaunchValue:
        value = self.evaluate(node.operand, scope)
        if isinstance(node.op, ast.Not):
            verdict = self.judge(value)
            return self.quote(node) if verdict is None else not verdict
        is_number = isinstance(value, _NUMBERS) and not isinstance(value, bool)
        if is_number and isinstance(node.op, ast.USub | ast.UAdd):
            return -value if isinstance(node.op, ast.USub) else value
        return self.quote(node)

    def _read_truth_operation(self, node: ast.BoolOp, scope: NameScope) -> LaunchValue:
        is_or = isinstance(node.op, ast.Or)
        value: LaunchValue = None
        for part in node.values:
            value = self.evaluate(part, scope)
            verdict = self.judge(value)
            if verdict is None:
                return self.quote(node)
            if verdict == is_or:
                return value
        return value

    def _read_comparison(self, node: ast.Compare, scope: NameScope) -> LaunchValue:
        values = [self.force(self.evaluate(each, scope)) for each in (node.left, *node.comparators)]
        for sign, left, right in zip(node.ops, values, values[1:], strict=False):
            is_paid = self.pay_for(left, node) and self.pay_for(right, node)
            verdict = compare_values(sign, left, right) if is_paid else None
            if verdict is None:
                return self.quote(node)
            if not verdict:
                return False
        return True

    def _read_choice(self, node: ast.IfExp, scope: NameScope) -> LaunchValue:
        verdict = self.judge(self.evaluate(node.test, scope))
        if verdict is None:
            return self.quote(node)
        return self.evaluate(node.body if verdict else node.orelse, scope)

    def _read_subscript(self, node: ast.Subscript, scope: NameScope) -> LaunchValue:
        owner = self.evaluate(node.value, scope)
        if isinstance(node.slice, ast.Slice):
            return self._read_slice(node, owner, node.slice, scope)
        key = self.evaluate(node.slice, scope)
        if isinstance(owner, ImportedName) and owner.name == "os.environ":
            return self.find_variable(key)
        if isinstance(owner, BoundMethod) and owner.name == "launch_configurations":
            return Substitution("var", (key,))
        if isinstance(owner, Mapping | list | tuple | str) and isinstance(key, str | int):
            try:
                return owner[key]  # type: ignore[index]
            except (KeyError, IndexError, TypeError):
                return self.quote(node)
        return self.quote(node)

    def _read_slice(self, node: ast.Subscript, owner: LaunchValue, span: ast.Slice, scope: NameScope) -> LaunchValue:
        ends = [None if each is None else self.evaluate(each, scope) for each in (span.lower, span.upper, span.step)]
        if not isinstance(owner, str | list | tuple) or any(
            end is not None and not isinstance(end, int) for end in ends
        ):
            return self.quote(node)
        try:
            return owner[slice(*ends)]
        except ValueError:
            return self.quote(node)

    def _read_lambda(self, node: ast.Lambda, scope: NameScope) -> LaunchValue:
        return FunctionValue(node, scope, self)

    def _read_named_expression(self, node: ast.NamedExpr, scope: NameScope) -> LaunchValue:
        scope.values[node.target.id] = value = self.evaluate(node.value, scope)
        return value

    def assign(self, target: ast.expr, value: LaunchValue, scope: NameScope) -> None:
        """Give a value to a name, to several names, or to a place in a list or dict."""
        if isinstance(target, ast.Name):
            scope.values[target.id] = value
        elif isinstance(target, ast.Tuple | ast.List):
            fits = isinstance(value, list | tuple | str) and len(value) == len(target.elts)
            items = list(value) if fits else None
            for number, each in enumerate(target.elts):
                self.assign(each, items[number] if items else self.quote(target), scope)
        elif isinstance(target, ast.Subscript):
            self._assign_entry(target, value, scope)

    def _assign_entry(self, target: ast.Subscript, value: LaunchValue, scope: NameScope) -> None:
        owner, key = self.evaluate(target.value, scope), self.evaluate(target.slice, scope)
        if isinstance(owner, dict) and isinstance(key, str | int):
            owner[key] = value
        elif isinstance(owner, list) and isinstance(key, int):
            if -len(owner) <= key < len(owner):
                owner[key] = value
        elif isinstance(owner, dict | list):
            self.tell_lost("=", f"which entry `{self.quote(target).reason}` is, is computed", target)

    def _read_call(self, node: ast.Call, scope: NameScope) -> LaunchValue:
        function = self.evaluate(node.func, scope)
        positional = self._read_items(node.args, scope)
        named: dict[str, LaunchValue] = {}
        for keyword in node.keywords:
            value = self.evaluate(keyword.value, scope)
            if keyword.arg is not None:
                named[keyword.arg] = value
            elif isinstance(value, Mapping):
                named |= {str(key): inner for key, inner in value.items()}
            else:
                self.tell_lost("call", "arguments of it are computed", keyword.value)
        return self.call(function, CallArguments(positional, named), node)

    def list_loop_items(self, node: ast.expr, scope: NameScope) -> list[LaunchValue] | None:
        """Return what a loop takes one after the other; None where that is not known."""
        value = self.evaluate(node, scope)
        is_known = isinstance(value, list | tuple | Mapping | str) and self.pay_for(value, node)
        return list(value) if is_known else None
