"""A pass that is written as rules, and the small expressions of these: comparisons behind `where`, functions behind `let`.
They are read, never run as code.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Literal

from archgen.diagnostics import Diagnostic, Span, did_you_mean
from archgen.frozen import NamedTuple
from archgen.passes.patterns.matching import ViewPattern
from archgen.passes.patterns.pattern_shapes import Pattern, list_variables, parse_text_pattern

_WORD = re.compile(r"""(?:(?<!\s)\s++)?+(==|!=|[()\[\],]|"[^"]*"|'[^']*'|=|[^\s()\[\],="'!]+|\S)""")
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_EXPRESSION_START = re.compile(r"""\s*(?:[A-Za-z_]+\(|[\["'])""")
_QUOTES = ('"', "'")
MAX_EXPRESSION_LENGTH = 1000
_MAX_DEPTH = 20

VALUE_FUNCTIONS: Mapping[str, tuple[int, int | None]] = {
    "snake": (1, 1),
    "camel": (1, 1),
    "join": (1, None),
    "unique": (1, 1),
    "specialise": (1, None),
    "without": (2, None),
    "without_package": (1, 1),
}
"""The functions that give a value, with the least and the greatest number of what they take."""
TEST_FUNCTIONS: Mapping[str, tuple[int, int | None]] = {"is_a": (2, 2)}
"""The functions that say yes or no."""
OPERATORS = ("==", "!=", "in", "starts with", "has")


class ExpressionError(Exception):
    """A text is no expression. Carries what is wrong, and what to do."""

    def __init__(self, message: str, help_line: str | None = None) -> None:
        super().__init__(message)
        self.help_line = help_line


class TextOperand(NamedTuple):
    """A word, a quoted text or a variable."""

    pattern: Pattern


class ListOperand(NamedTuple):
    """Several operands in brackets."""

    items: tuple[Operand, ...]


class Call(NamedTuple):
    """A function with what it takes; `names` are written `T=$kind`."""

    function: str
    arguments: tuple[Operand, ...]
    names: tuple[tuple[Operand, Operand], ...] = ()


Operand = TextOperand | ListOperand | Call


class Condition(NamedTuple):
    """What a `where` asks: a comparison; with a call alone in `left`, the operator is empty."""

    left: Operand
    operator: str = ""
    right: Operand | None = None
    is_negated: bool = False


def parse_where_condition(text: str) -> Condition:
    """Return what a `where` asks. Raise ExpressionError."""
    reader = _Reader(text)
    is_negated = reader.take_word("not")
    left = reader.read_operand()
    operator = reader.read_operator()
    if not operator:
        if not isinstance(left, Call) or left.function not in TEST_FUNCTIONS:
            message = f"`{text}` compares nothing"
            raise ExpressionError(
                message, f"write one of {', '.join(f'`{each}`' for each in OPERATORS)} between two values"
            )
        reader.expect_end()
        return Condition(left, is_negated=is_negated)
    right = reader.read_operand()
    reader.expect_end()
    for side in (left, right):
        if isinstance(side, Call) and side.function in TEST_FUNCTIONS:
            raise ExpressionError(f"`{side.function}` says yes or no: it stands alone")
    return Condition(left, operator, right, is_negated)


def parse_let_value(text: str) -> Operand:
    """Return what a `let` gives: a function, a list, a quoted text, or else all of the text. Raise ExpressionError."""
    if not _EXPRESSION_START.match(text) and len(text) <= MAX_EXPRESSION_LENGTH:
        return TextOperand(parse_text_pattern(text, text, None))
    reader = _Reader(text)
    operand = reader.read_operand()
    reader.expect_end()
    if isinstance(operand, Call) and operand.function in TEST_FUNCTIONS:
        raise ExpressionError(f"`{operand.function}` says yes or no, and stands behind `where`")
    return operand


def list_operand_variables(operand: Operand | None) -> Iterator[str]:
    """Yield the names of the variables in an operand."""
    if isinstance(operand, TextOperand):
        yield from list_variables(operand.pattern)
    elif isinstance(operand, ListOperand):
        for item in operand.items:
            yield from list_operand_variables(item)
    elif isinstance(operand, Call):
        for item in operand.arguments:
            yield from list_operand_variables(item)
        for pair in operand.names:
            yield from list_operand_variables(pair[0])
            yield from list_operand_variables(pair[1])


