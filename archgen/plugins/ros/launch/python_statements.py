"""Follow the statements of launch files in Python: names that are given values, conditions, loops, functions.

Work out comprehensions in launch files in Python over what is known.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from archgen.plugin import replace
from archgen.plugin.importing import ForeignFileError
from archgen.plugins.ros.launch.launch_entities import LaunchAction, LaunchCondition
from archgen.plugins.ros.launch.launch_values import LaunchValue, Substitution, UnknownValue, is_plain
from archgen.plugins.ros.launch.python_expressions import MAX_DEPTH, ExpressionReader
from archgen.plugins.ros.launch.python_parsing import parse_launch_module
from archgen.plugins.ros.launch.python_values import CallArguments, FunctionValue, ImportedName, ModuleValue, NameScope

if TYPE_CHECKING:
    from archgen.plugins.ros.launch.launch_run import LaunchRun


_MAX_DEPTH = 4
_MAX_PARTS = 10
_MAX_CONTAINERS = 1_000
_ABSENT = object()

Container = list[LaunchValue] | dict[LaunchValue, LaunchValue]


class BranchRecord:
    """The lists and dicts that names stand for in front of a condition, and what each of its ways makes of them."""

    def __init__(self, scope: NameScope) -> None:
        self._containers = _list_containers(scope)
        self._before: list[Container] = []
        self.size = len(self._containers) + sum(map(len, self._containers))
        """How much is to be remembered: containers, and what is in them."""

    def begin(self) -> None:
        """Remember what is in the containers."""
        self._before = [each.copy() for each in self._containers]

    def take_outcome(self) -> list[Container]:
        """Return what is in the containers, which are as they were in front of the condition from now on."""
        outcome = [each.copy() for each in self._containers]
        self.put_back(self._before)
        return outcome

    def put_back(self, contents: Sequence[Container]) -> None:
        """Fill the containers with what was in them."""
        for container, content in zip(self._containers, contents, strict=True):
            if isinstance(container, list):
                container[:] = content
            elif isinstance(content, dict):
                container.clear()
                container.update(content)

    def merge_outcomes(self, first: Sequence[Container], second: Sequence[Container], test: UnknownValue) -> None:
        """Fill the containers with what both ways left in them."""
        merged: list[Container] = []
        for one, other in zip(first, second, strict=True):
            if isinstance(one, list) and isinstance(other, list):
                merged.append(_merge_lists(one, other, test))
            elif isinstance(one, dict) and isinstance(other, dict):
                merged.append(_merge_names(one, other, test))
        self.put_back(merged)


def _merge_names(
    first: dict[LaunchValue, LaunchValue], second: dict[LaunchValue, LaunchValue], test: UnknownValue
) -> dict[LaunchValue, LaunchValue]:
    """Return values by their names as both ways of a condition leave them."""
    return {
        name: _merge_values(first.get(name, _ABSENT), second.get(name, _ABSENT), test) for name in {**first, **second}
    }


def _merge_values(first: LaunchValue, second: LaunchValue, test: UnknownValue) -> LaunchValue:
    if _is_same(first, second):
        return first
    if isinstance(first, list) and isinstance(second, list):
        return _merge_lists(first, second, test)
    if isinstance(first, LaunchAction) and isinstance(second, LaunchAction):
        # Each of them knows when it counts.
        return [first, second]
    for one, other in ((first, second), (second, first)):
        if (other is None or other is _ABSENT) and (isinstance(one, UnknownValue) or _holds_actions(one)):
            return one
    return _make_unknown(test)


def _merge_lists(first: list[LaunchValue], second: list[LaunchValue], test: UnknownValue) -> list[LaunchValue]:
    """Return what both ways have in common, actions, which know when they count, and one unknown value for the rest."""
    start = 0
    while start < min(len(first), len(second)) and _is_same(first[start], second[start]):
        start += 1
    kept = first[:start]
    rest = [*first[start:], *second[start:]]
    seen = {id(item) for item in kept}
    for item in rest:
        if _holds_actions(item) and id(item) not in seen:
            kept.append(item)
            seen.add(id(item))
    if not all(map(_holds_actions, rest)):
        kept.append(replace(_make_unknown(test), is_several=True))
    return kept


def _make_unknown(test: UnknownValue) -> UnknownValue:
    return UnknownValue(f"either way of `if {test.reason}`", test.line, test.file)


def _holds_actions(value: LaunchValue) -> bool:
    return isinstance(value, LaunchAction) or (
        isinstance(value, list | tuple) and bool(value) and all(isinstance(each, LaunchAction) for each in value)
    )


def _is_same(first: LaunchValue, second: LaunchValue, depth: int = 0) -> bool:
    """Whether two values are one, or plain and equal: nothing that may be nested without bounds is walked through."""
    if first is second:
        return True
    if isinstance(first, Substitution) and isinstance(second, Substitution):
        fits = first.kind == second.kind and len(first.parts) == len(second.parts) <= _MAX_PARTS
        return fits and depth < _MAX_DEPTH and all(map(_is_same, first.parts, second.parts, [depth + 1] * _MAX_PARTS))
    return type(first) is type(second) and is_plain(first) and bool(first == second)


def _list_containers(scope: NameScope) -> list[Container]:
    found: dict[int, Container] = {}
    pending: list[tuple[LaunchValue, int]] = []
    outer: NameScope | None = scope
    while outer is not None:
        pending += [(value, 0) for value in outer.values.values()]
        outer = outer.outer
    while pending and len(found) < _MAX_CONTAINERS:
        value, depth = pending.pop()
        if isinstance(value, list | dict) and depth < _MAX_DEPTH and id(value) not in found:
            found[id(value)] = value
            pending += [(inner, depth + 1) for inner in (value.values() if isinstance(value, dict) else value)]
    return list(found.values())


Ending = Literal["", "return", "break", "continue", "raise"]
"""How a block ended."""
_JUMPS: dict[type[ast.stmt], Ending] = {ast.Raise: "raise", ast.Break: "break", ast.Continue: "continue"}
_STEPS_OF_A_SCOPE = 20
_STEPS_OF_A_ROUND = 16
"""Nobody counts in a launch file: a loop that knows no end is to end soon."""
_REMEMBERED_IN_A_STEP = 2


class StatementReader(ExpressionReader):
    """Follows statements, and comprehensions. What a function may return stands in its scope."""

    def __init__(self, path: Path, text: str, run: LaunchRun) -> None:
        super().__init__(path, text, run)
        self._folders: list[str] = []
        self.modules: dict[Path, NameScope] = {}
        """The modules beside the file that were read, for all of them together."""
        self.conditions: list[LaunchCondition] = []
        """The conditions around that are not known: what is made there counts only if they hold."""
        self._follows_both = True
        """Whether the budget still has what both ways of a condition take that is not known."""
        self._statement_runners: dict[type[ast.stmt], Callable[[Any, NameScope], Ending]] = {
            ast.Assign: self._run_assignment,
            ast.AnnAssign: self._run_annotated_assignment,
            ast.AugAssign: self._run_augmented_assignment,
            ast.Expr: self._run_expression,
            ast.Import: self._run_import,
            ast.ImportFrom: self._run_import_from,
            ast.FunctionDef: self._run_definition,
            ast.Return: self._run_return,
            **dict.fromkeys(_JUMPS, self._run_jump),
            ast.With: self._run_with,
            ast.Try: self._run_try,
            ast.If: self._run_if,
            ast.For: self._run_for,
            ast.While: self._run_while,
        }
        """Who follows which kind of statement; any other kind is passed over."""
        self._expression_readers |= {
            ast.ListComp: self._read_list_comprehension,
            ast.GeneratorExp: self._read_list_comprehension,
            ast.DictComp: self._read_dict_comprehension,
        }

    def add_module_folder(self, folder: LaunchValue) -> None:
        """Look for modules in a folder, too."""
        text = self._run.context.resolve(folder)
        if isinstance(text, str):
            self._folders.append(text)

    def load_module(self, name: str) -> ModuleValue | None:
        """Return a module that lies beside the file, or in a package of the workspace as it installs them."""
        parts = name.split(".")
        if not all(part.isidentifier() for part in parts):
            return None
        # `my_setup.arguments` lies in `my_setup/my_setup/arguments.py`.
        folders = [f"$(find-pkg-share {parts[0]}){inner}" for inner in ("", "/src")]
        folders = [self._path.parent.as_posix(), *self._folders, *folders]
        texts = [f"{folder}/{'/'.join(parts)}{end}" for folder in folders for end in (".py", "/__init__.py")]
        path = next((found for text in texts if (found := self._run.files.find_file(text)) is not None), None)
        if path is None:
            return None
        if path not in self.modules:
            self.modules[path] = scope = NameScope(values={"__file__": path.as_posix(), "__name__": name})
            try:
                text, tree = parse_launch_module(self._run.files.show_path(path), self._run.read_file(path) or b"")
            except ForeignFileError as error:
                self._run.add_note("import", error.message, error.span)
            else:
                reader = type(self)(path, text, self._run)
                reader.modules, reader.depth, reader.budget = self.modules, self.depth, self.budget
                reader.run_block(tree.body, scope)
        return ModuleValue(name, self.modules[path])

    def run_block(self, statements: list[ast.stmt], scope: NameScope) -> Ending:
        """Follow statements in their order."""
        for statement in statements:
            ending = self._run_statement(statement, scope)
            if ending:
                return ending
        return ""

    def _run_statement(self, statement: ast.stmt, scope: NameScope) -> Ending:
        runner = self._statement_runners.get(type(statement))
        if runner is None or self.depth >= MAX_DEPTH or not self.pay(statement):
            return ""
        self.depth += 1
        try:
            return runner(statement, scope)
        finally:
            self.depth -= 1

    def _run_assignment(self, statement: ast.Assign, scope: NameScope) -> Ending:
        value = self.evaluate(statement.value, scope)
        for target in statement.targets:
            self.assign(target, value, scope)
        return ""

    def _run_annotated_assignment(self, statement: ast.AnnAssign, scope: NameScope) -> Ending:
        if statement.value is not None:
            self.assign(statement.target, self.evaluate(statement.value, scope), scope)
        return ""

    def _run_augmented_assignment(self, statement: ast.AugAssign, scope: NameScope) -> Ending:
        if not isinstance(statement.target, ast.Name):
            return ""
        old, new = scope.find(statement.target.id)[1], self.evaluate(statement.value, scope)
        if isinstance(old, list) and isinstance(statement.op, ast.Add):
            if self.pay_for(new, statement):
                old += new if isinstance(new, list | tuple) else [new]
        else:
            scope.values[statement.target.id] = self.combine(statement.op, old, new, statement)
        return ""

    def _run_expression(self, statement: ast.Expr, scope: NameScope) -> Ending:
        self.evaluate(statement.value, scope)
        return ""

    def _run_import(self, statement: ast.Import, scope: NameScope) -> Ending:
        for alias in statement.names:
            name = alias.name if alias.asname else alias.name.partition(".")[0]
            scope.values[alias.asname or name] = self.load_module(name) or ImportedName(name)
        return ""

    def _run_import_from(self, statement: ast.ImportFrom, scope: NameScope) -> Ending:
        module = self.load_module(statement.module or "")
        for alias in statement.names:
            is_known, value = module.scope.find(alias.name) if module else (False, None)
            if alias.name != "*":
                imported = ImportedName(f"{statement.module or ''}.{alias.name}")
                scope.values[alias.asname or alias.name] = value if is_known else imported
            elif module:
                scope.values |= module.scope.values
        return ""

    def _run_definition(self, statement: ast.FunctionDef, scope: NameScope) -> Ending:
        scope.values[statement.name] = FunctionValue(statement, scope, self)
        return ""

    def _run_return(self, statement: ast.Return, scope: NameScope) -> Ending:
        value = self.evaluate(statement.value, scope) if statement.value is not None else None
        # A list goes on to change where the way that does not return here is followed.
        scope.returned.append(list(value) if isinstance(value, list) and self.conditions else value)
        return "return"

    def _run_jump(self, statement: ast.stmt, _scope: NameScope) -> Ending:
        return _JUMPS[type(statement)]

    def _run_with(self, statement: ast.With, scope: NameScope) -> Ending:
        for item in statement.items:
            value = self.evaluate(item.context_expr, scope)
            if item.optional_vars is not None:
                self.assign(item.optional_vars, value, scope)
        return self.run_block(statement.body, scope)

    def _run_try(self, statement: ast.Try, scope: NameScope) -> Ending:
        ending = self.run_block([*statement.body, *statement.orelse], scope)
        if ending == "raise" and statement.handlers:
            ending = self.run_block(statement.handlers[0].body, scope)
        return self.run_block(statement.finalbody, scope) or ending

    def _run_if(self, statement: ast.If, scope: NameScope) -> Ending:
        test = self.evaluate(statement.test, scope)
        verdict = self.judge(test)
        if verdict is None:
            return self._run_both(statement, scope)
        if self.context is not None and not _is_plain_name_test(statement.test):
            words = "holds" if verdict else "does not hold"
            message = f"`{self.quote(statement.test).reason}` {words} by the defaults: the other way is not read"
            self.tell_noted("if", message, statement.test)
        return self.run_block(statement.body if verdict else statement.orelse, scope)

    def _run_both(self, statement: ast.If, scope: NameScope) -> Ending:
        """Follow both ways of a condition that is not known; what differs behind it is not known either."""
        test, depth = self.quote(statement.test), len(self.conditions)
        before = dict(scope.values)
        if not self._follows_both:
            return ""
        record = BranchRecord(scope)
        # Where there is too much to remember, what is looked through to see that is too much for each other condition, too.
        self._follows_both = self.pay_to_repeat(statement, record.size // _REMEMBERED_IN_A_STEP)
        if not self._follows_both:
            return ""
        record.begin()
        endings: list[Ending] = []
        names: list[dict[LaunchValue, LaunchValue]] = []
        contents: list[list[Container]] = []
        for block, is_negated in ((statement.body, False), (statement.orelse, True)):
            scope.values = dict(before)
            self.conditions.append(LaunchCondition(test, is_negated))
            endings.append(self.run_block(block, scope))
            del self.conditions[depth:]
            names.append(dict(scope.values))
            contents.append(record.take_outcome())
        gone = [ending in {"return", "raise"} for ending in endings]
        if gone[0] != gone[1]:
            # What follows is reached by the other way only.
            stays = int(gone[0])
            record.put_back(contents[stays])
            merged = names[stays]
        else:
            record.merge_outcomes(contents[0], contents[1], test)
            merged = _merge_names(names[0], names[1], test)
        scope.values = {name: value for name, value in merged.items() if isinstance(name, str)}
        first, second = endings
        if first and second:
            # Nothing behind it is reached. What may go on in another round does.
            return next(ending for ending in ("continue", "break", "return", "raise") if ending in endings)
        if first or second:
            self.conditions.append(LaunchCondition(test, is_negated=bool(first)))
        return ""

    def _run_for(self, statement: ast.For, scope: NameScope) -> Ending:
        items = self.list_loop_items(statement.iter, scope)
        if items is None:
            repeated = self.quote(statement.iter)
            self.tell_noted("for", f"how often is computed: `{repeated.reason}`; what is in it is read once", statement)
            items = [repeated]
        for item in items:
            if not self.pay_to_repeat(statement):
                break
            self.assign(statement.target, item, scope)
            depth = len(self.conditions)
            ending = self.run_block(statement.body, scope)
            del self.conditions[depth:]
            if ending == "break":
                return ""
            if ending in {"return", "raise"}:
                return ending
        return self.run_block(statement.orelse, scope)

    def _run_while(self, statement: ast.While, scope: NameScope) -> Ending:
        while self.pay_to_repeat(statement, _STEPS_OF_A_ROUND):
            verdict = self.judge(self.evaluate(statement.test, scope))
            if verdict is False:
                break
            if verdict is None:
                self.tell_noted("while", "how often is computed; what is in it is read once", statement)
            depth = len(self.conditions)
            ending = self.run_block(statement.body, scope)
            del self.conditions[depth:]
            if ending in {"return", "raise"}:
                return ending
            if ending == "break" or verdict is None:
                return ""
        return self.run_block(statement.orelse, scope)

    def call_function(self, function: FunctionValue, arguments: CallArguments, node: ast.AST) -> LaunchValue:
        """Return what a function of the file gives."""
        if not self.pay_to_repeat(node, _STEPS_OF_A_SCOPE):
            return self.quote(node)
        if isinstance(function.reader, StatementReader) and function.reader is not self:
            return function.reader.call_from(self, function, arguments)
        scope = NameScope(function.scope)
        self._bind_arguments(function, arguments, scope)
        depth = len(self.conditions)
        try:
            if isinstance(function.definition, ast.Lambda):
                return self.evaluate(function.definition.body, scope)
            self.run_block(function.definition.body, scope)
        finally:
            del self.conditions[depth:]
        returned = scope.returned
        if len(returned) > 1:
            # Several conditions that are not known led to several ends: what they start is taken together, once each.
            items = [item for value in returned for item in (value if isinstance(value, list | tuple) else [value])]
            return list({id(item): item for item in items if item is not None}.values())
        return returned[0] if returned else None

    def call_from(self, caller: StatementReader, function: FunctionValue, arguments: CallArguments) -> LaunchValue:
        """Return what a function of this module gives that another file calls."""
        before = self.context, self.conditions, self.depth
        self.context, self.conditions, self.depth = caller.context, caller.conditions, caller.depth
        try:
            return self.call_function(function, arguments, function.definition)
        finally:
            self.context, self.conditions, self.depth = before

    def _read_list_comprehension(self, node: ast.ListComp | ast.GeneratorExp, scope: NameScope) -> LaunchValue:
        scopes = self._walk_generators(node.generators, NameScope(scope), 0)
        return self.quote(node) if scopes is None else [self.evaluate(node.elt, each) for each in scopes]

    def _read_dict_comprehension(self, node: ast.DictComp, scope: NameScope) -> LaunchValue:
        scopes = self._walk_generators(node.generators, NameScope(scope), 0)
        if scopes is None:
            return self.quote(node)
        pairs = [(self.evaluate(node.key, each), self.evaluate(node.value, each)) for each in scopes]
        return dict(pairs) if all(isinstance(key, str | int) for key, _ in pairs) else self.quote(node)

    def _walk_generators(
        self, generators: list[ast.comprehension], scope: NameScope, depth: int
    ) -> list[NameScope] | None:
        """Return a scope for each round of a comprehension; None where that is not known."""
        if depth == len(generators):
            return [scope]
        generator = generators[depth]
        items = self.list_loop_items(generator.iter, scope)
        if items is None:
            return None
        found: list[NameScope] = []
        for item in items:
            inner = NameScope(scope)
            self.assign(generator.target, item, inner)
            verdicts = [self.judge(self.evaluate(test, inner)) for test in generator.ifs]
            if None in verdicts:
                return None
            if all(verdicts):
                inner_scopes = self._walk_generators(generators, inner, depth + 1)
                if inner_scopes is None or not self.pay_to_repeat(generator.target, _STEPS_OF_A_SCOPE):
                    return None
                found += inner_scopes
        return found

    def _bind_arguments(self, function: FunctionValue, arguments: CallArguments, scope: NameScope) -> None:
        declared = function.definition.args
        names = [each.arg for each in (*declared.posonlyargs, *declared.args)]
        for name, default in zip(reversed(names), reversed(declared.defaults), strict=False):
            scope.values[name] = self.evaluate(default, function.scope)
        for each, keyword_default in zip(declared.kwonlyargs, declared.kw_defaults, strict=True):
            if keyword_default is not None:
                scope.values[each.arg] = self.evaluate(keyword_default, function.scope)
        scope.values |= dict(zip(names, arguments.positional, strict=False))
        known_names = {*names, *(each.arg for each in declared.kwonlyargs)}
        scope.values |= {name: value for name, value in arguments.named.items() if name in known_names}
        if declared.vararg:
            scope.values[declared.vararg.arg] = list(arguments.positional[len(names) :])
        if declared.kwarg:
            rest = {name: value for name, value in arguments.named.items() if name not in known_names}
            scope.values[declared.kwarg.arg] = rest
        for name in sorted(known_names - scope.values.keys()):
            scope.values[name] = UnknownValue(name, function.definition.lineno, self.file)


def _is_plain_name_test(test: ast.expr) -> bool:
    """Whether a condition is `__name__ == "__main__"`."""
    return isinstance(test, ast.Compare) and isinstance(test.left, ast.Name) and test.left.id == "__name__"
