"""The names that a program knows, and the objects that it makes: modules, types, classes and their members, of Python and
C++ alike.
"""

from __future__ import annotations

import builtins
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from archgen.plugin.importing import Span, WorkBudget
from archgen.plugins.ros.sources import ros_calls
from archgen.plugins.ros.sources.cpp_sources import split_type_arguments
from archgen.plugins.ros.sources.ros_call_reading import RosCall, RosCallReader
from archgen.plugins.ros.sources.source_code import Expression, Function, SourceClass, SourceFile, Statement
from archgen.plugins.ros.sources.source_index import CppCode, SourceIndex
from archgen.plugins.ros.sources.walk_values import (
    BoundFunction,
    ExternalName,
    FoundNode,
    NodeHandle,
    ParameterValue,
    TextStream,
    UnknownText,
    Value,
    WalkedObject,
)

_MAX_FAMILY = 50
_MAX_ALIASES = 8
_MISSING = object()
PASSED_THROUGH = frozenset(
    {"lock", "get", "shared_from_this", "get_parameter_value", "c_str", "move", "ref", "forward", "value", "get_value"}
    | {"static_pointer_cast", "dynamic_pointer_cast", "as_string", "as_int", "as_double", "as_bool", "as_string_array"}
    | {f"{kind}_value" for kind in ("string", "double", "integer", "bool", "string_array", "double_array")}
    | {
        *("ParameterValue", "String", "str", "string", "list", "tuple", "int", "float", "to_string", "numpy_msg"),
        "TransportHints",
    }
)
"""What gives its argument, or what it is called on, as it is."""
_MESSAGE_SPACES = ("msg::", "srv::", "action::")


class Scope:
    """The names that a function knows."""

    def __init__(self, file: SourceFile, around: Scope | None = None, self_object: WalkedObject | None = None) -> None:
        self.file, self.around, self.self_object = file, around, self_object
        self.variables: dict[str, Value] = {}
        self.returned: list[Value] = []
        self.type_values: dict[str, str] = {}

    def find(self, name: str) -> Scope | None:
        """Return the scope that has a name: this one, or one around it."""
        return self if name in self.variables else self.around.find(name) if self.around is not None else None