class _Reader:
    """Reads an expression from the left to the right, once."""

    def __init__(self, text: str) -> None:
        if len(text) > MAX_EXPRESSION_LENGTH:
            message = f"an expression of {len(text):,} letters; at most {MAX_EXPRESSION_LENGTH:,} are read"
            raise ExpressionError(message, "give its parts names with `let`")
        self._text = text
        self._words = [match[1] for match in _WORD.finditer(text)]
        self._at = 0
        self._depth = 0

    def _peek(self, offset: int = 0) -> str:
        index = self._at + offset
        return self._words[index] if index < len(self._words) else ""

    def take_word(self, word: str) -> bool:
        if self._peek() == word and self._peek(1) not in {"", *OPERATORS, "starts"}:
            self._at += 1
            return True
        return False

    def read_operator(self) -> str:
        word = self._peek()
        if word == "starts" and self._peek(1) == "with":
            self._at += 2
            return "starts with"
        if word in OPERATORS:
            self._at += 1
            return word
        if word and word not in {")", "]", ","}:
            guess = did_you_mean(word, OPERATORS)
            message = f"`{word}` is no comparison"
            raise ExpressionError(message, guess or f"there are {', '.join(f'`{each}`' for each in OPERATORS)}")
        return ""

    def read_operand(self) -> Operand:
        self._depth += 1
        if self._depth > _MAX_DEPTH:
            raise ExpressionError(f"brackets stand more than {_MAX_DEPTH} deep inside of one another")
        operand = self._read_operand()
        self._depth -= 1
        return operand

    def _read_operand(self) -> Operand:
        word = self._peek()
        if not word or word in {"==", "!=", ")", "]", ",", "=", "("}:
            found = f"`{word}`" if word else "the end"
            raise ExpressionError(f"a value is missing before {found} in `{self._text}`")
        self._at += 1
        if word == "[":
            items = list(self._read_items("]"))
            if not all(isinstance(item, OPERANDS) for item in items):
                raise ExpressionError(f"a list has no names: `=` is too much in `{self._text}`")
            return ListOperand(tuple(item for item in items if isinstance(item, OPERANDS)))
        if word.startswith(_QUOTES):
            if len(word) == 1:
                raise ExpressionError(f"a quote is not closed in `{self._text}`")
            return TextOperand(parse_text_pattern(word[1:-1], word[1:-1], None))
        if self._peek() == "(":
            return self._read_call(word)
        return TextOperand(parse_text_pattern(word, word, None))

    def _read_call(self, function: str) -> Call:
        known_functions = {**VALUE_FUNCTIONS, **TEST_FUNCTIONS}
        if function not in known_functions:
            guess = did_you_mean(function, known_functions)
            message = f"no function named `{function}`"
            raise ExpressionError(message, guess or f"there are {', '.join(f'`{each}`' for each in known_functions)}")
        self._at += 1
        items = list(self._read_items(")"))
        arguments = tuple(item for item in items if isinstance(item, OPERANDS))
        names = tuple(item for item in items if not isinstance(item, OPERANDS))
        least, most = known_functions[function]
        if len(arguments) < least or (most is not None and len(arguments) > most):
            asked = f"{least}" if least == most else f"at least {least}"
            message = f"`{function}` takes {asked} value{'s' if asked != '1' else ''}, not {len(arguments)}"
            raise ExpressionError(message)
        if (function == "specialise") != bool(names) or (function == "specialise" and len(arguments) != 1):
            message = (
                "`specialise` takes what is generic, and what its names stand for"
                if function == "specialise"
                else f"`{function}` takes no names"
            )
            raise ExpressionError(message, "as in `specialise($body, T=$kind)`")
        return Call(function, arguments, names)

    def _read_items(self, end: str) -> Iterator[Operand | tuple[Operand, Operand]]:
        while self._peek() != end:
            operand = self.read_operand()
            if self._peek() == "=":
                self._at += 1
                if not isinstance(operand, TextOperand):
                    raise ExpressionError(f"a name stands before `=` in `{self._text}`")
                yield (operand, self.read_operand())
            else:
                yield operand
            if self._peek() == ",":
                self._at += 1
            elif self._peek() != end:
                found = f"`{self._peek()}`" if self._peek() else "the end"
                raise ExpressionError(f"`,` or `{end}` is missing before {found} in `{self._text}`")
        self._at += 1

    def expect_end(self) -> None:
        if self._peek():
            message = f"`{self._peek()}` is too much in `{self._text}`"
            raise ExpressionError(message, "texts with blanks stand in quotes")


OPERANDS = (TextOperand, ListOperand, Call)


WRONG_PASS = "wrong-pass"  # noqa: S105 - not a password
"""The rule of all that is wrong with a pass that is written as rules."""


def diagnose_pass(message: str, span: Span, help_line: str | None = None) -> Diagnostic:
    """Return the finding for what is wrong with a pass at a place."""
    return Diagnostic(WRONG_PASS, message, span, help=help_line)


EditKind = Literal["add", "set", "drop"]
EDIT_KINDS: tuple[EditKind, ...] = ("drop", "set", "add")
"""What a rule does with what it found, in this order: what is dropped makes room."""


class WrittenCondition(NamedTuple):
    """A comparison behind `where`, and its place."""

    comparison: Condition
    span: Span


class NegativePattern(NamedTuple):
    """What must not be there, with comparisons of its own."""

    pattern: ViewPattern
    where: tuple[WrittenCondition, ...]
    distinct: frozenset[str]
    """Its own variables that stand for components."""


class LetBinding(NamedTuple):
    """A variable and what it stands for: an expression, or a mapping or list with variables in it."""

    name: str
    value: Operand | Pattern
    is_expression: bool
    span: Span


class RuleEdit(NamedTuple):
    """What a rule writes: to components and types, by key."""

    kind: EditKind
    pattern: ViewPattern


class RewriteRule(NamedTuple):
    """A rule. `span` is where it begins."""

    find: ViewPattern
    unless: tuple[NegativePattern, ...]
    where: tuple[WrittenCondition, ...]
    let: tuple[LetBinding, ...]
    edits: tuple[RuleEdit, ...]
    distinct: frozenset[str]
    """The variables of `find` that stand for components, each for another one."""
    span: Span


class PatternPass(NamedTuple):
    """A pass file."""

    name: str
    title: str
    description: str
    rules: tuple[RewriteRule, ...]
    file: str
    needs: tuple[str, ...] = ()
    leaves: tuple[str, ...] = ()
    ends: tuple[str, ...] = ()
