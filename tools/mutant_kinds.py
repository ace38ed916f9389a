"""The mutants of a source file: one condition, operator or number changed at a time."""

from __future__ import annotations

import ast
import itertools
from collections.abc import Iterator
from dataclasses import dataclass

_COMPARISONS = {
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
    ast.Lt: ("<", "<="),
    ast.LtE: ("<=", "<"),
    ast.Gt: (">", ">="),
    ast.GtE: (">=", ">"),
    ast.Is: ("is", "is not"),
    ast.IsNot: ("is not", "is"),
    ast.In: ("in", "not in"),
    ast.NotIn: ("not in", "in"),
}
_OPERATORS = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "+"),
    ast.FloorDiv: ("//", "*"),
    ast.Div: ("/", "*"),
}


@dataclass(frozen=True)
class Mutant:
    """One edit of one source file; offsets count characters. `lines` are those of the expression that is changed."""

    file: str
    line: int
    lines: tuple[int, int]
    start: int
    end: int
    replacement: str
    source_line: str

    def change(self, text: str) -> str:
        """Return the file's text with the edit made."""
        return text[: self.start] + self.replacement + text[self.end :]

    def describe(self, text: str) -> str:
        """Return one line: where, what was there, what is there now."""
        return (
            f"{self.file}:{self.line}: `{text[self.start : self.end]}` -> `{self.replacement}` in `{self.source_line}`"
        )


class SourceText:
    """A file's text, with the offsets (in characters) of the positions that ast gives (in bytes of a line)."""

    def __init__(self, file: str, text: str) -> None:
        self.file = file
        self.text = text
        self.lines = text.split("\n")
        self.line_starts = [0]
        for line in self.lines:
            self.line_starts.append(self.line_starts[-1] + len(line) + 1)

    def start_of(self, node: ast.expr) -> int:
        """Return the offset of an expression's first character."""
        return self._offset(node.lineno, node.col_offset)

    def end_of(self, node: ast.expr) -> int:
        """Return the offset behind an expression's last character."""
        return self._offset(node.end_lineno or 0, node.end_col_offset or 0)

    def _offset(self, line: int, byte_column: int) -> int:
        return self.line_starts[line - 1] + len(self.lines[line - 1].encode()[:byte_column].decode())

    def mutant(self, node: ast.expr, start: int, end: int, replacement: str) -> Mutant:
        """Return the mutant of an expression that puts a replacement between two offsets."""
        line = self.text.count("\n", 0, start) + 1
        lines = node.lineno, node.end_lineno or node.lineno
        return Mutant(self.file, line, lines, start, end, replacement, self.lines[line - 1].strip())

    def exchange(self, node: ast.expr, words: tuple[str, str], left: ast.expr, right: ast.expr) -> Iterator[Mutant]:
        """Yield the mutant of an expression that exchanges the operator between two operands."""
        old, new = words
        start, end = self.end_of(left), self.start_of(right)
        place = self.text.find(old, start, end)
        # A comment between the operands may hold the same letters: only blanks and brackets may precede.
        if place >= 0 and not self.text[start:place].strip(" \n\t()"):
            yield self.mutant(node, place, place + len(old), new)


def find_mutants(file: str, text: str) -> Iterator[Mutant]:
    """Yield every mutant of a file.

    Decorators are left out: `frozen=True`, `slots=True` and the sizes of caches compute nothing. So is `strict=True` of
    `zip`: it asserts that sides are of one length, and changes nothing where they are.
    """
    source = SourceText(file, text)
    tree = ast.parse(text)
    without_effect = {
        id(part)
        for node in ast.walk(tree)
        if isinstance(node, (ast.ClassDef, ast.FunctionDef))
        for d in node.decorator_list
        for part in ast.walk(d)
    }
    without_effect |= {id(k.value) for k in ast.walk(tree) if isinstance(k, ast.keyword) and k.arg == "strict"}
    for node in ast.walk(tree):
        if id(node) not in without_effect:
            yield from _mutate_operators(source, node)
            yield from _mutate_values(source, node)


def _mutate_operators(source: SourceText, node: ast.AST) -> Iterator[Mutant]:
    if isinstance(node, ast.BoolOp):
        words = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
        for left, right in itertools.pairwise(node.values):
            yield from source.exchange(node, words, left, right)
    elif isinstance(node, ast.Compare) and len(node.ops) == 1:
        yield from source.exchange(node, _COMPARISONS[type(node.ops[0])], node.left, node.comparators[0])
    elif isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        yield from source.exchange(node, _OPERATORS[type(node.op)], node.left, node.right)


def _mutate_values(source: SourceText, node: ast.AST) -> Iterator[Mutant]:
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        yield source.mutant(node, source.start_of(node), source.start_of(node.operand), "")
    elif isinstance(node, ast.Constant) and isinstance(node.value, int):
        changed = str(not node.value) if isinstance(node.value, bool) else str(node.value + 1)
        yield source.mutant(node, source.start_of(node), source.end_of(node), changed)
    elif (
        isinstance(node, (ast.If, ast.While, ast.IfExp))
        and isinstance(node.test, (ast.Name, ast.Attribute, ast.Call))
        # What is imported for type checkers alone changes nothing that runs.
        and not (isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING")
    ):
        start = source.start_of(node.test)
        yield source.mutant(node.test, start, start, "not ")
