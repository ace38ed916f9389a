"""Walk through a program as it would run, without running it: the nodes that it makes, and what they publish, read, serve and call.

The walk begins at `main`, a script, or a class that a container loads, and follows what is constructed and called from there.
Of a condition that is not known both ways are walked. What cannot be told is unknown and stays so: nothing is guessed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from archgen.plugin.importing import Span
from archgen.plugins.ros.sources.cpp_sources import split_type_arguments
from archgen.plugins.ros.sources.ros_call_reading import RosCallReader
from archgen.plugins.ros.sources.ros_calls import HOOKS, NODE_CLASSES, OPERATIONS, make_qos, make_seconds, read_qos_name
from archgen.plugins.ros.sources.source_code import Expression, Function, SourceClass, SourceFile, Statement
from archgen.plugins.ros.sources.source_index import CppCode, SourceIndex
from archgen.plugins.ros.sources.walk_values import (
    Alternatives,
    Callable,
    ExternalName,
    FoundNode,
    ModuleValue,
    NodeHandle,
    ParameterValue,
    TextStream,
    UnknownText,
    WalkedObject,
    join_texts,
    settle,
)

_MAX_STEPS = 200_000
_MAX_CALL_DEPTH = 25
_MAX_ROUNDS = 64
_MAX_TEXT = 2000
_MISSING = object()
_PASSED_THROUGH = frozenset(
    {
        "lock",
        "get",
        "shared_from_this",
        "get_parameter_value",
        "c_str",
        "move",
        "ref",
        "forward",
        "str_value",
        "as_string",
    }
) | {
    "as_int",
    "as_double",
    "as_bool",
    "as_string_array",
    "get_value",
    "value",
    "static_pointer_cast",
    "dynamic_pointer_cast",
}
_PASSED_THROUGH |= {f"{kind}_value" for kind in ("string", "double", "integer", "bool", "string_array", "double_array")}
_PASSED_THROUGH |= {
    "ParameterValue",
    "String",
    "str",
    "string",
    "list",
    "tuple",
    "int",
    "float",
    "double",
    "bool",
    "to_string",
    "numpy_msg",
}
_HANDLES = frozenset({"getNodeHandle", "getMTNodeHandle"})
_PRIVATE_HANDLES = frozenset({"getPrivateNodeHandle", "getMTPrivateNodeHandle"})
_MAKERS = frozenset({"make_shared", "make_unique", "new", "reset", "allocate_shared"})
_STREAMS = frozenset({"std.stringstream", "std.ostringstream", "stringstream", "ostringstream"})
_WRITERS = frozenset(
    {"snprintf", "sprintf", "strcpy", "strcat", "std.snprintf", "std.sprintf", "getline", "std.getline"}
)


class Scope:
    """The names that a function knows."""

    def __init__(self, file: SourceFile, around: Scope | None = None, self_object: WalkedObject | None = None) -> None:
        self.file = file
        self.around = around
        self.self_object = self_object
        self.variables: dict[str, Any] = {}
        self.returned: list[Any] = []
        self.type_values: dict[str, str] = {}

    def find(self, name: str) -> Any:  # noqa: ANN401 - any value
        """Return the value of a name, `_MISSING` where it is not one of these."""
        scope: Scope | None = self
        while scope is not None:
            if name in scope.variables:
                return scope.variables[name]
            scope = scope.around
        return _MISSING


class ProgramWalk(RosCallReader):
    """One walk through one program; `given` are the parameters that its node is started with."""

    def __init__(self, index: SourceIndex, cpp: CppCode | None, given: Mapping[str, Any], *, is_ros_1: bool) -> None:
        super().__init__(given, is_ros_1=is_ros_1)
        self._index = index
        self._cpp = cpp
        self._modules: dict[SourceFile, Scope] = {}
        self._pending: list[tuple[Callable, FoundNode | None]] = []
        self._seen_functions: set[tuple[int, int]] = set()
        self._steps = 0
        self._depth = 0
        self.is_cut = False
        """Whether there was more than is walked."""

    def expand_callback_type(self, callback: Callable) -> str:
        """Return the type of what a callback takes."""
        parameters = callback.function.parameters
        scope = Scope(callback.function.file, None, callback.self_object)
        return self._expand_type(parameters[0].type_name.removesuffix("&"), scope) if parameters else ""

    # Beginnings

    def walk_script(self, file: SourceFile, function_name: str = "") -> None:
        """Walk through a script of Python, or through a module and one function of it."""
        scope = self._open_module(file, "" if function_name else "__main__")
        for function in file.functions.get(function_name, ())[:1] if function_name else ():
            self._call(Callable(function, None, scope), [], {})
        self._walk_pending()

    def walk_main(self) -> None:
        """Walk through the `main` of a program in C++."""
        for function in self._cpp.functions.get("main", ())[:1] if self._cpp else ():
            self._call(Callable(function), [], {})
        self._walk_pending()

    def walk_class(self, name: str) -> bool:
        """Walk through a class that a container loads; return whether there is one."""
        found = self._cpp.find_class(name, "") if self._cpp else None
        if found is None:
            return False
        made = self._construct_class(found, [], {}, Span.of_file(found.file.shown))
        if made.node is None:
            self.make_node(Span.of_file(found.file.shown))
        self._walk_pending()
        return True

    def _walk_pending(self) -> None:
        while self._pending:
            function, node = self._pending.pop(0)
            key = (id(function.function), id(function.self_object))
            if key not in self._seen_functions:
                self.current_node = node or self.current_node
                count = len(function.function.parameters)
                unknown = UnknownText("what calls it hands over", Span.of_file(function.function.file.shown))
                self._call(function, [unknown] * count, {})

    # Modules and classes

    def _open_module(self, file: SourceFile, name: str) -> Scope:
        if file not in self._modules:
            scope = self._modules[file] = Scope(file)
            scope.variables["__name__"] = name
            before, self.file = self.file, file
            self._walk(file.statements, scope)
            self.file = before
        return self._modules[file]

    def _find_name(self, name: str, scope: Scope) -> Any:  # noqa: ANN401 - any value
        found = scope.find(name)
        if found is not _MISSING:
            return self._resolve_import(found, scope.file) if scope.file.language == "python" else found
        if scope.file.language == "python":
            return self._find_in_module(scope.file, name)
        return self._find_cpp_name(name, scope)

    def _find_in_module(self, file: SourceFile, name: str) -> Any:  # noqa: ANN401 - any value
        found = self._open_module(file, "").variables.get(name, _MISSING)
        if found is not _MISSING:
            return self._resolve_import(found, file)
        if name in file.classes:
            return file.classes[name]
        if name in file.functions:
            return Callable(file.functions[name][-1])
        star = self._open_module(file, "").variables.get("*")
        for module in star if isinstance(star, list) else ():
            other = self._index.find_module(module, file.path)
            if other is not None and other is not file:
                found = self._find_in_module(other, name)
                if not isinstance(found, ExternalName) or found.name != name:
                    return found
            elif other is None:
                return ExternalName(f"{module}.{name}")
        return ExternalName(name)

    def _resolve_import(self, found: Any, file: SourceFile) -> Any:  # noqa: ANN401 - any value
        if not isinstance(found, ExternalName):
            return found
        module = self._index.find_module(found.name, file.path)
        if module is not None:
            return ModuleValue(module)
        outer, _, last = found.name.rpartition(".")
        module = self._index.find_module(outer, file.path) if outer else None
        if module is not None and module is not file:
            return self._find_in_module(module, last)
        return found

    def _find_cpp_name(self, name: str, scope: Scope) -> Any:  # noqa: ANN401 - any value
        owner = scope.self_object
        if owner is not None and name in owner.fields:
            return owner.fields[name]
        outer, _, last = name.rpartition("::")
        if owner is not None:
            if not outer:
                method = self._find_method(owner.made_of, last)
                if method is not None:
                    return Callable(method[0], owner)
            elif (found := self._find_class(outer, scope)) is not None and (method := self._find_method(found, last)):
                return Callable(method[0], owner)
        found = self._find_class(name, scope)
        if found is not None:
            return found
        if (
            self._cpp is not None
            and last in self._cpp.functions
            and not name.startswith(("rclcpp::", "std::", "ros::"))
        ):
            return Callable(self._cpp.functions[last][0])
        for file in self._cpp.files if self._cpp else ():
            value = self._open_module(file, "").variables.get(last, _MISSING) if file.statements else _MISSING
            if value is not _MISSING:
                return value
        found = self._find_class(outer, scope) if outer else owner.made_of if owner is not None else None
        for statement in found.field_values if found is not None else ():
            if statement.value is not None and statement.targets[0].value == last:
                return self._evaluate(statement.value, scope)
        return ExternalName(name.replace("::", "."))

    def _expand_type(self, name: str, scope: Scope | None) -> str:
        """Return what a type of C++ is called outside: aliases and parameters of templates filled in."""
        for _ in range(8):
            plain, bracket, rest = name.partition("<")
            first, joint, last = plain.partition("::")
            owner = scope.self_object if scope is not None else None
            tables: list[Mapping[str, str]] = [scope.type_values] if scope is not None else []
            tables += [owner.type_values, owner.made_of.aliases] if owner is not None else []
            tables += [self._cpp.aliases] if self._cpp is not None else []
            for table in tables:
                if plain in table:
                    new = f"{table[plain]}{bracket}{rest}"
                    break
                if joint and first in table:
                    new = f"{table[first]}::{last}{bracket}{rest}"
                    break
            else:
                return name
            if new == name:
                return name
            name = new
        return name

    def _find_class(self, name: str, scope: Scope | None) -> SourceClass | None:
        if self._cpp is None:
            return None
        owner = scope.self_object if scope is not None else None
        around = owner.made_of.name if owner is not None else ""
        return self._cpp.find_class(self._expand_type(name, scope).partition("<")[0], around)

    def _list_bases(self, found: SourceClass) -> list[tuple[str, SourceClass | str]]:
        """Return the bases of a class as they are written, and what each is: a class, or the dotted name of another's."""
        bases: list[tuple[str, SourceClass | str]] = []
        for base in found.bases:
            if found.file.language == "python":
                first, *rest = base.split(".")
                value = self._find_in_module(found.file, first)
                for part in rest:
                    value = self._get_member(value, part)
                bases.append((base, value if isinstance(value, SourceClass) else getattr(value, "name", base)))
            else:
                name = self._expand_type(base, None)
                around = found.name.rpartition("::")[0]
                known = self._cpp.find_class(name.partition("<")[0], around) if self._cpp else None
                is_other = known is not None and known is not found
                bases.append(
                    (base, known if is_other and known is not None else name.partition("<")[0].replace("::", "."))
                )
        return bases

    def _find_method(self, found: SourceClass, name: str, depth: int = 0) -> list[Function] | None:
        if name in found.functions:
            return found.functions[name]
        for _, base in self._list_bases(found) if depth < 10 else ():  # noqa: PLR2004 - no family of classes is deeper
            method = self._find_method(base, name, depth + 1) if isinstance(base, SourceClass) else None
            if method is not None:
                return method
        return None

    def _is_node_class(self, found: SourceClass, depth: int = 0) -> bool:
        return depth < 10 and any(  # noqa: PLR2004 - as above
            self._is_node_class(base, depth + 1)
            if isinstance(base, SourceClass)
            else base in NODE_CLASSES or base.endswith((".Node", "LifecycleNode"))
            for _, base in self._list_bases(found)
        )

    def _has_foreign_base(self, found: SourceClass, depth: int = 0) -> bool:
        return depth < 10 and any(  # noqa: PLR2004 - as above
            self._has_foreign_base(base, depth + 1)
            if isinstance(base, SourceClass)
            else base not in {"object", "ABC"} and base not in NODE_CLASSES and not base.startswith("std.")
            for _, base in self._list_bases(found)
        )

    def _construct_class(
        self,
        found: SourceClass,
        arguments: list[Any],
        keywords: Mapping[str, Any],
        span: Span,
        types: Sequence[str] = (),
    ) -> WalkedObject:
        made = WalkedObject(found, type_values=dict(zip(found.type_parameters, types, strict=False)))
        before = self.current_node
        if self._is_node_class(found):
            made.node, made.is_node = self.make_node(span), True
            made.node.is_lifecycle = self._is_lifecycle(found)
        else:
            given = [self.find_node(each) for each in (*arguments, *keywords.values())]
            made.node = next((each for each in given if each is not None), self.current_node)
        self.current_node = made.node
        self._construct_base(made, found, arguments, keywords)
        for name in self._list_hooks(found):
            method = self._find_method(found, name)
            if method is not None:
                self._pending.append((Callable(method[0], made), made.node))
        self.current_node = before if before is not None else made.node
        return made

    def _is_lifecycle(self, found: SourceClass, depth: int = 0) -> bool:
        return depth < 10 and any(  # noqa: PLR2004 - as above
            self._is_lifecycle(base, depth + 1) if isinstance(base, SourceClass) else "ifecycle" in base
            for _, base in self._list_bases(found)
        )

    def _list_hooks(self, found: SourceClass) -> list[str]:
        names = list(found.functions)
        for _, base in self._list_bases(found):
            names += self._list_hooks(base) if isinstance(base, SourceClass) and base is not found else []
        if self._has_foreign_base(found):
            # What another package calls of a class that it knows by its base is not to be seen here: any of it may be.
            last = found.name.rpartition("::")[2]
            return [name for name in dict.fromkeys(names) if name not in {last, f"~{last}", "__init__"}]
        return [name for name in dict.fromkeys(names) if name in HOOKS]

    def _construct_base(
        self, made: WalkedObject, found: SourceClass, arguments: list[Any], keywords: Mapping[str, Any]
    ) -> None:
        scope = Scope(found.file, self._open_module(found.file, "") if found.file.language == "python" else None, made)
        self._walk_fields(found, made, scope)
        if found.file.language == "python":
            method = self._find_method(found, "__init__")
            if method is not None:
                self._call(Callable(method[0], made), arguments, keywords)
            elif made.is_node:
                self._name_node(made, arguments, keywords)
            return
        constructors = found.functions.get(found.name.rpartition("::")[2], [])
        if constructors:
            self._call(Callable(_choose_overload(constructors, len(arguments)), made), arguments, keywords)
        else:
            for _, base in self._list_bases(found):
                if isinstance(base, SourceClass):
                    self._construct_base(made, base, [], {})
            if made.is_node:
                self._name_node(made, arguments, keywords)

    def _walk_fields(self, found: SourceClass, made: WalkedObject, scope: Scope) -> None:
        for statement in found.field_values:
            if statement.kind == "set" and statement.value is not None:
                value = self._evaluate(statement.value, scope)
                for target in statement.targets:
                    if target.kind == "name":
                        made.fields.setdefault(target.value, value)
        for name, type_name in found.fields.items():
            full_type = self._expand_type(type_name.rstrip("*"), scope)
            if not type_name.endswith("*") and name not in made.fields:
                value = self.make_external(full_type, [], {}, Span.of_file(found.file.shown), is_member=True)
                if value is not None:
                    made.fields[name] = value

    def _name_node(self, made: WalkedObject, arguments: list[Any], keywords: Mapping[str, Any]) -> None:
        if made.node is not None and made.is_node:
            self.name_node(made.node, arguments, keywords, is_cpp=made.made_of.file.language == "cpp")

    # Statements

    def _walk(self, statements: Sequence[Statement], scope: Scope) -> bool:
        """Walk through statements; return whether the function ends there."""
        for statement in statements:
            self._steps += 1
            if self._steps > _MAX_STEPS:
                self.is_cut = True
                return True
            if self._walk_statement(statement, scope):
                return True
        return False

    def _walk_statement(self, statement: Statement, scope: Scope) -> bool:
        value = statement.value
        if statement.kind == "do" and value is not None:
            self._evaluate(value, scope)
        elif statement.kind == "set" and value is not None:
            self._walk_setting(statement, value, scope)
        elif statement.kind == "local":
            self._walk_local(statement, scope)
        elif statement.kind == "import":
            for local, meaning in statement.names:
                if local == "*":
                    scope.variables["*"] = [*(scope.variables.get("*") or []), meaning.removesuffix(".*")]
                else:
                    scope.variables[local] = ExternalName(meaning)
        elif statement.kind == "loop" and value is not None:
            items = self._list_items(self._evaluate(value, scope))
            rounds = [UnknownText(value.text, self._span(value))] if items is None else items
            self.conditions += items is None
            for item in rounds[:_MAX_ROUNDS]:
                self._assign(statement.targets[0], item, scope)
                if self._walk(statement.body, scope) and self._steps > _MAX_STEPS:
                    break
            self.conditions -= items is None
        elif statement.kind == "branch" and value is not None:
            return self._walk_branch(statement, value, scope)
        elif statement.kind == "return":
            scope.returned.append(None if value is None else self._evaluate(value, scope))
            return True
        return False

    def _walk_setting(self, statement: Statement, value: Expression, scope: Scope) -> None:
        result = self._evaluate(value, scope)
        full_type = self._expand_type(statement.type_name, scope) if statement.type_name else ""
        if full_type.endswith("NodeHandle") and isinstance(settle(result), str):
            result = self.make_external(full_type, [result], {}, self._span(value)) or result
        for target in statement.targets:
            self._assign(target, result, scope, is_local=bool(statement.type_name))

    def _walk_local(self, statement: Statement, scope: Scope) -> None:
        value = statement.value
        if value is None:
            self._assign(statement.targets[0], UnknownText("", Span.of_file(scope.file.shown)), scope, is_local=True)
            return
        arguments = [self._evaluate(each, scope) for each in value.parts[1:]]
        if statement.type_name != "(initializer)":
            made = self._construct(statement.type_name, arguments, value, scope)
            self._assign(statement.targets[0], made, scope, is_local=True)
            return
        owner, name = scope.self_object, value.parts[0].value
        if owner is None:
            return
        holder = self._find_field_owner(owner.made_of, name)
        if holder is not None:
            type_name = holder.fields[name]
            owner.fields[name] = self._construct(
                type_name.rstrip("*"), arguments, value, scope, is_held=type_name.endswith("*")
            )
            return
        base = self._find_class(name.partition("<")[0], scope)
        if base is not None:
            plain = base.name.rpartition("::")[2]
            if base is owner.made_of:
                constructors = [each for each in base.functions.get(plain, []) if len(each.parameters) != 0]
                if constructors and self._depth < _MAX_CALL_DEPTH:
                    self._call(Callable(_choose_overload(constructors, len(arguments)), owner), arguments, {})
            else:
                types = split_type_arguments(name.partition("<")[2].removesuffix(">"))
                owner.type_values |= dict(zip(base.type_parameters, types, strict=False))
                self._construct_base(owner, base, arguments, {})
        else:
            self._name_node(owner, arguments, {})

    def _find_field_owner(self, found: SourceClass, name: str, depth: int = 0) -> SourceClass | None:
        if name in found.fields:
            return found
        bases = [base for _, base in self._list_bases(found) if isinstance(base, SourceClass)] if depth < 10 else []  # noqa: PLR2004 - as above
        return next((owner for base in bases if (owner := self._find_field_owner(base, name, depth + 1))), None)

    def _walk_branch(self, statement: Statement, value: Expression, scope: Scope) -> bool:
        verdict = self._judge(self._evaluate(value, scope))
        if verdict is not None:
            return self._walk(statement.body if verdict else statement.otherwise, scope)
        owner = scope.self_object
        before, before_fields = dict(scope.variables), dict(owner.fields) if owner else {}
        self.conditions += 1
        ends = self._walk(statement.body, scope)
        after, after_fields = scope.variables, dict(owner.fields) if owner else {}
        scope.variables = before
        if owner is not None:
            owner.fields = before_fields
        ends_otherwise = self._walk(statement.otherwise, scope)
        self.conditions -= 1
        if ends and not ends_otherwise:
            return False
        if ends_otherwise and not ends:
            scope.variables = after
            if owner is not None:
                owner.fields = after_fields
            return False
        _join_variables(scope.variables, after)
        if owner is not None:
            _join_variables(owner.fields, after_fields)
        return ends and ends_otherwise

    def _judge(self, value: Any) -> bool | None:  # noqa: ANN401 - any value
        settled = settle(value)
        if settled is None or isinstance(settled, bool | int | float | str | list | dict):
            return bool(settled)
        return None

    def _assign(self, target: Expression, value: Any, scope: Scope, *, is_local: bool = False) -> None:  # noqa: ANN401 - any value
        if target.kind == "list":
            items = self._list_items(value)
            for place, inner in enumerate(target.parts):
                unknown = UnknownText(inner.text, self._span(inner))
                self._assign(inner, items[place] if items is not None and place < len(items) else unknown, scope)
        elif target.kind == "name":
            owner = scope.self_object
            is_member = owner is not None and scope.file.language == "cpp" and scope.find(target.value) is _MISSING
            if is_member and not is_local and owner is not None and self._find_field_owner(owner.made_of, target.value):
                owner.fields[target.value] = value
            else:
                holder: Scope | None = scope
                while scope.file.language == "cpp" and not is_local and holder and target.value not in holder.variables:
                    holder = holder.around
                (holder or scope).variables[target.value] = value
        elif target.kind == "member":
            whole = self._evaluate(target.parts[0], scope)
            if isinstance(whole, WalkedObject):
                whole.fields[target.value] = value
        elif target.kind == "index":
            whole, key = (settle(self._evaluate(part, scope)) for part in target.parts[:2])
            if isinstance(whole, dict) and isinstance(key, str | int):
                whole[key] = value

    # Expressions

    def _span(self, expression: Expression) -> Span:
        file = self.file.shown if self.file is not None else ""
        return Span(file, expression.line, expression.column, expression.line, expression.column + 1)

    def _evaluate(self, expression: Expression, scope: Scope) -> Any:  # noqa: ANN401, PLR0911 - one for each form
        self._steps += 1
        kind, parts = expression.kind, expression.parts
        if self._steps > _MAX_STEPS:
            return UnknownText(expression.text, self._span(expression))
        if kind == "value":
            return expression.value
        if kind == "name":
            found = self._find_name(str(expression.value), scope)
            if isinstance(found, ExternalName):
                qos = read_qos_name(found.name)
                return qos if qos is not None else ExternalName(found.name, expression.type_arguments)
            return found
        if kind == "member":
            return self._get_member(self._evaluate(parts[0], scope), str(expression.value), expression)
        if kind == "call":
            return self._evaluate_call(expression, scope)
        if kind == "join":
            values = [self._evaluate(part, scope) for part in parts]
            if all(isinstance(settle(each), int | float) for each in values) and values:
                return sum(settle(each) for each in values)
            if all(isinstance(settle(each), list) for each in values) and values:
                return [item for each in values for item in settle(each)][:_MAX_ROUNDS]
            joined = join_texts(values)
            return (
                joined
                if not isinstance(joined, str) or len(joined) < _MAX_TEXT
                else UnknownText(expression.text, self._span(expression))
            )
        if kind == "list":
            return [self._evaluate(part, scope) for part in parts]
        if kind == "dict":
            half = len(parts) // 2
            keys = [settle(self._evaluate(part, scope)) for part in parts[:half]]
            values = [self._evaluate(part, scope) for part in parts[half:]]
            return {key: value for key, value in zip(keys, values, strict=True) if isinstance(key, str | int | float)}
        if kind == "index":
            whole, key = (settle(self._evaluate(part, scope)) for part in parts[:2])
            if isinstance(whole, dict) and isinstance(key, str | int) and key in whole:
                return whole[key]
            if isinstance(whole, list) and isinstance(key, int) and -len(whole) <= key < len(whole):
                return whole[key]
            if isinstance(whole, ParameterValue | ExternalName):
                return UnknownText(expression.text, self._span(expression))
        if kind == "choice":
            verdict = self._judge(self._evaluate(parts[0], scope))
            if verdict is not None:
                return self._evaluate(parts[1 if verdict else 2], scope)
            return Alternatives(tuple(self._evaluate(part, scope) for part in parts[1:]))
        if kind == "lambda" and expression.body is not None:
            return Callable(expression.body, scope.self_object, scope)
        return UnknownText(expression.text, self._span(expression))

    def _get_member(self, whole: Any, name: str, expression: Expression | None = None) -> Any:  # noqa: ANN401, PLR0911 - any value
        if isinstance(whole, WalkedObject):
            if name in whole.fields:
                return whole.fields[name]
            method = self._find_method(whole.made_of, name)
            if method is not None:
                return Callable(method[0], whole)
        elif isinstance(whole, ModuleValue):
            found = self._find_in_module(whole.file, name)
            inner = self._index.find_module(f"{whole.file.path.parent.name}.{name}", whole.file.path)
            return ModuleValue(inner) if isinstance(found, ExternalName) and inner is not None else found
        elif isinstance(whole, SourceClass):
            for statement in whole.field_values:
                if statement.value is not None and statement.targets and statement.targets[0].value == name:
                    return self._evaluate(statement.value, self._open_module(whole.file, ""))
            method = self._find_method(whole, name)
            return Callable(method[0]) if method is not None else UnknownText(name, Span.of_file(whole.file.shown))
        elif isinstance(whole, ExternalName):
            found = self._resolve_import(ExternalName(f"{whole.name}.{name}"), self.file) if self.file else None
            qos = read_qos_name(name)
            return qos if qos is not None else found or ExternalName(f"{whole.name}.{name}")
        elif isinstance(whole, ParameterValue) and name in _PASSED_THROUGH | {"value"}:
            return whole
        elif isinstance(whole, dict) and name in whole:
            return whole[name]
        text, span = (expression.text, self._span(expression)) if expression else (name, Span.of_file(""))
        return UnknownText(text, span)

    def _list_items(self, value: Any) -> list[Any] | None:  # noqa: ANN401 - any value
        settled = settle(value)
        if isinstance(settled, list):
            return settled
        return list(settled) if isinstance(settled, dict) else None

    # Calls

    def _evaluate_call(self, expression: Expression, scope: Scope) -> Any:  # noqa: ANN401 - any value
        called = expression.parts[0]
        if called.kind == "name" and called.value in OPERATIONS.keys() | {"and", "or", "not", "%", "for", "<<"}:
            return self._evaluate_operation(str(called.value), expression, scope)
        arguments = [self._evaluate(each, scope) for each in expression.parts[1:]]
        keywords = {name: self._evaluate(each, scope) for name, each in expression.keywords.items()}
        whole: Any = _MISSING
        name = str(called.value).replace("::", ".")
        if called.kind == "member":
            whole = self._evaluate(called.parts[0], scope)
        elif (
            called.kind == "name"
            and scope.file.language == "cpp"
            and scope.find("self") is not _MISSING
            and "." not in name
        ):
            whole = scope.find("self")
        types = [self._expand_type(each, scope) for each in expression.type_arguments]
        place = (self._span(expression), expression)
        if (
            called.kind == "member"
            and called.parts[0].kind == "call"
            and name in {"__init__"}
            and called.parts[0].parts[0].value == "super"
        ):
            return self._call_super(arguments, keywords, scope)
        target = (
            self._evaluate(called, scope)
            if whole is _MISSING or called.kind == "member"
            else self._find_name(name, scope)
        )
        if isinstance(target, Callable):
            shares_self = (
                target.self_object is None and target.function.owner and arguments and not target.function.is_static
            )
            if shares_self and isinstance(arguments[0], WalkedObject) and target.function.file.language == "python":
                return self._call(Callable(target.function, arguments[0]), arguments[1:], keywords)
            better = self._find_overload(target, len(arguments))
            return self._call(better, arguments, keywords, expression.parts[1:], scope, types)
        if isinstance(target, SourceClass):
            return self._construct_class(target, arguments, keywords, place[0], types)
        if (
            isinstance(target, ExternalName)
            and target.name.endswith(".__init__")
            and arguments
            and isinstance(arguments[0], WalkedObject)
        ):
            self._name_node(arguments[0], arguments[1:], keywords)
            return None
        short = name.rpartition(".")[2]
        if name.endswith(".make_shared") and scope.file.language == "cpp" and not name.startswith(("std.", "boost.")):
            return self._construct(name.removesuffix(".make_shared").replace(".", "::"), arguments, expression, scope)
        if short in _MAKERS and scope.file.language == "cpp":
            if types:
                return self._construct(types[0], arguments, expression, scope)
            if short == "reset" and called.kind == "member" and arguments:
                self._assign(called.parts[0], arguments[0], scope)
            return None
        result = self.read_call(
            whole if whole is not _MISSING else None, target, short, arguments, keywords, types, place[0]
        )
        if result is not NotImplemented:
            return self._take_outputs(result, expression, scope)
        self._mention([*arguments, *keywords.values()])
        return self._evaluate_plain_call(whole, target, name, arguments, keywords, expression, scope)

    def _take_outputs(self, result: Any, expression: Expression, scope: Scope) -> Any:  # noqa: ANN401 - any value
        """Return what a call gives; what it writes into one of its arguments is assigned."""
        self._mention(self.last_arguments)
        if isinstance(result, tuple):
            place, value = result
            if place < len(expression.parts) - 1:
                self._assign(expression.parts[place + 1], value, scope)
            return (
                True
                if settle(value) is not None and not isinstance(settle(value), UnknownText)
                else UnknownText(expression.text, self._span(expression))
            )
        return result

    def _mention(self, values: Sequence[Any]) -> None:
        """Remember functions that are handed over: somebody will call them."""
        for value in values:
            if isinstance(value, Callable):
                self._pending.append((value, self.find_node(value.self_object) or self.current_node))
            elif isinstance(value, list):
                self._mention(value)

    def _call_super(self, arguments: list[Any], keywords: Mapping[str, Any], scope: Scope) -> None:
        owner, here = scope.self_object, scope.variables.get("(class)")
        for _, base in self._list_bases(here) if owner is not None and isinstance(here, SourceClass) else ():
            if isinstance(base, SourceClass) and owner is not None:
                method = self._find_method(base, "__init__")
                if method is not None:
                    self._call(Callable(method[0], owner), arguments, keywords)
                    return
            elif owner is not None and owner.is_node:
                self._name_node(owner, arguments, keywords)
                return

    def _find_overload(self, target: Callable, count: int) -> Callable:
        owner = target.self_object
        functions = self._find_method(owner.made_of, target.function.name) if owner is not None else None
        if functions is None and target.function.file.language == "cpp" and self._cpp is not None:
            functions = self._cpp.functions.get(target.function.name)
        if functions is None or target.function not in functions or len(functions) == 1:
            return target
        return Callable(_choose_overload(functions, count), owner, target.around)

    def _call(  # noqa: PLR0913 - what is called, with what, and from where
        self,
        target: Callable,
        arguments: list[Any],
        keywords: Mapping[str, Any],
        expressions: Sequence[Expression] = (),
        caller: Scope | None = None,
        types: Sequence[str] = (),
    ) -> Any:  # noqa: ANN401 - any value
        function = target.function
        unknown = UnknownText(f"{function.name}(...)", Span.of_file(function.file.shown))
        if self._depth >= _MAX_CALL_DEPTH or self.open_functions.count(function) > 1:
            return unknown
        self._seen_functions.add((id(function), id(target.self_object)))
        around = target.around or (self._open_module(function.file, "") if function.file.language == "python" else None)
        scope = Scope(function.file, around, target.self_object)
        scope.type_values = dict(zip(function.type_parameters, types, strict=False))
        parameters = list(function.parameters)
        owner = target.self_object
        if owner is not None:
            scope.variables["self"] = owner
            if function.file.language == "python" and function.owner and not function.is_static and parameters:
                scope.variables[parameters.pop(0).name] = owner
                found = function.file.classes.get(function.owner)
                scope.variables["(class)"] = found or owner.made_of
        before = (self.file, self.current_node)
        self.file = function.file
        if owner is not None and owner.node is not None:
            self.current_node = owner.node
        for place, parameter in enumerate(parameters):
            if place < len(arguments):
                scope.variables[parameter.name] = arguments[place]
            elif parameter.name in keywords:
                scope.variables[parameter.name] = keywords[parameter.name]
            elif parameter.default is not None:
                scope.variables[parameter.name] = self._evaluate(parameter.default, scope)
            else:
                scope.variables[parameter.name] = UnknownText(parameter.name, Span.of_file(function.file.shown))
        self._depth += 1
        self.open_functions.append(function)
        self._walk(function.body, scope)
        self.open_functions.pop()
        self._depth -= 1
        self.file, node = before
        self.current_node = node or self.current_node
        for place, parameter in enumerate(parameters[: len(expressions)]):
            if parameter.type_name.endswith("&") and caller is not None:
                self._assign(expressions[place], scope.variables[parameter.name], caller)
        returned = scope.returned
        return None if not returned else returned[0] if len(returned) == 1 else Alternatives(tuple(returned))

    def _construct(
        self, type_name: str, arguments: list[Any], expression: Expression, scope: Scope, *, is_held: bool = False
    ) -> Any:  # noqa: ANN401 - any value
        full_type = self._expand_type(type_name, scope)
        plain = full_type.partition("<")[0].replace("::", ".")
        is_pointer = plain.endswith((".shared_ptr", ".unique_ptr", "Ptr", ".weak_ptr")) or is_held
        if is_pointer or (
            len(arguments) == 1
            and isinstance(arguments[0], NodeHandle)
            and not arguments[0].kind
            and "NodeHandle" in plain
        ):
            return arguments[0] if arguments else None
        found = self._find_class(full_type.partition("<")[0], scope)
        types = split_type_arguments(full_type.partition("<")[2].removesuffix(">"))
        types = tuple(self._expand_type(each, scope) for each in types)
        if found is not None:
            same = len(arguments) == 1 and isinstance(arguments[0], WalkedObject) and arguments[0].made_of is found
            return arguments[0] if same else self._construct_class(found, arguments, {}, self._span(expression), types)
        if plain in _STREAMS:
            return TextStream()
        made = self.make_external(full_type, arguments, {}, self._span(expression))
        if made is not None:
            self._mention(arguments)
            return made
        self._mention(arguments)
        if plain.endswith(("vector", "array", "list")) and arguments:
            return arguments[0] if len(arguments) == 1 and isinstance(arguments[0], list) else arguments
        if plain.endswith("string"):
            return (
                arguments[0]
                if len(arguments) == 1
                else ""
                if not arguments
                else UnknownText(expression.text, self._span(expression))
            )
        return arguments[0] if len(arguments) == 1 else UnknownText(expression.text, self._span(expression))

    def _evaluate_operation(self, sign: str, expression: Expression, scope: Scope) -> Any:  # noqa: ANN401, PLR0911 - one for each sign
        unknown = UnknownText(expression.text, self._span(expression))
        if sign == "for":
            items = self._list_items(self._evaluate(expression.parts[1], scope))
            inner = Scope(scope.file, scope, scope.self_object)
            found = []
            for item in items[:_MAX_ROUNDS] if items is not None else ():
                self._assign(expression.parts[2], item, inner)
                found.append(self._evaluate(expression.parts[3], inner))
            return unknown if items is None else found
        values = [self._evaluate(each, scope) for each in expression.parts[1:]]
        if sign == "<<":
            if isinstance(values[0], TextStream):
                values[0].parts.append(values[1])
                return values[0]
            return unknown
        verdicts = [self._judge(each) for each in values]
        if sign == "not":
            return unknown if verdicts[0] is None else not verdicts[0]
        if sign in {"and", "or"}:
            decisive = sign == "or"
            if decisive in verdicts:
                return values[verdicts.index(decisive)] if sign == "or" and verdicts[0] is not None else decisive
            return unknown if None in verdicts else values[-1]
        settled = [settle(each) for each in values]
        if sign == "%":
            texts = settled[1] if isinstance(settled[1], list) else [values[1]]
            return _fill_format(settled[0], "%s", texts, unknown) if isinstance(settled[0], str) else unknown
        if sign in {"/", "*", "-"} and not all(isinstance(each, int | float) for each in settled):
            return join_texts([values[0], "/", values[1]]) if sign == "/" and isinstance(settled[0], str) else unknown
        if any(not (each is None or isinstance(each, str | int | float | bool | list | dict)) for each in settled):
            return unknown
        try:
            return OPERATIONS[sign](*settled)
        except (TypeError, ArithmeticError, IndexError):
            return unknown

    def _evaluate_plain_call(  # noqa: PLR0911, PLR0913, C901, PLR0912 - one for each function of the languages
        self,
        whole: Any,
        target: Any,
        name: str,
        arguments: list[Any],
        keywords: Mapping[str, Any],
        expression: Expression,
        scope: Scope,
    ) -> Any:  # noqa: ANN401 - any value
        """Return what a function gives that neither the workspace nor ROS has."""
        unknown = UnknownText(expression.text, self._span(expression))
        short = name.rpartition(".")[2]
        full_name = target.name if isinstance(target, ExternalName) else name
        settled = settle(whole)
        for made in (make_qos(full_name, arguments, keywords), make_seconds(full_name, arguments, keywords)):
            if made is not None:
                return made
        if short in {"resolve_topic_name", "resolve_service_name", "resolveName", "resolve_name"} and arguments:
            # What comes of it is what comes of the name itself: ROS resolves it once more.
            return arguments[0]
        if short == "bind" and arguments and isinstance(arguments[0], Callable):
            return arguments[0]
        if isinstance(whole, TextStream) and short == "str":
            return join_texts(whole.parts)
        if short == "setattr" and len(arguments) == 3 and isinstance(arguments[0], WalkedObject):  # noqa: PLR2004 - object, name, value
            if isinstance(settle(arguments[1]), str):
                arguments[0].fields[settle(arguments[1])] = arguments[2]
            return None
        if short == "getattr" and len(arguments) > 1 and isinstance(settle(arguments[1]), str):
            return self._get_member(arguments[0], settle(arguments[1]), expression)
        if isinstance(settled, str):
            if short == "format":
                return _fill_format(settled, "{}", arguments, unknown) if not keywords else unknown
            if short in {"lower", "upper", "strip", "lstrip", "rstrip"}:
                text = arguments[0] if arguments and isinstance(arguments[0], str) else None
                return (
                    getattr(settled, short)()
                    if text is None
                    else getattr(settled, short)(text)
                    if short.endswith("strip")
                    else unknown
                )
            if short == "join" and arguments and isinstance(arguments[0], list):
                items = arguments[0]
                return join_texts(
                    [part for place, item in enumerate(items) for part in ((settled, item) if place else (item,))]
                )
            if short == "empty":
                return not settled
            if short in {"startswith", "endswith"} and arguments and isinstance(settle(arguments[0]), str):
                return getattr(settled, short)(settle(arguments[0]))
        if isinstance(settled, dict) and short in {"items", "values", "keys"}:
            return {"items": [[key, value] for key, value in settled.items()], "values": list(settled.values())}.get(
                short, list(settled)
            )
        if isinstance(settled, dict) and short == "get" and arguments:
            key = settle(arguments[0])
            return (
                settled.get(key, arguments[1] if len(arguments) > 1 else None)
                if isinstance(key, str | int)
                else unknown
            )
        if isinstance(settled, list) and short in {"append", "push_back", "emplace_back"} and arguments:
            settled.append(arguments[0])
            return None
        if short == "enumerate" and arguments and (items := self._list_items(arguments[0])) is not None:
            return [[place, item] for place, item in enumerate(items)]
        if short == "zip" and arguments and all(self._list_items(each) is not None for each in arguments):
            return [list(each) for each in zip(*(self._list_items(each) or [] for each in arguments), strict=False)]
        if short == "range" and arguments and all(isinstance(settle(each), int) for each in arguments):
            numbers = [settle(each) for each in arguments[:3]]
            return list(range(*numbers)[:_MAX_ROUNDS]) if numbers[2:] != [0] else unknown
        if short in _PASSED_THROUGH:
            if arguments and (whole is _MISSING or isinstance(target, ExternalName)):
                return arguments[0]
            if whole is not _MISSING and not isinstance(whole, ExternalName):
                return whole
        if full_name in _WRITERS or any(word in short.lower() for word in ("param", "load", "read", "parse")):
            # What another function may write into is not known any more.
            for each in expression.parts[1:]:
                if (
                    each.kind in {"name", "member"}
                    and scope.file.language == "cpp"
                    and isinstance(self._evaluate(each, scope), str | int | float)
                ):
                    self._assign(each, unknown, scope)
        return unknown


def _choose_overload(functions: Sequence[Function], count: int) -> Function:
    """Return the function that takes so many arguments, else the first."""
    for function in functions:
        needed = sum(each.default is None for each in function.parameters)
        if needed <= count <= len(function.parameters):
            return function
    return functions[0]


def _join_variables(variables: dict[str, Any], others: Mapping[str, Any]) -> None:
    for name, value in others.items():
        mine = variables.get(name, _MISSING)
        if mine is _MISSING:
            variables[name] = value
        elif mine is not value and (type(mine) is not type(value) or mine != value):
            is_nothing = mine is None or (isinstance(mine, UnknownText) and not mine.text)
            variables[name] = value if is_nothing else mine if value is None else Alternatives((value, mine))


def _fill_format(text: str, mark: str, values: Sequence[Any], unknown: UnknownText) -> Any:  # noqa: ANN401 - a text, or its parts
    pieces = text.split(mark)
    if len(pieces) != len(values) + 1 or ("%" if mark == "%s" else "{") in "".join(pieces):
        return unknown
    return join_texts([part for piece, value in zip(pieces, [*values, ""], strict=True) for part in (piece, value)])
