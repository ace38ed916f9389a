"""No order of a set reaches an output: it depends on hashes, which differ from one run, and one Python, to the next.

Judged by reading the code: what is a set by its form or by an annotation, here or where its name is declared, may only be
asked, counted, compared and sorted.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
FILES = sorted((ROOT / "archgen").rglob("*.py"))
SET_TYPES = ("set", "frozenset", "Set", "AbstractSet")
SET_METHODS = ("union", "intersection", "difference", "symmetric_difference")
BLIND_TO_ORDER = {
    "any",
    "all",
    "len",
    "set",
    "frozenset",
    "sorted",
    "min",
    "max",
    "fsum",
    "isdisjoint",
    "issubset",
    "issuperset",
    "gcd",
    "lcm",
}
"""What gives the same for every order; of those with a `key`, the first of equals would come first."""
KEEPS_ORDER = {
    "list",
    "tuple",
    "iter",
    "enumerate",
    "dict",
    "fromkeys",
    "join",
    "extend",
    "chain",
    "zip",
    "reversed",
    "deque",
    "map",
}
HARMLESS = frozenset(
    {
        ("archgen/views/graphs/changes/component_changes.py", "shown_components"),
        # From a set to a set.
        ("archgen/plugins/xmi/component_facts.py", "members"),
        ("archgen/plugins/xmi/component_facts.py", "family"),
        # Keys of a table that is only asked.
        *(
            ("archgen/plugins/xmi/uml_catalogue.py", name)
            for name in ("_CLASSES", "_DATA", "_HARDWARE", "_REALIZATIONS", "_PATHS", "_DEPENDENCIES")
        ),
    }
)
"""Walks over sets, by file and text, whose order nobody sees: the last part of the key is the name itself."""


def is_set_annotation(annotation: ast.expr | None) -> bool:
    """Whether an annotation names a set: `set[str]`, `frozenset[str] | None`."""
    if isinstance(annotation, ast.Constant) and isinstance(annotation.value, str):
        annotation = ast.parse(annotation.value, mode="eval").body
    if isinstance(annotation, ast.BinOp):
        return is_set_annotation(annotation.left) or is_set_annotation(annotation.right)
    if isinstance(annotation, ast.Subscript):
        annotation = annotation.value
    return isinstance(annotation, ast.Name) and annotation.id in SET_TYPES


def statements_of(tree: ast.Module) -> Iterator[ast.AST]:
    """Give the statements of a module at every depth: most of a tree is what stands in them."""
    pending: list[ast.AST] = [tree]
    while pending:
        node = pending.pop()
        yield node
        for part in ("body", "orelse", "finalbody", "handlers", "cases"):
            inner = getattr(node, part, ())
            pending += inner if isinstance(inner, list) else ()  # a lambda's body is an expression


def declared_names(tree: ast.Module) -> Iterator[tuple[str, bool]]:
    """Give the names that a module declares for others (functions, attributes), and whether each stands for a set."""
    for node in statements_of(tree):
        if isinstance(node, ast.FunctionDef):
            yield node.name, is_set_annotation(node.returns)
        if isinstance(node, ast.ClassDef):
            for line in node.body:
                if isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name):
                    yield line.target.id, is_set_annotation(line.annotation)


@cache
def sets_of_the_package() -> frozenset[str]:
    """Name the functions and attributes that are sets wherever they are declared."""
    kinds: dict[str, set[bool]] = {}
    for file in FILES:
        for name, is_set in declared_names(ast.parse(file.read_text(encoding="utf-8"))):
            kinds.setdefault(name, set()).add(is_set)
    return frozenset(name for name, answers in kinds.items() if answers == {True})


class SetWalks(ast.NodeVisitor):
    """Collect what walks over a set in one scope after the other."""

    def __init__(self) -> None:
        """Start with nothing known."""
        self.local_sets: list[dict[str, bool]] = [{}]
        self.walks: list[ast.expr] = []
        self.blind: set[int] = set()

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        """Read a function with its parameters."""
        arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
        self.local_sets.append({each.arg: is_set_annotation(each.annotation) for each in arguments})
        self.generic_visit(node)
        self.local_sets.pop()

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        """Note what a name stands for."""
        if isinstance(node.target, ast.Name):
            self.local_sets[-1][node.target.id] = is_set_annotation(node.annotation)
        self.generic_visit(node)

    def visit_Assign(self, node: ast.Assign) -> None:
        """Note what a name stands for."""
        for target in node.targets:
            if isinstance(target, ast.Name):
                self.local_sets[-1][target.id] = self.is_set(node.value)
        self.generic_visit(node)

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        """Read a class: its attributes are no names of the module."""
        self.local_sets.append({})
        self.generic_visit(node)
        self.local_sets.pop()

    def visit_Name(self, node: ast.Name) -> None:
        """Forget what a name stood for that gets another value in a loop, or one of several."""
        if isinstance(node.ctx, ast.Store):
            self.local_sets[-1].setdefault(node.id, False)

    def visit_For(self, node: ast.For) -> None:
        """Judge a loop."""
        self.judge(node.iter)
        self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> None:
        """Judge what takes something in order; what does not see the order may take a generator over a set."""
        name = name_of(node.func)
        # Behind `order_naturally` no two names are equal.
        has_key = any(each.arg == "key" and ast.unparse(each.value) != "order_naturally" for each in node.keywords)
        if name in BLIND_TO_ORDER and not has_key:
            self.blind.update(id(each.value if isinstance(each, ast.Starred) else each) for each in node.args)
        elif name in KEEPS_ORDER or name in BLIND_TO_ORDER:
            for argument in node.args:
                self.judge(argument)
        if name == "pop" and not node.args and isinstance(node.func, ast.Attribute):
            self.judge(node.func.value)
        self.generic_visit(node)

    def visit_Starred(self, node: ast.Starred) -> None:
        """Judge what is spread out."""
        self.judge(node.value)
        self.generic_visit(node)

    def visit_Set(self, node: ast.Set) -> None:
        """Let a set be spread into a set."""
        for each in node.elts:
            self.visit(each.value if isinstance(each, ast.Starred) else each)

    def visit_YieldFrom(self, node: ast.YieldFrom) -> None:
        """Judge what is passed on."""
        self.judge(node.value)
        self.generic_visit(node)

    def visit_comprehension_of(self, node: ast.ListComp | ast.GeneratorExp | ast.DictComp) -> None:
        """Judge what a comprehension walks over, unless nobody sees its order."""
        if id(node) not in self.blind:
            for generator in node.generators:
                self.judge(generator.iter)
        self.generic_visit(node)

    visit_ListComp = visit_GeneratorExp = visit_DictComp = visit_comprehension_of  # noqa: N815 - ast's names

    def judge(self, value: ast.expr) -> None:
        """Keep a walk over a set."""
        if self.is_set(value):
            self.walks.append(value)

    def is_set(self, value: ast.expr) -> bool:  # noqa: PLR0911 - a line for each form
        """Whether an expression is a set, as far as its form and the declarations say."""
        match value:
            case ast.Set() | ast.SetComp():
                return True
            case ast.BinOp(left=left, op=ast.BitOr() | ast.BitAnd() | ast.Sub() | ast.BitXor(), right=right):
                return self.is_set(left) or self.is_set(right)
            case ast.IfExp(body=body, orelse=other):
                return self.is_set(body) or self.is_set(other)
            case ast.BoolOp(values=values):
                return any(self.is_set(each) for each in values)
            case ast.Name(id=name):
                return next((scope[name] for scope in reversed(self.local_sets) if name in scope), False)
            case ast.Attribute(attr=name):
                return name in sets_of_the_package()
            case ast.Call(func=ast.Subscript(value=ast.Name(id=name))):
                return name in SET_TYPES
            case ast.Call(func=ast.Attribute(attr=name)) if name in SET_METHODS:
                return True
            case ast.Call(func=function):
                name = name_of(function)
                return name in SET_TYPES or name in sets_of_the_package()
        return False


def name_of(function: ast.expr) -> str:
    """Give the last name of what is called."""
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


def walks_over_sets(text: str) -> list[str]:
    """Give the lines of a module that walk over a set in its own order."""
    visitor = SetWalks()
    visitor.visit(ast.parse(text))
    return [f"{walk.lineno}: {ast.unparse(walk)}" for walk in visitor.walks]


@pytest.mark.parametrize(
    "line",
    [
        "for name in {a, b}: pass",
        "[name for name in set(names)]",
        "list(frozenset(names))",
        "', '.join({a, b} - others)",
        "first = next(iter(names | {a}))",
        "sorted({a, b}, key=len)",
        "(*{a, b}, c)",
        "def write(names: set[str]): return tuple(names)",
        "def write(names: frozenset[str] | None): return {name: 1 for name in names or ()}",
        "names = {name for name in rows}; print(*names)",
        "names = set[str](); names.pop()",
    ],
)
def test_a_walk_over_a_set_is_found(line: str) -> None:
    assert len(walks_over_sets(line)) == 1


@pytest.mark.parametrize(
    "line",
    [
        "for name in sorted({a, b}): pass",
        "sorted({a, b}, key=order_naturally)",
        "sorted(name.id for name in {a, b})",
        "any(name in text for name in {a, b})",
        "{name.lower() for name in {a, b}}",
        "len({a, b}) + max(each.size for each in {a, b})",
        "names = [a, b]; list(names)",
        "{*{a, b}, c}",
    ],
)
def test_what_shows_no_order_is_let_pass(line: str) -> None:
    assert walks_over_sets(line) == []


@pytest.mark.slow
def test_no_set_is_walked_over_in_its_own_order() -> None:
    names = {file.relative_to(ROOT).as_posix(): file for file in FILES}
    walks = [
        f"{name}:{walk}: sort it"
        for name, file in names.items()
        for walk in walks_over_sets(file.read_text(encoding="utf-8"))
        if (name, walk.partition(": ")[2]) not in HARMLESS
    ]
    assert walks == []
