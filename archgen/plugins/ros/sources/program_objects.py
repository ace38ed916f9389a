"""The objects that a program makes: of its own classes, with their bases and fields, and of types of C++ that others define."""

from __future__ import annotations

import builtins
import sys
from collections.abc import Mapping, Sequence

from archgen.plugin.importing import Span, WorkBudget
from archgen.plugins.ros.sources import ros_calls
from archgen.plugins.ros.sources.cpp_sources import split_type_arguments
from archgen.plugins.ros.sources.program_names import ProgramNames, Scope
from archgen.plugins.ros.sources.ros_call_reading import RosCall
from archgen.plugins.ros.sources.source_code import Expression, Function, SourceClass
from archgen.plugins.ros.sources.source_index import CppCode, SourceIndex
from archgen.plugins.ros.sources.walk_values import (
    BoundFunction,
    ExternalName,
    FoundNode,
    NodeHandle,
    TextStream,
    UnknownText,
    Value,
    WalkedObject,
)

MAX_PROGRAM_STEPS = 100_000
_MAX_LISTS = 20
_PLAIN_PACKAGES = frozenset({"std", "boost", "rclpy", "rclcpp", "rclcpp_lifecycle", "rospy"}) | sys.stdlib_module_names
"""What bases of these say to ROS is known: nothing, or what each node says."""
_STREAMS = ("stringstream", "ostringstream")
POINTERS = ("shared_ptr", "unique_ptr", "weak_ptr", "Ptr")


def _is_plain_base(name: str) -> bool:
    """Whether a base says nothing to ROS by itself: one of ROS, or of a language."""
    first, _, rest = name.partition(".")
    is_builtin = not rest and hasattr(builtins, first)
    return name in ros_calls.NODE_CLASSES or first in _PLAIN_PACKAGES or is_builtin or name == "ABC"


