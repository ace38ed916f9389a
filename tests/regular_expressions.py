"""All regular expressions of the package, and texts on which a slow one shows: derived from the parsed expression itself."""

import ast
import importlib
import random
import re
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, TypeGuard

with warnings.catch_warnings():
    warnings.simplefilter("ignore", DeprecationWarning)
    from re import _constants, _parser  # type: ignore[attr-defined]

ROOT = Path(__file__).resolve().parent.parent
FUNCTIONS = ("compile", "match", "fullmatch", "search", "sub", "subn", "split", "findall", "finditer")
REPEATS = (_constants.MAX_REPEAT, _constants.MIN_REPEAT, _constants.POSSESSIVE_REPEAT)
ENDINGS = ("", "\0", "\n!")
_WRITTEN_CALL = re.compile(rf"\bre\.(?:{'|'.join(FUNCTIONS)})\(")
"""As ruff lays out each call: what holds none of them need not be parsed."""
USUAL_CHARACTERS = " \n\taAz09é-_/.,:;$#<>()[]{}\"'\\=!\0"


@dataclass(frozen=True)
class Expression:
    """One expression of the package, where it stands, and by which methods it meets texts."""

    place: str
    pattern: re.Pattern[Any]
    methods: tuple[str, ...]


@cache
def list_expressions() -> tuple[Expression, ...]:
    """List what the package compiles: at the top of a module or a class by its value, within a function by its literal."""
    return tuple(expression for place, tree in _read_modules() for expression in _list_expressions_of(place, tree))


@cache
def _read_modules() -> tuple[tuple[str, ast.Module], ...]:
    """Read the modules that call `re`, each with its place."""
    files = [path for path in sorted((ROOT / "archgen").rglob("*.py")) if "assets" not in path.parts]
    texts = {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in files}
    return tuple((place, ast.parse(text)) for place, text in texts.items() if _WRITTEN_CALL.search(text))


def _list_expressions_of(place: str, tree: ast.Module) -> Iterator[Expression]:
    module = importlib.import_module(place.removesuffix(".py").removesuffix("/__init__").replace("/", "."))
    called = _list_called_methods(tree)
    named = {
        f"{name}{index or ''}": pattern
        for name, value in vars(module).items()
        for index, pattern in enumerate(_walk_patterns(value))
    }
    imported = {
        name.asname or name.name for node in tree.body if isinstance(node, ast.ImportFrom) for name in node.names
    }
    for name in sorted(set(named) - imported):
        yield Expression(f"{place}:{name}", named[name], tuple(sorted(called.get(name, ()))))
    seen = {(value.pattern, value.flags) for value in named.values()}
    for node in ast.walk(tree):
        for expression in _compile_literals(place, node):
            if (expression.pattern.pattern, expression.pattern.flags) not in seen:
                yield expression


def _walk_patterns(value: object) -> Iterator[re.Pattern[Any]]:
    """Yield an expression, or those in a mapping or a sequence of them."""
    if isinstance(value, re.Pattern):
        yield value
    elif isinstance(value, Mapping) and len(value) < 1000:
        for part in value.values():
            yield from _walk_patterns(part)
    elif isinstance(value, tuple | list) and len(value) < 1000:
        for part in value:
            yield from _walk_patterns(part)


def list_made_expressions() -> list[str]:
    """List where functions make expressions of what they are given: a file and the function around, as it is called there."""
    places = set()
    for place, tree in _read_modules():
        for function in [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]:
            if any(_is_call(node) and not isinstance(node.args[0], ast.Constant) for node in ast.walk(function)):
                places.add(f"{place}:{function.name}")
    return sorted(places)


def _is_call(node: ast.AST) -> TypeGuard[ast.Call]:
    return (
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and isinstance(node.func.value, ast.Name)
        and node.func.value.id == "re"
        and node.func.attr in FUNCTIONS
        and bool(node.args)
    )


def _list_called_methods(tree: ast.Module) -> dict[str, set[str]]:
    """Name the methods by which each named expression is used in its own module; `for` and mappings hide it: then it is none."""
    called: dict[str, set[str]] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.attr in FUNCTIONS:
            called.setdefault(node.value.id, set()).add(node.attr)
    return called


def _compile_literals(place: str, node: ast.AST) -> Iterator[Expression]:
    if not _is_call(node) or not isinstance(node.func, ast.Attribute):
        return
    literal = node.args[0]
    if isinstance(literal, ast.Constant) and isinstance(literal.value, str | bytes):
        flags = 0
        for argument in [*node.args[1:], *(keyword.value for keyword in node.keywords if keyword.arg == "flags")]:
            names = [part.attr for part in ast.walk(argument) if isinstance(part, ast.Attribute)]
            flags |= sum({getattr(re, name) for name in names if isinstance(getattr(re, name, None), re.RegexFlag)})
        methods = () if node.func.attr == "compile" else (node.func.attr,)
        yield Expression(f"{place}:{node.lineno}", re.compile(literal.value, flags), methods)


