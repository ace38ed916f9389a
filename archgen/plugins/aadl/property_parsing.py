"""Parse property associations and their values, and the definitions of a property set."""

from __future__ import annotations

from fractions import Fraction

from archgen.plugins.aadl.aadl_tree import (
    AadlLink,
    AadlList,
    AadlName,
    AadlNumber,
    AadlProperty,
    AadlRange,
    AadlRecord,
    AadlString,
    AadlValue,
    Modes,
    Path,
    PropertySet,
)
from archgen.plugins.aadl.token_cursor import END, SECTION_WORDS, TokenCursor, unquote_text

_LINK_WORDS = ("reference", "classifier", "compute")
_VALUE_ENDS = frozenset({",", ";", ")", "]", "}", "applies", "in", "::", ".."})
_BEHIND_NUMBERS = frozenset({"applies", "in", "delta", "units"})
_MAX_EXPONENT = 400


def parse_property_list(cursor: TokenCursor) -> list[AadlProperty]:
    """Parse `{ a => 1; b => 2; }` if it stands here."""
    found: list[AadlProperty] = []
    if cursor.accept("{"):
        cursor.parse_entries(
            lambda: found.append(parse_property(cursor)), lambda: cursor.at("}") or _at_section(cursor)
        )
        cursor.expect("}")
    return found


def _at_section(cursor: TokenCursor) -> bool:
    """Whether the list was never closed, and the next section begins."""
    return cursor.token.word in SECTION_WORDS and cursor.peek().kind in {"name", END}


def parse_property(cursor: TokenCursor) -> AadlProperty:
    """Parse an association up to its `;`."""
    start = cursor.token.offset
    name = cursor.expect_path("a property")
    appended = cursor.accept("+=>")
    if not appended:
        cursor.expect("=>")
    cursor.accept("constant")
    values = cursor.parse_separated(lambda: (parse_property_value(cursor), parse_modes(cursor)), ",")
    paths = parse_targets(cursor)
    if cursor.accept("in", "binding"):
        _skip_brackets(cursor)
    modes = parse_modes(cursor) or values[0][1]
    cursor.expect(";")
    return AadlProperty(name, values[0][0], cursor.span_from(start), paths, appended, modes, tuple(values[1:]))


def parse_targets(cursor: TokenCursor) -> tuple[Path, ...]:
    """Parse `applies to a.b, c` if it stands here."""
    if not cursor.accept("applies", "to"):
        return ()
    return tuple(cursor.parse_separated(lambda: parse_contained_path(cursor), ","))


def parse_modes(cursor: TokenCursor) -> Modes:
    """Return what stands in the brackets of `in modes (...)`, if that stands here."""
    if not (cursor.accept("in", "modes") or cursor.accept("in", "mode")):
        return ()
    return tuple(filter(None, "".join(_skip_brackets(cursor)).split(",")))


def _skip_brackets(cursor: TokenCursor) -> list[str]:
    """Go behind `(...)`, whatever stands there; return the words in it."""
    cursor.expect("(")
    depth, words = 1, list[str]()
    while depth:
        if cursor.token.kind == END or cursor.at(";"):
            cursor.fail("`)` is missing here")
        token = cursor.advance()
        depth += (token.word == "(") - (token.word == ")")
        words.append(token.text)
    return words[:-1]


def parse_contained_path(cursor: TokenCursor) -> Path:
    """Parse a path of elements: `a.b[1].c`; `self` and what leads into an annex are parts of it."""
    parts: list[str] = []
    while True:
        if cursor.token.kind == "annex" or cursor.at("{"):
            cursor.fail("elements of annexes are not read")
        if cursor.token.kind != "name":
            cursor.fail(f"`{cursor.token.text}` is no name of an element")
        parts.append(cursor.advance().text)
        while cursor.accept("["):
            while not cursor.accept("]"):
                if cursor.token.kind not in {"number", "name"} and not cursor.at(".."):
                    cursor.fail("`]` is missing here")
                cursor.advance()
        if not (cursor.accept(".") or cursor.accept("::")):
            return tuple(parts)


def parse_property_value(cursor: TokenCursor) -> AadlValue:
    """Parse a value, which may be a range."""
    with cursor.deeper():
        value = _parse_single_value(cursor)
        if cursor.accept(".."):
            value = AadlRange(value, _parse_single_value(cursor))
        if cursor.accept("delta"):
            _parse_single_value(cursor)
        return value


def _parse_single_value(cursor: TokenCursor) -> AadlValue:
    token = cursor.token
    if token.kind == "text":
        return AadlString(unquote_text(cursor.advance()))
    if token.kind == "number" or token.text in {"-", "+"}:
        return _parse_number(cursor)
    if cursor.accept("("):
        return _parse_list(cursor)
    if cursor.accept("["):
        return _parse_record(cursor)
    if token.word in _LINK_WORDS and cursor.peek().kind in {"name", "sign"} and cursor.peek().text not in _VALUE_ENDS:
        return _parse_link(cursor)
    if token.kind != "name" or token.word in SECTION_WORDS:
        cursor.fail("a value is missing here")
    return AadlName(_parse_any_path(cursor))


def _parse_link(cursor: TokenCursor) -> AadlLink:
    """Parse `reference (a.b)`, `classifier (p::c)`, `compute (f)`; AADL's first version has no brackets."""
    word = cursor.advance().word
    in_brackets = cursor.accept("(")
    path = parse_contained_path(cursor) if word == "reference" else _parse_classifier_path(cursor)
    if in_brackets:
        cursor.expect(")")
    return AadlLink(word, path)