class ProgramNames(RosCallReader):
    """Finds what a name means where it stands; a walk says what statements and expressions do."""

    def __init__(self, index: SourceIndex, cpp: CppCode | None, given: Mapping[str, Value], *, is_ros_1: bool) -> None:
        super().__init__(given, is_ros_1=is_ros_1)
        self._index = index
        self._cpp = cpp or CppCode()
        self._modules: dict[SourceFile, Scope] = {}
        self._script: Path | None = None
        """The script that is run: modules beside it can be imported from everywhere."""

    def _walk(self, statements: Sequence[Statement], scope: Scope) -> bool:
        """Walk through statements; return whether the function ends there."""
        raise NotImplementedError

    def _evaluate(self, expression: Expression | None, scope: Scope) -> Value:
        """Return what an expression gives."""
        raise NotImplementedError

    # Names

    def _open_module(self, file: SourceFile, name: str = "") -> Scope:
        if file not in self._modules:
            scope = self._modules[file] = Scope(file)
            scope.variables["__name__"] = name
            before, self.file = self.file, file
            self._walk(file.statements, scope)
            self.file = before
        return self._modules[file]

    def _find_module(self, name: str, file: SourceFile) -> SourceFile | None:
        found = self._index.find_module(name, file.path)
        return self._index.find_module(name, self._script) if found is None and self._script is not None else found

    def _find_name(self, name: str, scope: Scope) -> Value:
        holder = scope.find(name)
        if scope.file.language == "python":
            found = self._find_in_module(scope.file, name) if holder is None else holder.variables[name]
            return self._resolve_import(found, scope.file)
        return self._find_cpp_name(name, scope) if holder is None else holder.variables[name]

    def _find_in_module(self, file: SourceFile, name: str) -> Value:
        variables = self._open_module(file).variables
        if name in variables or name in file.classes:
            return self._resolve_import(variables[name], file) if name in variables else file.classes[name]
        for module in variables.get("*", ()):
            other = self._find_module(module, file)
            found = None if other is None or other is file else self._find_in_module(other, name)
            if found is not None and (not isinstance(found, ExternalName) or found.name != name):
                return found
        return ExternalName(name)

    def _resolve_import(self, found: Value, file: SourceFile) -> Value:
        if not isinstance(found, ExternalName):
            return found
        module = self._find_module(found.name, file)
        outer, _, last = found.name.rpartition(".")
        holder = self._find_module(outer, file) if outer and module is None else None
        return self._find_in_module(holder, last) if holder is not None and holder is not file else module or found

    def _find_cpp_name(self, name: str, scope: Scope) -> Value:
        owner = scope.self_object
        outer, _, last = name.rpartition("::")
        if owner is not None and name in owner.fields:
            return owner.fields[name]
        holder = self._find_class(outer, scope) if outer else owner.made_of if owner is not None else None
        method = self._find_method(holder, last) if holder is not None else None
        if method is not None and owner is not None:
            return BoundFunction(method[0], owner)
        found = self._find_class(name, scope)
        if found is not None:
            return found
        if last in self._cpp.functions and not name.startswith(("rclcpp::", "std::", "ros::")):
            return BoundFunction(self._cpp.functions[last][0])
        for file in self._cpp.files:
            if file.statements and last in (variables := self._open_module(file).variables):
                return variables[last]
        constant = self._find_constant(holder, last, scope) if holder is not None else _MISSING
        return ExternalName(name.replace("::", ".")) if constant is _MISSING else constant

    def _find_constant(self, found: SourceClass, name: str, scope: Scope) -> Value:
        for statement in found.field_values:
            if statement.value is not None and statement.targets and statement.targets[0].value == name:
                return self._evaluate(statement.value, scope)
        return _MISSING

    # Types and classes

    def _expand_type(self, name: str, scope: Scope | None) -> str:
        """Return what a type of C++ is called outside: aliases and parameters of templates filled in."""
        owner = scope.self_object if scope is not None else None
        tables: list[Mapping[str, str]] = [scope.type_values] if scope is not None else []
        tables += [owner.type_values, owner.made_of.aliases] if owner is not None else []
        for _ in range(_MAX_ALIASES):
            plain, bracket, rest = name.partition("<")
            first, joint, last = plain.partition("::")
            known = next(
                (table for table in (*tables, self._cpp.aliases) if plain in table or (joint and first in table)), None
            )
            if known is None:
                break
            name = f"{known[plain] if plain in known else f'{known[first]}::{last}'}{bracket}{rest}"
        if name.startswith(_MESSAGE_SPACES) and owner is not None and "::" in owner.made_of.name:
            # In the namespace of its package a message goes without it.
            return f"{owner.made_of.name.partition('::')[0]}::{name}"
        return name

    def _find_class(self, name: str, scope: Scope | None) -> SourceClass | None:
        owner = scope.self_object if scope is not None else None
        return self._cpp.find_class(
            self._expand_type(name, scope).partition("<")[0], owner.made_of.name if owner else ""
        )

    def _list_bases(self, found: SourceClass) -> Iterator[SourceClass | str]:
        """Yield the bases of a class: of the workspace, or the dotted names of others'."""
        for base in found.bases:
            if found.file.language == "python":
                first, *rest = base.split(".")
                value = self._find_in_module(found.file, first)
                for part in rest:
                    value = self._get_member(value, part, UnknownText(base, Span.of_file(found.file.shown)))
                yield value if isinstance(value, SourceClass) else getattr(value, "name", base)
            else:
                name = self._expand_type(base, None).partition("<")[0]
                known = self._cpp.find_class(name, found.name.rpartition("::")[0])
                yield known if known is not None and known is not found else name.replace("::", ".")

    def _list_family(self, found: SourceClass) -> list[SourceClass | str]:
        """Return a class and all of its bases, those of the workspace and the names of others."""
        family: list[SourceClass | str] = [found]
        for each in family:
            if isinstance(each, SourceClass) and len(family) < _MAX_FAMILY:
                family += [base for base in self._list_bases(each) if base not in family]
        return family

    def _find_method(self, found: SourceClass, name: str) -> list[Function] | None:
        classes = (each for each in self._list_family(found) if isinstance(each, SourceClass))
        return next((each.functions[name] for each in classes if name in each.functions), None)

    def _find_inner_class(self, found: SourceClass, name: str) -> SourceClass | None:
        """Return a class of Python that is defined inside of another one."""
        classes = (each for each in self._list_family(found) if isinstance(each, SourceClass))
        return next((inner for each in classes if (inner := each.file.classes.get(f"{each.name}.{name}"))), None)

    def _list_subclasses(self, found: SourceClass) -> list[Value]:
        """Return the classes of Python that are made of one, in the modules that were imported, however far."""
        pending = [*self._modules]
        for file in pending:
            variables = self._open_module(file).variables
            imported = [each.name for each in variables.values() if isinstance(each, ExternalName)]
            for name in [*imported, *variables.get("*", ())]:
                modules = (self._find_module(each, file) for each in (name, name.rpartition(".")[0]) if each)
                module = next(filter(None, modules), None)
                if module is not None and module not in pending:
                    self._open_module(module)
                    pending.append(module)
        return [each for file in pending for each in file.classes.values() if found in self._list_bases(each)]

    def _find_field(self, found: SourceClass, name: str) -> str:
        """Return the type of a member of C++; empty where there is none of that name."""
        classes = (each for each in self._list_family(found) if isinstance(each, SourceClass))
        return next((each.fields[name] for each in classes if name in each.fields), "")

    def _get_member(self, whole: Value, name: str, unknown: UnknownText) -> Value:
        if isinstance(whole, WalkedObject):
            return (
                whole.fields[name] if name in whole.fields else self._get_of_class(whole.made_of, name, whole, unknown)
            )
        if isinstance(whole, SourceFile):
            found = self._find_in_module(whole, name)
            inner = self._index.find_module(f"{whole.path.parent.name}.{name}", whole.path)
            return inner if isinstance(found, ExternalName) and inner is not None else found
        if isinstance(whole, SourceClass):
            part = self._get_of_class(whole, name, None, unknown)
            constant = self._find_constant(whole, name, self._open_module(whole.file)) if part is unknown else _MISSING
            return part if constant is _MISSING else constant
        if isinstance(whole, ExternalName):
            full_name = ExternalName(f"{whole.name}.{name}")
            qos = ros_calls.read_qos_name(full_name.name)
            return qos if qos is not None else self._resolve_import(full_name, self.file) if self.file else full_name
        if isinstance(whole, dict) and name in whole:
            return whole[name]
        return whole if isinstance(whole, ParameterValue) and name in PASSED_THROUGH else unknown

    def _get_of_class(self, found: SourceClass, name: str, owner: WalkedObject | None, unknown: UnknownText) -> Value:
        """Return a method of a class, or a class inside of it."""
        method = self._find_method(found, name)
        return BoundFunction(method[0], owner) if method else self._find_inner_class(found, name) or unknown


_MAX_PROGRAM_STEPS = 100_000
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
        self._budget = WorkBudget(_MAX_PROGRAM_STEPS, budget)
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
