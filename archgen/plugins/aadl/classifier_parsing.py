"""Parse types and implementations of all categories, section by section."""

from __future__ import annotations

from collections.abc import Callable

from archgen.plugin.importing import Span
from archgen.plugins.aadl.aadl_tree import AadlConnection, AadlFlow, Classifier, Path, Subcomponent
from archgen.plugins.aadl.feature_parsing import (
    ACCESSES,
    CATEGORIES,
    PORTS,
    accept_one_of,
    parse_bindings,
    parse_dimensions,
    parse_feature,
    parse_prototype,
)
from archgen.plugins.aadl.property_parsing import (
    parse_contained_path,
    parse_modes,
    parse_property,
    parse_property_list,
)
from archgen.plugins.aadl.token_cursor import END, SECTION_WORDS, AadlSyntaxError, TokenCursor

# Those of AADL's first version, `data port` and such, are read too.
_CONNECTION_KINDS = (*ACCESSES, "port", *PORTS, "parameter", "feature group", "port group", "feature")


def at_classifier(cursor: TokenCursor) -> bool:
    """Whether a classifier begins here."""
    return cursor.at("feature", "group") or any(cursor.at(*words.split()) for words in CATEGORIES)


def parse_classifier(cursor: TokenCursor) -> Classifier:
    """Parse a type or an implementation up to its `end name;`."""
    start = cursor.token.offset
    category = accept_one_of(cursor, ("feature group", *CATEGORIES))
    is_implementation = cursor.accept("implementation")
    name = cursor.expect_name("a classifier")
    if is_implementation:
        cursor.expect(".")
        name += f".{cursor.expect_name('an implementation')}"
    classifier = Classifier(category, name, cursor.span_from(start))
    try:
        if cursor.accept("extends"):
            classifier.extends = cursor.expect_path("a classifier")
            classifier.bindings = parse_bindings(cursor)
        elif cursor.at("("):
            classifier.bindings = parse_bindings(cursor)
    except AadlSyntaxError as error:
        cursor.tell(error)
        cursor.skip_statement()
    _parse_sections(cursor, classifier)
    _parse_end(cursor, classifier)
    return classifier


def _parse_end(cursor: TokenCursor, classifier: Classifier) -> None:
    if cursor.token.kind == END or not cursor.at("end"):
        words = f"`end {classifier.name};` is missing before {_name_place(cursor)}"
        cursor.tell(
            cursor.make_error(words, f"{classifier.category} {classifier.name} begins in line {classifier.span.line}")
        )
        return
    cursor.expect_end("", classifier.name, lambda: cursor.expect_path("a classifier"))


def _name_place(cursor: TokenCursor) -> str:
    return "the end of the file" if cursor.token.kind == END else f"`{cursor.token.text}`"


def _parse_sections(cursor: TokenCursor, classifier: Classifier) -> None:
    while cursor.token.kind != END and not cursor.at("end"):
        try:
            if not _parse_section(cursor, classifier):
                return
        except AadlSyntaxError as error:
            cursor.tell(error)
            before = cursor.token
            cursor.skip_statement()
            if cursor.token is before:
                cursor.advance()


def _parse_section(cursor: TokenCursor, classifier: Classifier) -> bool:
    """Parse a section. Return whether one was here; raise AadlSyntaxError for what is none."""
    parsers = _list_section_parsers(cursor, classifier)
    words = next((words for words in parsers if cursor.accept(*words.split())), "")
    if words:
        _parse_list(cursor, parsers[words])
    elif cursor.accept("inverse", "of"):
        classifier.inverse_of = cursor.expect_path("a feature group")
    elif cursor.at("annex"):
        parse_annex(cursor, classifier.annexes)
    elif at_classifier(cursor) or cursor.at("private") or cursor.at("public"):
        return False
    else:
        cursor.fail(
            f"no section of a {classifier.category} begins with `{cursor.token.text[:40]}`",
            "features, subcomponents, connections, calls, flows, modes, properties and annexes may stand here",
        )
    return True


def _list_section_parsers(cursor: TokenCursor, classifier: Classifier) -> dict[str, Callable[[], None]]:
    """Return what parses an entry of each section, by the words with which the section begins."""
    return {
        "prototypes": lambda: classifier.prototypes.append(parse_prototype(cursor)),
        "features": lambda: classifier.features.append(parse_feature(cursor)),
        "subcomponents": lambda: classifier.subcomponents.append(parse_subcomponent(cursor)),
        "internal features": cursor.skip_statement,
        "processor features": cursor.skip_statement,
        "connections": lambda: classifier.connections.append(_parse_connection(cursor)),
        "calls": lambda: _parse_call_sequence(cursor, classifier),
        "flows": lambda: classifier.flows.append(_parse_flow(cursor)),
        "requires modes": lambda: _parse_mode(cursor, classifier),
        "modes": lambda: _parse_mode(cursor, classifier),
        "properties": lambda: classifier.properties.append(parse_property(cursor)),
    }


def _parse_list(cursor: TokenCursor, parse_entry: Callable[[], None]) -> None:
    if cursor.accept("none"):
        cursor.expect(";")
        return
    cursor.parse_entries(parse_entry, lambda: _is_section_end(cursor))


def _is_section_end(cursor: TokenCursor) -> bool:
    following = cursor.peek()
    if cursor.token.word in SECTION_WORDS:
        return following.text not in {":", "=>"} and not cursor.at("end", "to")
    if following.text == ":":
        return False
    return (
        cursor.at("requires", "modes")
        or cursor.at("internal", "features")
        or cursor.at("processor", "features")
        or cursor.at("inverse", "of")
        or (following.kind == "name" and at_classifier(cursor) and not _at_unnamed_connection(cursor))
    )