class ProgramObjects(ProgramNames):
    """Makes objects as the program does; a walk says what their constructors do."""

    def __init__(
        self, index: SourceIndex, cpp: CppCode | None, given: Mapping[str, Value], budget: WorkBudget, *, is_ros_1: bool
    ) -> None:
        super().__init__(index, cpp, given, is_ros_1=is_ros_1)
        self._budget = WorkBudget(MAX_PROGRAM_STEPS, budget)
        self._pending: list[tuple[BoundFunction, FoundNode | None]] = []
        self.is_cut = False
        """Whether there was more than is walked."""
        self.strange_bases: list[str] = []
        """Bases outside of the workspace, of nodes and of what speaks for one: they may say more to ROS."""

    def _call(self, target: BoundFunction, arguments: list[Value], keywords: Mapping[str, Value]) -> Value:
        """Walk through a function."""
        raise NotImplementedError

    def _pay(self, steps: int = 1) -> bool:
        self.is_cut = self.is_cut or not self._budget.pay(steps)
        return not self.is_cut

    def _span(self, expression: Expression) -> Span:
        file = self.file.shown if self.file is not None else ""
        return Span(file, expression.line, expression.column, expression.line, expression.column + 1)

    def _give_up(self, expression: Expression) -> UnknownText:
        return UnknownText(expression.text, self._span(expression))

    def _mention(self, values: Sequence[Value], depth: int = 0) -> None:
        """Remember functions that are handed over: somebody will call them."""
        for value in values:
            if isinstance(value, BoundFunction):
                self._pending.append((value, self.find_node(value.self_object) or self.current_node))
            elif isinstance(value, list) and depth < _MAX_LISTS and self._pay(len(value)):
                self._mention(value, depth + 1)

    def _construct_class(
        self,
        found: SourceClass,
        arguments: list[Value],
        keywords: Mapping[str, Value],
        span: Span,
        types: Sequence[str] = (),
    ) -> WalkedObject:
        made = WalkedObject(found, type_values=dict(zip(found.type_parameters, types, strict=False)))
        family = self._list_family(found)
        foreign = [each for each in family if isinstance(each, str)]
        before = self.current_node
        if any(each in ros_calls.NODE_CLASSES or each.endswith((".Node", "LifecycleNode")) for each in foreign):
            made.node, made.is_node = self.make_node(span), True
            made.node.is_lifecycle = any("ifecycle" in each for each in foreign)
        else:
            given = [self.find_node(each) for each in (*arguments, *keywords.values())]
            made.node = next((each for each in given if each is not None), self.current_node)
        if made.is_node or made.node is not before or before is None or self.is_ros_1:
            self.strange_bases += [each for each in foreign if not _is_plain_base(each)]
        self.current_node = made.node
        self._construct_base(made, found, arguments, keywords)
        # What another package calls of a class that it knows by its base is not to be seen here: any of it may be.
        is_foreign = any(
            each not in {"object", "ABC"} | ros_calls.NODE_CLASSES and not each.startswith("std.") for each in foreign
        )
        last = found.name.rpartition("::")[2]
        names = dict.fromkeys(name for each in family if isinstance(each, SourceClass) for name in each.functions)
        for name in names:
            method = self._find_method(found, name)
            if method and (name in ros_calls.HOOKS or (is_foreign and name not in {last, f"~{last}", "__init__"})):
                self._pending.append((BoundFunction(method[0], made), made.node))
        self.current_node = made.node if before is None else before
        return made

    def _construct_base(
        self, made: WalkedObject, found: SourceClass, arguments: list[Value], keywords: Mapping[str, Value]
    ) -> None:
        is_python = found.file.language == "python"
        scope = Scope(found.file, self._open_module(found.file) if is_python else None, made)
        self._walk_fields(found, made, scope)
        constructors = (
            self._find_method(found, "__init__") if is_python else found.functions.get(found.name.rpartition("::")[2])
        )
        if constructors:
            self._call(BoundFunction(choose_overload(constructors, len(arguments)), made), arguments, keywords)
            return
        for base in () if is_python else self._list_bases(found):
            if isinstance(base, SourceClass):
                self._construct_base(made, base, [], {})
        self._name_node(made, arguments, keywords)

    def _walk_fields(self, found: SourceClass, made: WalkedObject, scope: Scope) -> None:
        before, self.file = self.file, found.file
        for statement in found.field_values:
            if statement.kind == "set" and statement.value is not None and statement.targets[0].kind == "name":
                made.fields.setdefault(statement.targets[0].value, self._evaluate(statement.value, scope))
        for name, type_name in found.fields.items():
            if not type_name.endswith("*") and name not in made.fields:
                call = RosCall(None, None, "", [], {}, (), Span.of_file(found.file.shown))
                value = self.make_external(call, self._expand_type(type_name, scope), is_member=True)
                if value is not NotImplemented:
                    made.fields[name] = value
        self.file = before

    def _name_node(self, made: WalkedObject, arguments: list[Value], keywords: Mapping[str, Value]) -> None:
        if made.node is not None and made.is_node:
            self.name_node(made.node, arguments, keywords, is_cpp=made.made_of.file.language == "cpp")

    def _initialize(self, owner: WalkedObject, arguments: list[Value], value: Expression, scope: Scope) -> None:
        """Give a member its first value, or a base its arguments."""
        name = str(value.parts[0].value)
        type_name = self._find_field(owner.made_of, name)
        if type_name:
            owner.fields[name] = self._construct(type_name, arguments, value, scope)
            return
        base = self._find_class(name.partition("<")[0], scope)
        if base is None:
            self._name_node(owner, arguments, {})
        elif base is owner.made_of:
            constructors = [each for each in base.functions[base.name.rpartition("::")[2]] if each.parameters]
            if constructors:
                self._call(BoundFunction(choose_overload(constructors, len(arguments)), owner), arguments, {})
        else:
            types = split_type_arguments(name.partition("<")[2].removesuffix(">"))
            owner.type_values |= dict(zip(base.type_parameters, types, strict=False))
            self._construct_base(owner, base, arguments, {})

    def _construct(  # noqa: PLR0911 - a kind of types each
        self, type_name: str, arguments: list[Value], expression: Expression, scope: Scope
    ) -> Value:
        """Return an object of a type of C++."""
        full_type = self._expand_type(type_name.rstrip("*"), scope)
        name, _, inner = full_type.partition("<")
        plain, first = name.replace("::", "."), arguments[0] if arguments else None
        is_copied = len(arguments) == 1 and isinstance(first, NodeHandle) and "NodeHandle" in plain
        if plain.endswith(POINTERS) or type_name.endswith("*") or is_copied:
            return first
        found = self._find_class(name, scope)
        if found is not None:
            types = [self._expand_type(each, scope) for each in split_type_arguments(inner.removesuffix(">"))]
            is_copied = isinstance(first, WalkedObject) and first.made_of is found
            return first if is_copied else self._construct_class(found, arguments, {}, self._span(expression), types)
        call = RosCall(None, ExternalName(plain), "", arguments, {}, (), self._span(expression))
        made = self.make_external(call, full_type)
        self._mention(arguments)
        for known in (made, *self._make_settings(call, plain)):
            if known is not NotImplemented and known is not None:
                return known
        if plain.endswith(_STREAMS):
            return TextStream()
        if plain.endswith(("vector", "array", "list")) and arguments:
            return first if len(arguments) == 1 and isinstance(first, list) else arguments
        if plain.endswith("string") and not arguments:
            return ""
        if len(arguments) == 1:
            return first
        unknown = self._give_up(expression)
        unknown.foreign_type = plain if "." in plain else ""
        return unknown

    def _make_settings(self, call: RosCall, name: str) -> tuple[Value, Value]:
        return (
            ros_calls.make_qos(name, call.arguments, call.keywords),
            ros_calls.make_seconds(name, call.arguments, call.keywords),
        )


def choose_overload(functions: Sequence[Function], count: int) -> Function:
    """Return the function that takes so many arguments, else the first."""
    for function in functions:
        needed = sum(each.default is None for each in function.parameters)
        if needed <= count <= len(function.parameters):
            return function
    return functions[0]
