"""Parse an AADL text: its packages and property sets, and all that is wrong with it."""

from __future__ import annotations

from dataclasses import dataclass, field

from archgen.plugins.aadl.aadl_tree import AadlPackage, PropertySet
from archgen.plugins.aadl.classifier_parsing import (
    CATEGORIES,
    accept_one_of,
    at_classifier,
    parse_annex,
    parse_classifier,
)
from archgen.plugins.aadl.property_parsing import parse_property, parse_property_definition
from archgen.plugins.aadl.token_cursor import END, MAX_TOKENS, AadlSyntaxError, AadlText, SyntaxFault, TokenCursor

_MAX_NAME_TOKENS = 50
"""No name of a package is longer."""


@dataclass(slots=True)
class ParsedText:
    """What an AADL text holds."""

    packages: list[AadlPackage] = field(default_factory=list)
    property_sets: list[PropertySet] = field(default_factory=list)
    faults: list[SyntaxFault] = field(default_factory=list)
    unpackaged: AadlPackage | None = None
    """What stands in no package, as AADL's first version has it; it is among the packages, with an empty name."""
    token_count: int = 0


def parse_text(file: str, text: str, max_tokens: int = MAX_TOKENS) -> ParsedText:
    """Return the packages and property sets of a text; what cannot be read is among its faults. Raise TooManyTokensError."""
    parsed = ParsedText()
    cursor = TokenCursor(AadlText(file, text), max_tokens)
    # What stands outside of a package is told once, not word by word.
    is_lost = False
    while cursor.token.kind != END:
        try:
            if cursor.at("package"):
                _parse_package(cursor, parsed)
            elif cursor.at("property", "set"):
                parsed.property_sets.append(_parse_property_set(cursor))
            elif at_classifier(cursor) and cursor.peek().kind == "name":
                _parse_unpackaged(cursor, parsed)
            elif cursor.at("with") and not is_lost:
                _parse_uses(cursor, AadlPackage("", cursor.span_from(cursor.token.offset)))
                continue
            else:
                cursor.fail("a package or a property set is missing here")
            is_lost = False
        except AadlSyntaxError as error:
            if not is_lost:
                cursor.tell(error)
            is_lost = True
            _skip_to_unit(cursor)
    parsed.faults, parsed.token_count = cursor.faults, cursor.token_count
    return parsed


def _parse_unpackaged(cursor: TokenCursor, parsed: ParsedText) -> None:
    start = cursor.token.offset
    classifier = parse_classifier(cursor)
    if parsed.unpackaged is None:
        parsed.unpackaged = AadlPackage("", cursor.source.span(start, start))
        parsed.packages.append(parsed.unpackaged)
    parsed.unpackaged.classifiers.append(classifier)


def _skip_to_unit(cursor: TokenCursor) -> None:
    while cursor.token.kind != END:
        if cursor.at("property", "set") or (cursor.at("package") and cursor.peek().kind == "name"):
            return
        cursor.advance()


def _parse_package(cursor: TokenCursor, parsed: ParsedText) -> None:
    start = cursor.expect("package").offset
    package = AadlPackage(_parse_package_name(cursor), cursor.span_from(start))
    parsed.packages.append(package)
    while cursor.token.kind != END:
        if cursor.at("end"):
            if _is_package_end(cursor, package):
                cursor.expect_end("package ", package.name, lambda: _parse_package_name(cursor))
                return
            # What it ends could not be read, which was told.
            cursor.advance()
            cursor.skip_statement()
            continue
        try:
            _parse_package_entry(cursor, package)
        except AadlSyntaxError as error:
            cursor.tell(error)
            before = cursor.token
            cursor.skip_statement()
            if cursor.token is before and not cursor.at("end"):
                cursor.advance()
    words = f"`end {package.name};` is missing before the end of the file"
    cursor.tell(cursor.make_error(words, f"package {package.name} begins in line {package.span.line}"))


def _is_package_end(cursor: TokenCursor, package: AadlPackage) -> bool:
    """Whether the `end` that stands here is the package's: by its name, or by what comes behind it."""
    distance, name = 1, cursor.peek().word
    while distance < _MAX_NAME_TOKENS and cursor.peek(distance + 1).text in {"::", "."}:
        name += cursor.peek(distance + 1).text + cursor.peek(distance + 2).word
        distance += 2
    following = cursor.peek(distance + 2)
    return name == package.name.lower() or following.kind == END or following.word in {"package", "property"}


def _parse_package_name(cursor: TokenCursor) -> str:
    return "::".join(cursor.parse_separated(lambda: cursor.expect_name("a package"), "::"))


def _parse_package_entry(cursor: TokenCursor, package: AadlPackage) -> None:
    if cursor.accept("public") or cursor.accept("private"):
        return
    if cursor.at("with"):
        _parse_uses(cursor, package)
    elif cursor.at("annex"):
        parse_annex(cursor, package.annexes)
    elif cursor.accept("properties"):
        if not (cursor.accept("none") and cursor.accept(";")):
            cursor.parse_entries(
                lambda: package.properties.append(parse_property(cursor)),
                lambda: cursor.at("end") or cursor.at("annex"),
            )
    elif _parse_renaming(cursor, package):
        return
    elif at_classifier(cursor):
        package.classifiers.append(parse_classifier(cursor))
    else:
        cursor.fail(
            f"nothing in a package begins with `{cursor.token.text[:40]}`",
            "a component type or implementation, a feature group, `with`, `renames`, or `end` may stand here",
        )


def _parse_uses(cursor: TokenCursor, package: AadlPackage | PropertySet) -> None:
    cursor.expect("with")
    while True:
        start = cursor.token.offset
        name = _parse_package_name(cursor)
        package.uses.append((name, cursor.span_from(start)))
        if not cursor.accept(","):
            break
    cursor.expect(";")


def _parse_renaming(cursor: TokenCursor, package: AadlPackage) -> bool:
    """Parse `x renames package p;`, `renames p::all;`, `renames data p::c;` if one stands here."""
    name = ""
    if cursor.token.kind == "name" and cursor.peek().word == "renames":
        name = cursor.expect_name("a short name")
    elif not cursor.at("renames"):
        return False
    cursor.expect("renames")
    if cursor.accept("package"):
        package.renames[name.lower()] = _parse_package_name(cursor).lower()
    elif accept_one_of(cursor, ("feature group", *CATEGORIES)):
        target = cursor.expect_path("a classifier")
        package.renames[(name or target.rpartition("::")[2]).lower()] = target.lower()
    else:
        parts = [cursor.expect_name("a package")]
        while cursor.accept("::") and not cursor.accept("all"):
            parts.append(cursor.expect_name("a package"))
        package.renames[f"*{'::'.join(parts).lower()}"] = "::".join(parts).lower()
    cursor.expect(";")
    return True


def _parse_property_set(cursor: TokenCursor) -> PropertySet:
    start = cursor.expect("property", "set").offset
    property_set = PropertySet(cursor.expect_name("a property set"), cursor.span_from(start))
    cursor.expect("is")
    while cursor.at("with"):
        _parse_uses(cursor, property_set)
    cursor.parse_entries(
        lambda: _parse_set_entry(cursor, property_set), lambda: cursor.at("end") and cursor.peek().kind == "name"
    )
    cursor.expect_end("property set ", property_set.name, lambda: cursor.expect_name("a property set"))
    return property_set


def _parse_set_entry(cursor: TokenCursor, property_set: PropertySet) -> None:
    if cursor.at("annex"):
        parse_annex(cursor, [])
    else:
        parse_property_definition(cursor, property_set)