def _parse_classifier_path(cursor: TokenCursor) -> Path:
    for word in ("thread group", "subprogram group", "virtual bus", "virtual processor", "data", "process", "system"):
        # `classifier (data p::c)` is of AADL's first version, and still met.
        if cursor.accept(*word.split()):
            break
    return (_parse_any_path(cursor),)


def _parse_any_path(cursor: TokenCursor) -> str:
    # Words of enumerations are anything: `in`, `data`, ...
    parts = [cursor.advance().text]
    while (cursor.at("::") or cursor.at(".")) and cursor.peek().kind == "name":
        parts += [cursor.advance().text, cursor.advance().text]
    return "".join(parts)


def _parse_number(cursor: TokenCursor) -> AadlValue:
    sign = 1
    while cursor.token.text in {"-", "+"}:
        sign = -sign if cursor.advance().text == "-" else sign
    token = cursor.token
    if token.kind == "name":
        # A constant; its sign is not kept, as no property that is taken has one.
        return AadlName(_parse_any_path(cursor))
    if token.kind != "number":
        cursor.fail("a number is missing here")
    value = _read_number(cursor)
    unit = ""
    if cursor.token.kind == "name" and cursor.token.word not in _BEHIND_NUMBERS:
        unit = cursor.advance().text
    return AadlNumber(sign * value, unit)


def _read_number(cursor: TokenCursor) -> Fraction:
    number = _make_number(cursor.token.text.replace("_", ""))
    if number is None:
        cursor.fail("this is no number that can be read")
    cursor.advance()
    return number


def _make_number(text: str) -> Fraction | None:
    """Return the number that a text is, or None where it is none, or larger than anybody needs."""
    base, hash_sign, rest = text.partition("#")
    digits, _, exponent = rest.partition("#")
    try:
        power = int((exponent if hash_sign else text.lower().partition("e")[2]).lstrip("eE") or 0)
        if abs(power) > _MAX_EXPONENT or len(text) > _MAX_EXPONENT:
            return None
        return Fraction(int(digits, int(base)) * int(base) ** power) if hash_sign else Fraction(text)
    except ValueError:
        return None


def _parse_list(cursor: TokenCursor) -> AadlList:
    return AadlList(tuple(parse_property_value(cursor) for _ in cursor.walk_entries(")", ",")))


def _parse_record(cursor: TokenCursor) -> AadlRecord:
    fields: dict[str, AadlValue] = {}
    for _ in cursor.walk_entries("]", ";"):
        name = cursor.advance().text
        cursor.expect("=>")
        fields[name] = parse_property_value(cursor)
    return AadlRecord(fields)


def parse_property_definition(cursor: TokenCursor, property_set: PropertySet) -> None:
    """Parse a definition of a property set: a property, a type, or a constant."""
    start = cursor.token.offset
    name = cursor.expect_declared("a property")
    if cursor.accept("type"):
        parse_property_type(cursor)
        property_set.types[name.lower()] = cursor.span_from(start)
    elif cursor.accept("constant"):
        parse_property_type(cursor)
        cursor.expect("=>")
        property_set.constants[name.lower()] = parse_property_value(cursor)
    else:
        cursor.accept("access")
        cursor.accept("inherit")
        parse_property_type(cursor)
        if cursor.accept("=>"):
            cursor.accept("inherit")
            parse_property_value(cursor)
        cursor.expect("applies", "to")
        _skip_brackets(cursor)
        property_set.properties[name.lower()] = cursor.span_from(start)
    cursor.expect(";")


def parse_property_type(cursor: TokenCursor) -> None:
    """Go over the type of a property."""
    with cursor.deeper():
        _parse_property_type(cursor)


def _parse_property_type(cursor: TokenCursor) -> None:
    if cursor.accept("list", "of") or cursor.accept("range", "of"):
        parse_property_type(cursor)
    elif cursor.accept("record"):
        cursor.expect("(")
        while not cursor.accept(")"):
            cursor.expect_declared("a field")
            parse_property_type(cursor)
            cursor.expect(";")
    elif cursor.accept("enumeration"):
        _skip_brackets(cursor)
    elif cursor.accept("units"):
        _parse_units(cursor)
    elif cursor.accept("classifier") or cursor.accept("reference"):
        if cursor.at("("):
            _skip_brackets(cursor)
    elif cursor.accept("aadlinteger") or cursor.accept("aadlreal"):
        _parse_number_type(cursor)
    elif not (cursor.accept("aadlboolean") or cursor.accept("aadlstring")):
        cursor.expect_path("a property type")


def _parse_number_type(cursor: TokenCursor) -> None:
    if not (cursor.at("units") or cursor.at("=>") or cursor.at(";") or cursor.at("applies") or cursor.at(")")):
        parse_property_value(cursor)
    if cursor.accept("units"):
        _parse_units(cursor)


def _parse_units(cursor: TokenCursor) -> None:
    if not cursor.accept("("):
        cursor.expect_path("units")
        return
    for _ in cursor.walk_entries(")", ","):
        cursor.expect_name("a unit")
        if cursor.accept("=>"):
            cursor.expect_name("a unit")
            cursor.expect("*")
            _parse_number(cursor)