def _at_unnamed_connection(cursor: TokenCursor) -> bool:
    """Whether a connection without a name begins here: `data access a.b -> c`, `feature group a <-> b`."""
    return any(
        cursor.at(*kind.split()) and cursor.peek(len(kind.split()) + 1).text in {".", "->", "<->"}
        for kind in _CONNECTION_KINDS
        if " " in kind
    )


def parse_annex(cursor: TokenCursor, annexes: list[tuple[str, Span]]) -> None:
    """Go over an annex whole, and remember its name and place."""
    start = cursor.advance().offset
    name = cursor.expect_name("an annex")
    if cursor.token.kind == "annex":
        cursor.advance()
    else:
        cursor.expect("none")
    parse_modes(cursor)
    cursor.expect(";")
    annexes.append((name, cursor.span_from(start)))


def parse_subcomponent(cursor: TokenCursor) -> Subcomponent:
    """Parse a subcomponent, or a call, up to its `;`."""
    start = cursor.token.offset
    name = cursor.expect_declared("a subcomponent")
    refined = cursor.accept("refined", "to")
    category = accept_one_of(cursor, CATEGORIES)
    if not category:
        cursor.fail("a category is missing here: process, thread, data, device, ...")
    subcomponent = Subcomponent(name, category, cursor.span_from(start), refined=refined)
    if cursor.token.kind == "name" and not cursor.at("in", "modes"):
        # A call may name a processor's subprogram, or one of a data component: `processor.s`.
        cursor.accept("processor", ".")
        subcomponent.classifier = cursor.expect_path("a classifier")
    subcomponent.bindings = parse_bindings(cursor)
    subcomponent.dimensions = parse_dimensions(cursor)
    if subcomponent.dimensions and cursor.at("("):
        _parse_array_elements(cursor)
    subcomponent.properties = parse_property_list(cursor)
    subcomponent.modes = parse_modes(cursor)
    cursor.expect(";")
    subcomponent.span = cursor.span_from(start)
    return subcomponent


def _parse_array_elements(cursor: TokenCursor) -> None:
    cursor.expect("(")
    for _ in cursor.walk_entries(")", ","):
        cursor.expect_path("a classifier")
        parse_bindings(cursor)


def _parse_connection(cursor: TokenCursor) -> AadlConnection:
    start = cursor.token.offset
    name, refined = "", False
    if cursor.peek().text == ":":
        name = cursor.expect_declared("a connection")
        refined = cursor.accept("refined", "to")
    kind = accept_one_of(cursor, _CONNECTION_KINDS)
    if not kind:
        cursor.fail("a kind of connection is missing here: port, data access, feature group, ...")
    connection = AadlConnection(name, kind, (), (), cursor.span_from(start), refined=refined)
    if cursor.token.kind == "name" and not cursor.at("in", "modes"):
        connection.source = parse_contained_path(cursor)
        connection.both_ways = cursor.accept("<->")
        if not connection.both_ways:
            cursor.expect("->")
        connection.target = parse_contained_path(cursor)
    connection.properties = parse_property_list(cursor)
    connection.modes = parse_modes(cursor)
    cursor.expect(";")
    connection.span = cursor.span_from(start)
    return connection


def _parse_call_sequence(cursor: TokenCursor, classifier: Classifier) -> None:
    if not cursor.at("{"):
        cursor.expect_declared("a call sequence")
    cursor.expect("{")
    cursor.parse_entries(
        lambda: classifier.calls.append(parse_subcomponent(cursor)), lambda: cursor.at("}") or cursor.at("end")
    )
    cursor.expect("}")
    parse_property_list(cursor)
    parse_modes(cursor)
    cursor.expect(";")


def _parse_flow(cursor: TokenCursor) -> AadlFlow:
    start = cursor.token.offset
    name = cursor.expect_declared("a flow")
    refined = cursor.accept("refined", "to")
    kind = "end to end" if cursor.accept("end", "to", "end", "flow") else ""
    if not kind:
        cursor.expect("flow")
        kind = accept_one_of(cursor, ("source", "sink", "path"))
        if not kind:
            cursor.fail("`source`, `sink` or `path` is missing here")
    steps: list[Path] = []
    if cursor.token.kind == "name" and not cursor.at("in", "modes"):
        steps = cursor.parse_separated(lambda: parse_contained_path(cursor), "->")
    properties = parse_property_list(cursor)
    modes = parse_modes(cursor)
    cursor.expect(";")
    return AadlFlow(name, kind, tuple(steps), cursor.span_from(start), refined, properties, modes)


def _parse_mode(cursor: TokenCursor, classifier: Classifier) -> None:
    """Parse a mode or go over a transition between modes."""
    name = cursor.expect_name("a mode") if cursor.peek().text in {":", "-["} else ""
    if name and cursor.accept(":"):
        cursor.accept("refined", "to")
        initial = cursor.accept("initial")
        if cursor.accept("mode") or initial:
            classifier.modes.append(name)
            classifier.initial_mode = name if initial else classifier.initial_mode
            parse_property_list(cursor)
            cursor.expect(";")
            return
        cursor.expect_name("a mode")
    cursor.expect("-[")
    while not cursor.at("]->"):
        if cursor.token.kind == END or cursor.at(";"):
            cursor.fail("`]->` is missing here")
        cursor.advance()
    cursor.expect("]->")
    cursor.expect_name("a mode")
    parse_property_list(cursor)
    cursor.expect(";")
