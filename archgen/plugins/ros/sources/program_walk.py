"""Walk through a program as it would run, without running it: the nodes that it makes, and what they publish, read, serve and call.

The walk begins at `main`, a script, or a class that a container loads, and follows what is constructed and called from there.
Of a condition that is not known both ways are walked. What cannot be told is unknown and stays so: nothing is guessed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from archgen.plugin.importing import Span, WorkBudget
from archgen.plugins.ros.sources import plain_calls, ros_calls
from archgen.plugins.ros.sources.program_names import PASSED_THROUGH, POINTERS, ProgramObjects, Scope, choose_overload
from archgen.plugins.ros.sources.ros_call_reading import PARAMETER_HELPERS, RosCall
from archgen.plugins.ros.sources.source_code import Expression, SourceClass, SourceFile, Statement
from archgen.plugins.ros.sources.source_index import CppCode, SourceIndex
from archgen.plugins.ros.sources.walk_values import (
    Alternatives,
    BoundFunction,
    ExternalName,
    NodeHandle,
    TextStream,
    UnknownText,
    Value,
    WalkedObject,
    join_texts,
    join_ways,
    settle,
)

_VARIABLES_COPIED_IN_A_STEP = 8
_MAX_CALL_DEPTH = 25
_MAX_BARREN_CALLS = 8
_LOOPS = frozenset({"for", "for all", "pairs"})
"""What comprehensions of Python are read as."""
_CASTS = frozenset({"reinterpret_cast", "static_cast", "dynamic_cast", "const_cast"})
"""What gives the same object as another type; of a number it may make another one."""
_RESOLVERS = frozenset({"resolve_topic_name", "resolve_service_name", "resolveName", "resolve_name"})
"""What comes of their names is what comes of the name itself: ROS resolves it once more."""
_MAKERS = frozenset({"make_shared", "make_unique", "new", "reset", "allocate_shared"})
_WRITERS = ("printf", "strcpy", "strcat", "getline", "param", "load", "read", "parse")
"""Words in names of functions of C++ that may write into their arguments."""


class ProgramWalk(ProgramObjects):
    """One walk through one program; `given` are the parameters that its node is started with."""

    def __init__(
        self, index: SourceIndex, cpp: CppCode | None, given: Mapping[str, Value], budget: WorkBudget, *, is_ros_1: bool
    ) -> None:
        super().__init__(index, cpp, given, budget, is_ros_1=is_ros_1)
        self._walked: set[tuple[int, int]] = set()
        self._barren: Counter[tuple[int, int]] = Counter()
        """How often a function was walked through in a row and gave nothing: loops over all that a node does take long."""
        self._evaluators: dict[str, Callable[[Any, Scope], Value]] = {
            "value": lambda expression, _: expression.value,
            "name": self._evaluate_name,
            "member": self._evaluate_member,
            "call": self._evaluate_call,
            "join": lambda each, scope: plain_calls.add_up([self._evaluate(part, scope) for part in each.parts]),
            "list": lambda each, scope: [self._evaluate(part, scope) for part in each.parts],
            "dict": self._evaluate_dict,
            "index": self._evaluate_index,
            "choice": self._evaluate_choice,
            "lambda": lambda each, scope: BoundFunction(each.body, scope.self_object, scope),
        }
        self._walkers: dict[str, Callable[[Statement, Scope], bool]] = {
            "do": lambda statement, scope: self._evaluate(statement.value, scope) is NotImplemented,
            "set": self._walk_setting,
            "local": self._walk_local,
            "loop": self._walk_loop,
            "branch": self._walk_branch,
            "return": self._walk_return,
            "leave": lambda _, __: True,
            "import": self._walk_import,
        }

    def expand_callback_type(self, callback: BoundFunction) -> str:
        """Return the type of what a callback takes."""
        parameters = callback.function.parameters
        scope = Scope(callback.function.file, None, callback.self_object)
        return self._expand_type(parameters[0].type_name.removesuffix("&"), scope) if parameters else ""

    # Beginnings

    def walk_script(self, file: SourceFile, function_name: str = "") -> None:
        """Walk through a script of Python, or through a module and one function of it."""
        self._script = None if function_name else file.path
        scope = self._open_module(file, "" if function_name else "__main__")
        for function in file.functions.get(function_name, ())[:1]:
            self._call(BoundFunction(function, None, scope), [], {})
        self._walk_pending()

    def walk_main(self) -> None:
        """Walk through the `main` of a program in C++."""
        for function in self._cpp.functions.get("main", ())[:1]:
            self._call(BoundFunction(function), [], {})
        self._walk_pending()

    def walk_class(self, name: str) -> bool:
        """Walk through a class that a container loads; return whether there is one."""
        found = self._cpp.find_class(name, "")
        if found is not None:
            made = self._construct_class(found, [], {}, Span.of_file(found.file.shown))
            if made.node is None:
                self.make_node(Span.of_file(found.file.shown))
            self._walk_pending()
        return found is not None

    def _walk_pending(self) -> None:
        while self._pending:
            function, node = self._pending.pop(0)
            if (id(function.function), id(function.self_object)) not in self._walked:
                self.current_node = node or self.current_node
                unknown = UnknownText("what calls it hands over", Span.of_file(function.function.file.shown))
                self._call(function, [unknown] * len(function.function.parameters), {})

    # Statements

    def _walk(self, statements: Sequence[Statement], scope: Scope) -> bool:
        """Walk through statements; return whether the function ends there."""
        return any(not self._pay() or self._walkers[each.kind](each, scope) for each in statements)

    def _walk_import(self, statement: Statement, scope: Scope) -> bool:
        for local, meaning in statement.names:
            if local == "*":
                scope.variables["*"] = [*scope.variables.get("*", ()), meaning.removesuffix(".*")]
            else:
                scope.variables[local] = ExternalName(meaning)
        return False

    def _walk_return(self, statement: Statement, scope: Scope) -> bool:
        scope.returned.append(None if statement.value is None else self._evaluate(statement.value, scope))
        return True

    def _walk_setting(self, statement: Statement, scope: Scope) -> bool:
        assert statement.value is not None  # noqa: S101 - what a setting has
        result = self._evaluate(statement.value, scope)
        for target in statement.targets:
            self._assign(target, result, scope, is_local=bool(statement.type_name))
        return False

    def _walk_loop(self, statement: Statement, scope: Scope) -> bool:
        assert statement.value is not None  # noqa: S101 - what a loop has
        items = plain_calls.list_items(self._evaluate(statement.value, scope))
        self.conditions += items is None
        for item in [self._give_up(statement.value)] if items is None else items[: plain_calls.MAX_ITEMS]:
            self._assign(statement.targets[0], item, scope)
            self._walk(statement.body, scope)
        self.conditions -= items is None
        return False

    def _walk_local(self, statement: Statement, scope: Scope) -> bool:
        value = statement.value
        if value is None:
            unknown = UnknownText("", Span.of_file(scope.file.shown))
            self._assign(statement.targets[0], unknown, scope, is_local=True)
            return False
        arguments = [self._evaluate(each, scope) for each in value.parts[1:]]
        if statement.targets:
            self._assign(
                statement.targets[0],
                self._construct(statement.type_name, arguments, value, scope),
                scope,
                is_local=True,
            )
        elif scope.self_object is not None:
            self._initialize(scope.self_object, arguments, value, scope)
        return False

    def _walk_branch(self, statement: Statement, scope: Scope) -> bool:
        verdict = plain_calls.judge(self._evaluate(statement.value, scope)) if statement.value is not None else None
        if verdict is not None:
            return self._walk(statement.body if verdict else statement.otherwise, scope)
        fields = scope.self_object.fields if scope.self_object is not None else {}
        self._pay((len(scope.variables) + len(fields)) // _VARIABLES_COPIED_IN_A_STEP)
        before = (dict(scope.variables), dict(fields))
        self.conditions += 1
        ends = self._walk(statement.body, scope)
        after = (dict(scope.variables), dict(fields))
        for current, old in zip((scope.variables, fields), before, strict=True):
            current.clear()
            current.update(old)
        ends_otherwise = self._walk(statement.otherwise, scope)
        self.conditions -= 1
        for current, other in zip((scope.variables, fields), after, strict=True):
            if ends_otherwise and not ends:
                current.clear()
                current.update(other)
            elif not ends:
                _join_variables(current, other)
        return ends and ends_otherwise

    def _assign(self, target: Expression, value: Value, scope: Scope, *, is_local: bool = False) -> None:
        if target.kind == "list":
            items = plain_calls.list_items(value) or []
            for place, inner in enumerate(target.parts):
                self._assign(inner, items[place] if place < len(items) else self._give_up(inner), scope)
        elif target.kind == "name":
            owner, holder = scope.self_object, scope.find(target.value)
            is_outer = scope.file.language == "cpp" and not is_local
            if is_outer and holder is None and owner is not None and self._find_field(owner.made_of, target.value):
                owner.fields[target.value] = value
            else:
                (holder if is_outer and holder else scope).variables[target.value] = value
        elif target.kind in {"member", "index"}:
            whole = settle(self._evaluate(target.parts[0], scope))
            key = target.value if target.kind == "member" else settle(self._evaluate(target.parts[1], scope))
            holder_fields = whole.fields if isinstance(whole, WalkedObject) else whole
            if isinstance(holder_fields, dict) and isinstance(key, str):
                holder_fields[key] = value

    # Expressions

    def _evaluate(self, expression: Expression | None, scope: Scope) -> Value:
        evaluate = self._evaluators.get(expression.kind) if expression is not None and self._pay() else None
        result = NotImplemented if evaluate is None else evaluate(expression, scope)
        return self._give_up(expression) if result is NotImplemented and expression is not None else result

    def _evaluate_name(self, expression: Expression, scope: Scope) -> Value:
        found = self._find_name(str(expression.value), scope)
        qos = ros_calls.read_qos_name(found.name) if isinstance(found, ExternalName) else None
        return found if qos is None else qos

    def _evaluate_member(self, expression: Expression, scope: Scope) -> Value:
        whole = self._evaluate(expression.parts[0], scope)
        return self._get_member(whole, str(expression.value), self._give_up(expression))

    def _evaluate_dict(self, expression: Expression, scope: Scope) -> Value:
        half = len(expression.parts) // 2
        keys = [settle(self._evaluate(part, scope)) for part in expression.parts[:half]]
        values = [self._evaluate(part, scope) for part in expression.parts[half:]]
        return {key: value for key, value in zip(keys, values, strict=True) if isinstance(key, str | int | float)}

    def _evaluate_index(self, expression: Expression, scope: Scope) -> Value:
        whole, key = (settle(self._evaluate(part, scope)) for part in expression.parts[:2])
        try:
            return whole[key] if isinstance(whole, dict | list) else NotImplemented
        except (KeyError, IndexError, TypeError):
            return NotImplemented

    def _evaluate_choice(self, expression: Expression, scope: Scope) -> Value:
        verdict = plain_calls.judge(self._evaluate(expression.parts[0], scope))
        if verdict is not None:
            return self._evaluate(expression.parts[1 if verdict else 2], scope)
        return Alternatives(tuple(self._evaluate(part, scope) for part in expression.parts[1:]))

    # Calls

    def _evaluate_call(self, expression: Expression, scope: Scope) -> Value:  # noqa: C901, PLR0911 - what may be called, in order
        called, is_cpp = expression.parts[0], scope.file.language == "cpp"
        name = str(called.value).replace("::", ".")
        if called.kind == "name" and name in plain_calls.OPERATORS | _LOOPS | {"<<"}:
            return self._evaluate_operation(name, expression, scope)
        arguments = [self._evaluate(each, scope) for each in expression.parts[1:]]
        keywords = {key: self._evaluate(each, scope) for key, each in expression.keywords.items()}
        if name == "__init__" and called.kind == "member" and called.parts[0].text.startswith("super("):
            return self._call_super(arguments, keywords, scope)
        types = [self._expand_type(each, scope) for each in expression.type_arguments]
        whole = self._evaluate(called.parts[0], scope) if called.kind == "member" else None
        if whole is None and is_cpp and ("." not in name or name.endswith("_from_this")):
            whole = scope.self_object
        if name.endswith("_from_this"):
            return whole
        target = self._find_name(str(called.value), scope) if called.kind == "name" else self._evaluate(called, scope)
        call = RosCall(whole, target, name.rpartition(".")[2], arguments, keywords, types, self._span(expression))
        if isinstance(target, BoundFunction):
            return self._call_function(target, call, expression, scope)
        if is_cpp and (own := self._find_own_method(call)) is not None:
            return self._call_function(own, call, expression, scope)
        if isinstance(target, SourceClass):
            return self._construct_class(target, arguments, keywords, call.span, types)
        if name.endswith(".make_shared") and is_cpp and not name.startswith(("std.", "boost.")):
            types = [str(called.value).removesuffix("::make_shared")]
        if call.method in _MAKERS and is_cpp:
            if types:
                return self._construct(types[0], arguments, expression, scope)
            if call.method == "reset" and called.kind == "member" and arguments:
                self._assign(called.parts[0], arguments[0], scope)
            return None
        result = self.read_call(call)
        self._mention([*arguments, *keywords.values()])
        if isinstance(result, tuple):
            place, value = result
            self._assign(expression.parts[place + 1], value, scope)
            is_unset = isinstance(settle(value), UnknownText)
            return NotImplemented if is_unset else True
        return self._call_plainly(call, expression, scope) if result is NotImplemented else result

    def _find_own_method(self, call: RosCall) -> BoundFunction | None:
        """Return the only method of this name in the program, where it is handed the node: those of rclcpp are not."""
        if not isinstance(call.whole, UnknownText) or self.find_node(call.get(0)) is None:
            return None
        owners = [found for found in self._cpp.classes.values() if len(found.functions.get(call.method, ())) == 1]
        if len(owners) != 1:
            return None
        return BoundFunction(owners[0].functions[call.method][0], WalkedObject(owners[0]))

    def _call_function(self, target: BoundFunction, call: RosCall, expression: Expression, scope: Scope) -> Value:
        function, arguments = target.function, call.arguments
        if function.name in PARAMETER_HELPERS:
            return self.read_call(call)
        if function.file.language == "python":
            is_bare = target.self_object is None and function.owner and not function.is_static
            if is_bare and arguments and isinstance(arguments[0], WalkedObject):
                return self._call(BoundFunction(function, arguments[0]), arguments[1:], call.keywords)
            return self._call(target, arguments, call.keywords)
        owner = target.self_object
        others = (
            self._find_method(owner.made_of, function.name)
            if owner is not None
            else self._cpp.functions.get(function.name)
        )
        if others and function in others:
            target = BoundFunction(choose_overload(others, len(arguments)), owner, target.around)
        variables: dict[str, Value] = {}
        returned = self._call(target, arguments, {}, call.types, variables)
        for parameter, each in zip(target.function.parameters, expression.parts[1:], strict=False):
            if parameter.type_name.endswith("&") and parameter.name in variables:
                self._assign(each, variables[parameter.name], scope)
        return returned

    def _call_super(self, arguments: list[Value], keywords: Mapping[str, Value], scope: Scope) -> None:
        holder, owner = scope.find("(class)"), scope.self_object
        for base in self._list_bases(holder.variables["(class)"]) if holder is not None and owner is not None else ():
            method = self._find_method(base, "__init__") if isinstance(base, SourceClass) else None
            if method is not None and owner is not None:
                self._call(BoundFunction(method[0], owner), arguments, keywords)
            elif owner is not None:
                self._name_node(owner, arguments, keywords)
            return

    def _call(
        self,
        target: BoundFunction,
        arguments: list[Value],
        keywords: Mapping[str, Value],
        types: Sequence[str] = (),
        variables: dict[str, Value] | None = None,
    ) -> Value:
        """Walk through a function; its variables are left in `variables`."""
        function, owner = target.function, target.self_object
        if len(self.open_functions) >= _MAX_CALL_DEPTH or self.open_functions.count(function) > 1:
            return UnknownText(f"{function.name}(...)", Span.of_file(function.file.shown))
        key = (id(function), id(owner))
        if self._barren[key] > _MAX_BARREN_CALLS:
            return None
        self._walked.add(key)
        found = sum(len(node.endpoints) for node in self.nodes)
        is_python = function.file.language == "python"
        scope = Scope(function.file, target.around or (self._open_module(function.file) if is_python else None), owner)
        scope.variables = {} if variables is None else variables
        scope.type_values = dict(zip(function.type_parameters, types, strict=False))
        parameters = list(function.parameters)
        before = (self.file, self.current_node)
        self.file = function.file
        if owner is not None:
            scope.variables["self"] = owner
            self.current_node = owner.node or self.current_node
            if is_python and function.owner and not function.is_static and parameters:
                scope.variables[parameters.pop(0).name] = owner
                scope.variables["(class)"] = function.file.classes.get(function.owner, owner.made_of)
        for place, parameter in enumerate(parameters):
            value: Value = UnknownText(parameter.name, Span.of_file(function.file.shown))
            if place < len(arguments):
                value = arguments[place]
            elif parameter.name in keywords:
                value = keywords[parameter.name]
            elif parameter.default is not None:
                value = self._evaluate(parameter.default, scope)
            scope.variables[parameter.name] = value
        self.open_functions.append(function)
        self._walk(function.body, scope)
        self.open_functions.pop()
        self.file, node = before
        self.current_node = node or self.current_node
        returned = [each for each in scope.returned if each is not None]
        is_barren = not returned and found == sum(len(each.endpoints) for each in self.nodes)
        self._barren[key] = self._barren[key] + 1 if is_barren else 0
        return None if not returned else returned[0] if len(returned) == 1 else Alternatives(tuple(returned))

    def _evaluate_operation(self, sign: str, expression: Expression, scope: Scope) -> Value:
        if sign in _LOOPS:
            return self._evaluate_comprehension(sign, expression, scope)
        values = [self._evaluate(each, scope) for each in expression.parts[1:]]
        if sign != "<<":
            return plain_calls.operate(sign, values)
        if not isinstance(values[0], TextStream):
            return NotImplemented
        values[0].parts.append(values[1])
        return values[0]

    def _evaluate_comprehension(self, sign: str, expression: Expression, scope: Scope) -> Value:
        if sign == "pairs":
            pairs = self._evaluate(expression.parts[1], scope)
            known = (
                [(settle(each[0]), each[1]) for each in pairs if isinstance(each, list)]
                if isinstance(pairs, list)
                else []
            )
            is_table = bool(known) and all(isinstance(key, str | int | float) for key, _ in known)
            return dict(known) if is_table else NotImplemented
        iterable, target, item, *wanted = expression.parts[1:]
        items = plain_calls.list_items(self._evaluate(iterable, scope))
        inner = Scope(scope.file, scope, scope.self_object)
        found: list[Value] = []
        is_known = items is not None
        self.conditions += items is None
        for each in [self._give_up(iterable)] if items is None else items[: plain_calls.MAX_ITEMS]:
            self._assign(target, each, inner)
            verdicts = [plain_calls.judge(self._evaluate(condition, inner)) for condition in wanted]
            if self.is_cut or False in verdicts:
                continue
            self.conditions += None in verdicts
            value = self._evaluate(item, inner)
            self.conditions -= None in verdicts
            is_known &= None not in verdicts
            found += value if sign == "for all" and isinstance(value, list) else [value]
        self.conditions -= items is None
        return found[: plain_calls.MAX_ITEMS] if is_known else NotImplemented

    def _call_plainly(  # noqa: C901, PLR0911, PLR0912 - a kind of functions each
        self, call: RosCall, expression: Expression, scope: Scope
    ) -> Value:
        """Return what a function gives that neither the workspace nor ROS has."""
        whole, method, arguments = call.whole, call.method, call.arguments
        full_name = ros_calls.spell_external(call.target) or method
        made = next((each for each in self._make_settings(call, full_name) if each is not None), None)
        if made is not None:
            return made
        first = arguments[0] if arguments else None
        if (
            full_name.endswith(POINTERS)
            or method in _RESOLVERS
            or (method == "bind" and isinstance(first, BoundFunction))
        ):
            return first
        if isinstance(whole, TextStream) and method == "str":
            return join_texts(whole.parts)
        if method == "getattr" and len(arguments) > 1 and isinstance(settle(arguments[1]), str):
            return self._get_member(first, settle(arguments[1]), self._give_up(expression))
        if method == "__subclasses__" and isinstance(whole, SourceClass):
            return self._list_subclasses(whole)
        if method == "__setattr__" and isinstance(whole, WalkedObject) and len(arguments) > 1:
            return plain_calls.call_plainly(None, "setattr", [whole, *arguments])
        if full_name.endswith("Node.__init__") and isinstance(first, WalkedObject):
            self._name_node(first, arguments[1:], call.keywords)
        is_function = isinstance(call.target, ExternalName)
        known = (
            plain_calls.call_plainly(None if is_function else whole, method, arguments)
            if not call.keywords
            else NotImplemented
        )
        if known is not NotImplemented:
            return known
        if method in _CASTS and isinstance(first, WalkedObject | NodeHandle):
            return first
        if method in PASSED_THROUGH and (first is not None if is_function else not isinstance(whole, ExternalName)):
            return first if is_function else whole
        if scope.file.language == "cpp" and any(word in method.lower() for word in _WRITERS):
            # What another function may write into is not known any more.
            for each, value in zip(expression.parts[1:], arguments, strict=True):
                if each.kind in {"name", "member"} and isinstance(value, str | int | float):
                    self._assign(each, self._give_up(expression), scope)
        return NotImplemented


def _join_variables(variables: dict[str, Value], others: Mapping[str, Value]) -> None:
    for name, value in others.items():
        mine = variables.get(name)
        is_nothing = mine is None or (isinstance(mine, UnknownText) and not mine.text)
        if is_nothing or value is None:
            variables[name] = value if is_nothing else mine
        elif mine is not value and (type(mine) is not type(value) or mine != value):
            variables[name] = join_ways(value, mine)
