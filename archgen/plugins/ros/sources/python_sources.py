"""Sources in Python as source code for the walk, by Python's own syntax tree."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Sequence
from pathlib import Path

from archgen.plugins.ros.launch.python_parsing import PythonRefusedError, parse_python
from archgen.plugins.ros.sources.source_code import (
    MAX_DEPTH,
    Expression,
    ExpressionKind,
    Function,
    FunctionParameter,
    SourceClass,
    SourceFile,
    Statement,
)

_MAX_TEXT = 80


def read_python_source(path: Path, shown: str, text: str, package: str) -> SourceFile:
    """Return a module; `package` is the dotted name of the package it lies in, for relative imports."""
    file = SourceFile(path, shown, "python")
    try:
        tree = parse_python(text)
    except PythonRefusedError as error:
        old = " (it is Python 2)" if "print" in error.message or "except" in error.message else ""
        file.unread.append((error.line, error.column, f"it is not read: {error.message}{old}"))
        return file
    reader = _Reader(file, package, text.splitlines())
    file.statements = reader.read_body(tree.body, 0)
    return file


class _Reader:
    """Turns syntax trees of one file into source code."""

    def __init__(self, file: SourceFile, package: str, lines: Sequence[str]) -> None:
        self._file = file
        self._package = package
        self._lines = lines

    def read_body(self, body: Iterable[ast.stmt], depth: int) -> tuple[Statement, ...]:
        """Return statements."""
        if depth > MAX_DEPTH:
            return ()
        return tuple(each for statement in body for each in self._read_statement(statement, depth + 1))

    def _read_statement(self, node: ast.stmt, depth: int) -> list[Statement]:  # noqa: C901, PLR0911, PLR0912 - one for each form
        match node:
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                function = self._read_function(node, "", depth)
                self._file.functions.setdefault(node.name, []).append(function)
                # A function inside of a function knows what is around it, as a lambda does.
                target = Expression("name", node.name, node.lineno, node.col_offset + 1, node.name)
                value = Expression("lambda", node.name, node.lineno, node.col_offset + 1, node.name, body=function)
                return [Statement("set", value, (target,))]
            case ast.ClassDef():
                self._read_class(node, depth)
                return []
            case ast.Assign(targets=targets, value=value):
                return [Statement("set", self._read(value, depth), tuple(self._read(t, depth) for t in targets))]
            case ast.AnnAssign(target=target, value=ast.expr() as value):
                return [Statement("set", self._read(value, depth), (self._read(target, depth),))]
            case ast.AugAssign(target=target, op=ast.Add(), value=value):
                old = self._read(target, depth)
                joined = Expression("join", old.text, old.line, old.column, parts=(old, self._read(value, depth)))
                return [Statement("set", joined, (old,))]
            case ast.AugAssign(target=target):
                unknown = self._read(target, depth)
                return [Statement("set", self._make(node, "unknown"), (unknown,))]
            case ast.Expr(value=value):
                return [Statement("do", self._read(value, depth))]
            case ast.Continue() | ast.Break():
                return [Statement("leave")]
            case ast.Return(value=value):
                return [Statement("return", None if value is None else self._read(value, depth))]
            case ast.For() | ast.AsyncFor():
                iterable, target = self._read(node.iter, depth), self._read(node.target, depth)
                body = self.read_body([*node.body, *node.orelse], depth)
                return [Statement("loop", iterable, (target,), body)]
            case ast.While(test=test):
                return [Statement("branch", self._read(test, depth), body=self.read_body(node.body, depth))]
            case ast.If(test=test):
                body, other = self.read_body(node.body, depth), self.read_body(node.orelse, depth)
                return [Statement("branch", self._read(test, depth), (), body, other)]
            case ast.With() | ast.AsyncWith():
                before = [
                    Statement(
                        "set" if item.optional_vars else "do",
                        self._read(item.context_expr, depth),
                        (self._read(item.optional_vars, depth),) if item.optional_vars else (),
                    )
                    for item in node.items
                ]
                return [*before, *self.read_body(node.body, depth)]
            case ast.Try() | ast.TryStar():
                handlers = [self.read_body(handler.body, depth) for handler in node.handlers]
                unknown = self._make(node, "unknown")
                failing = [Statement("branch", unknown, body=each) for each in handlers]
                tried = self.read_body([*node.body, *node.orelse], depth)
                return [*tried, *failing, *self.read_body(node.finalbody, depth)]
            case ast.Import(names=names):
                pairs = [(a.asname, a.name) if a.asname else (a.name.partition(".")[0],) * 2 for a in names]
                return [Statement("import", names=tuple(pairs))]
            case ast.ImportFrom(names=names):
                module = self._find_module(node)
                return [Statement("import", names=tuple((a.asname or a.name, f"{module}.{a.name}") for a in names))]
        return []

    def _find_module(self, node: ast.ImportFrom) -> str:
        if not node.level:
            return node.module or ""
        parts = self._package.split(".")
        return ".".join([*parts[: len(parts) - node.level + 1], *([node.module] if node.module else [])])

    def _read_function(
        self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda, owner: str, depth: int
    ) -> Function:
        arguments = node.args
        names = [*arguments.posonlyargs, *arguments.args]
        defaults = [None] * (len(names) - len(arguments.defaults)) + [self._read(d, depth) for d in arguments.defaults]
        parameters = [FunctionParameter(n.arg, "", d) for n, d in zip(names, defaults, strict=True)]
        for name, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True):
            parameters.append(FunctionParameter(name.arg, "", None if default is None else self._read(default, depth)))
        if isinstance(node, ast.Lambda):
            return Function(
                "lambda", tuple(parameters), (Statement("return", self._read(node.body, depth)),), self._file
            )
        is_static = any(isinstance(each, ast.Name) and each.id == "staticmethod" for each in node.decorator_list)
        body = self.read_body(node.body, depth)
        return Function(node.name, tuple(parameters), body, self._file, owner, is_static)

    def _read_class(self, node: ast.ClassDef, depth: int, owner: str = "") -> None:
        bases = tuple(ast.unparse(base) for base in node.bases if isinstance(base, ast.Name | ast.Attribute))
        name = f"{owner}{node.name}"
        found = SourceClass(name, self._file, bases)
        self._file.classes[name] = found
        for item in node.body if depth < MAX_DEPTH else ():
            if isinstance(item, ast.FunctionDef | ast.AsyncFunctionDef):
                function = self._read_function(item, name, depth)
                found.functions.setdefault(item.name, []).append(function)
            elif isinstance(item, ast.ClassDef):
                self._read_class(item, depth + 1, f"{name}.")
            else:
                found.field_values += self._read_statement(item, depth)

    def _read(self, node: ast.expr, depth: int) -> Expression:  # noqa: PLR0911, C901, PLR0912 - one for each form
        depth += 1
        if depth > MAX_DEPTH:
            return self._make(node, "unknown")
        match node:
            case ast.Constant(value=value):
                return self._make(node, "value", value)
            case ast.Name(id=name):
                return self._make(node, "name", name)
            case ast.Attribute(value=inner, attr=name):
                return self._make(node, "member", name, (self._read(inner, depth),))
            case ast.Call(func=function, args=arguments):
                called = [self._read(each, depth) for each in (function, *arguments)]
                keywords = {each.arg or "**": self._read(each.value, depth) for each in node.keywords}
                made = self._make(node, "call", None, called)
                made.keywords = keywords
                return made
            case ast.JoinedStr(values=values):
                parts = [self._read(v.value if isinstance(v, ast.FormattedValue) else v, depth) for v in values]
                is_plain = all(not isinstance(v, ast.FormattedValue) or v.format_spec is None for v in values)
                return self._make(node, "join" if is_plain else "unknown", None, parts)
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                return self._make(node, "join", None, (self._read(left, depth), self._read(right, depth)))
            case ast.BinOp(left=left, op=ast.Mod() | ast.Div() | ast.Mult() | ast.Sub() as op, right=right):
                sign = {ast.Mod: "%", ast.Div: "/", ast.Mult: "*", ast.Sub: "-"}[type(op)]
                parts = [
                    Expression("name", sign, node.lineno, 1, sign),
                    self._read(left, depth),
                    self._read(right, depth),
                ]
                return self._make(node, "call", None, parts)
            case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as number)):
                return self._make(node, "value", -number)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return self._read_operation(node, "not", (operand,), depth)
            case ast.BoolOp(op=op, values=values):
                return self._read_operation(node, "and" if isinstance(op, ast.And) else "or", values, depth)
            case ast.Compare(
                left=left, ops=[ast.Eq() | ast.NotEq() | ast.In() | ast.NotIn() | ast.Is() | ast.IsNot() as op]
            ):
                signs = {"Eq": "==", "Is": "==", "NotEq": "!=", "IsNot": "!=", "In": "in", "NotIn": "not in"}
                return self._read_operation(node, signs[type(op).__name__], (left, *node.comparators), depth)
            case ast.List(elts=items) | ast.Tuple(elts=items) | ast.Set(elts=items):
                return self._make(node, "list", None, [self._read(each, depth) for each in items])
            case ast.Dict(keys=keys, values=values) if None not in keys:
                return self._make(node, "dict", None, [self._read(each, depth) for each in (*keys, *values) if each])
            case ast.Subscript(value=inner, slice=key):
                return self._make(node, "index", None, (self._read(inner, depth), self._read(key, depth)))
            case ast.IfExp(test=test, body=body, orelse=other):
                return self._make(node, "choice", None, [self._read(each, depth) for each in (test, body, other)])
            case ast.Lambda():
                made = self._make(node, "lambda")
                made.body = self._read_function(node, "", depth)
                return made
            case ast.Starred(value=inner) | ast.Await(value=inner):
                return self._read(inner, depth)
            case ast.ListComp(elt=item) | ast.SetComp(elt=item) | ast.GeneratorExp(elt=item):
                return self._read_comprehension(node, self._read(item, depth), node.generators, depth)
            case ast.DictComp(key=key, value=value):
                pair = self._make(node, "list", None, [self._read(each, depth) for each in (key, value)])
                pairs = self._read_comprehension(node, pair, node.generators, depth)
                return self._make(node, "call", None, (Expression("name", "pairs", node.lineno, 1, "pairs"), pairs))
        return self._make(node, "unknown")

    def _read_comprehension(
        self, node: ast.expr, item: Expression, generators: Sequence[ast.comprehension], depth: int
    ) -> Expression:
        """Return loops in one another, from the inside; all that the inner ones give is one list."""
        for place, each in reversed(list(enumerate(generators))):
            word = "for" if place == len(generators) - 1 else "for all"
            parts = [self._read(part, depth) for part in (each.iter, each.target)]
            conditions = [self._read(condition, depth) for condition in each.ifs]
            name = Expression("name", word, node.lineno, 1, word)
            item = self._make(node, "call", None, (name, *parts, item, *conditions))
        return item

    def _read_operation(self, node: ast.expr, sign: str, operands: Iterable[ast.expr], depth: int) -> Expression:
        name = Expression("name", sign, node.lineno, node.col_offset + 1, sign)
        return self._make(node, "call", None, (name, *(self._read(each, depth) for each in operands)))

    def _make(
        self, node: ast.expr | ast.stmt, kind: ExpressionKind, value: object = None, parts: Iterable[Expression] = ()
    ) -> Expression:
        line = self._lines[node.lineno - 1] if node.lineno <= len(self._lines) else ""
        end = node.end_col_offset if node.end_lineno == node.lineno else None
        text = " ".join(line[node.col_offset : end].split())[:_MAX_TEXT]
        return Expression(kind, text, node.lineno, node.col_offset + 1, value, tuple(parts))