def list_attacks(pattern: re.Pattern[Any]) -> list[tuple[str, str]]:
    """List (beginning, what is repeated) for each place of the expression that repeats something.

    What is repeated are samples of it, single characters that it and its neighbours take, and blanks and signs that any might.
    """
    source = pattern.pattern if isinstance(pattern.pattern, str) else pattern.pattern.decode("latin-1")
    parsed = _parser.parse(source, pattern.flags & ~re.UNICODE & ~re.LOCALE if isinstance(pattern.pattern, str) else 0)
    draw = random.Random(0)  # noqa: S311 (nothing secret)
    attacks: dict[tuple[str, str], None] = {}
    characters = _list_telling_characters(parsed)
    for beginning, body in _walk_repeats(parsed, "", draw):
        for pump in dict.fromkeys([*(_make_sample(body, draw) for _ in range(3)), *characters]):
            if pump and len(pump) < 40:
                attacks[beginning, pump] = None
                attacks["", pump] = None
    return list(attacks)


def _walk_repeats(items: Sequence[Any], beginning: str, draw: random.Random) -> Iterator[tuple[str, Sequence[Any]]]:
    """Yield each part that may come more than 50 times, with a text that leads to it."""
    for operator, argument in items:
        if operator in REPEATS:
            _, most, body = argument
            if most is _constants.MAXREPEAT or most > 50:
                yield beginning, body
            yield from _walk_repeats(body, beginning, draw)
        else:
            for part in _list_parts(operator, argument):
                yield from _walk_repeats(part, beginning, draw)
        beginning += _make_sample([(operator, argument)], draw)


def _list_parts(operator: object, argument: Any) -> list[Sequence[Any]]:  # noqa: ANN401 (as `re` has it)
    if operator is _constants.BRANCH:
        return list(argument[1])
    if operator is _constants.SUBPATTERN:
        return [argument[3]]
    if operator is _constants.ATOMIC_GROUP:
        return [argument]
    if operator in (_constants.ASSERT, _constants.ASSERT_NOT):
        return [argument[1]]
    if operator is _constants.GROUPREF_EXISTS:
        return [part for part in argument[1:] if part is not None]
    return []


def _make_sample(items: Sequence[Any], draw: random.Random) -> str:
    """Make a text that the parts match, as nearly as this needs it: what looks around is left out."""
    text = ""
    for operator, argument in items:
        if operator is _constants.LITERAL:
            text += chr(argument)
        elif operator is _constants.ANY:
            text += "a"
        elif operator in (_constants.IN, _constants.NOT_LITERAL):
            text += draw.choice(sorted(_list_taken([(operator, argument)])) or ["a"])
        elif operator in REPEATS:
            least, most, body = argument
            text += "".join(_make_sample(body, draw) for _ in range(min(most, max(least, draw.randint(0, 2)))))
        elif operator not in (_constants.ASSERT, _constants.ASSERT_NOT):
            parts = _list_parts(operator, argument)
            text += _make_sample(draw.choice(parts), draw) if parts else ""
    return text


def _list_taken(items: Sequence[Any]) -> set[str]:
    """Name characters that one part of one character takes, out of the usual ones and its own."""
    (operator, argument) = items[0]
    return {character for character in _list_characters(items) if _takes(operator, argument, character)}


def _takes(operator: object, argument: Any, character: str) -> bool:  # noqa: ANN401 (as `re` has it)
    if operator is not _constants.IN:
        return bool(ord(character) == argument) != (operator is _constants.NOT_LITERAL)
    negated, found = False, False
    for name, value in argument:
        if name is _constants.NEGATE:
            negated = True
        elif name is _constants.LITERAL:
            found = found or ord(character) == value
        elif name is _constants.RANGE:
            found = found or value[0] <= ord(character) <= value[1]
        elif name is _constants.CATEGORY:
            found = found or re.match(_CATEGORIES[value], character) is not None
    return found != negated


_CATEGORIES = {
    _constants.CATEGORY_DIGIT: r"\d",
    _constants.CATEGORY_NOT_DIGIT: r"\D",
    _constants.CATEGORY_SPACE: r"\s",
    _constants.CATEGORY_NOT_SPACE: r"\S",
    _constants.CATEGORY_WORD: r"\w",
    _constants.CATEGORY_NOT_WORD: r"\W",
}


def _list_telling_characters(items: Sequence[Any]) -> list[str]:
    """Name one character of each sort that the parts of the expression tell from the others."""
    atoms = list(_walk_atoms(items))
    by_sort: dict[tuple[bool, ...], str] = {}
    for character in sorted(_list_characters(items)):
        by_sort.setdefault(tuple(_takes(operator, argument, character) for operator, argument in atoms), character)
    return [character for sort, character in by_sort.items() if any(sort)]


def _walk_atoms(items: Sequence[Any]) -> Iterator[tuple[Any, Any]]:
    for operator, argument in items:
        if operator in (_constants.LITERAL, _constants.NOT_LITERAL, _constants.IN):
            yield operator, argument
        elif operator in REPEATS:
            yield from _walk_atoms(argument[2])
        else:
            for part in _list_parts(operator, argument):
                yield from _walk_atoms(part)


def _list_characters(items: Sequence[Any]) -> set[str]:
    """Name the characters that stand in the expression, and usual ones."""
    characters = set(USUAL_CHARACTERS)
    for operator, argument in _walk_atoms(items):
        if operator is _constants.IN:
            characters |= {chr(value) for name, value in argument if name is _constants.LITERAL}
        else:
            characters.add(chr(argument))
    return characters
