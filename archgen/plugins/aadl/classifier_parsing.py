"""Parse types and implementations of all categories, section by section."""

from __future__ import annotations

from collections.abc import Callable

from archgen.plugin.importing import Span
from archgen.plugins.aadl.aadl_tree import (
    AadlConnection,
    AadlFeature,
    AadlFlow,
    Classifier,
    Path,
    Prototype,
    PrototypeBinding,
    Subcomponent,
)
from archgen.plugins.aadl.property_parsing import (
    parse_contained_path,
    parse_modes,
    parse_property,
    parse_property_list,
)
from archgen.plugins.aadl.token_cursor import END, SECTION_WORDS, AadlSyntaxError, TokenCursor

CATEGORIES = (
    *("abstract", "bus", "data", "device", "memory", "process", "processor", "subprogram group", "subprogram"),
    *("system", "thread group", "thread", "virtual bus", "virtual processor"),
)
"""Categories of components; those of two words come before those that begin as they do."""
PORTS = ("event data port", "event port", "data port")
_ACCESSES = ("virtual bus access", "bus access", "data access", "subprogram group access", "subprogram access")
_PLAIN_KINDS = (*PORTS, "parameter", "feature group", "port group", "feature")
_WORDS = {words: tuple(words.split()) for words in (*CATEGORIES, *_ACCESSES, *_PLAIN_KINDS)}


def accept_one_of(cursor: TokenCursor, choices: tuple[str, ...]) -> str:
    """Go behind the first of these that stands here, and return it; or return nothing."""
    return next((words for words in choices if cursor.accept(*_WORDS.get(words) or words.split())), "")


def _parse_direction(cursor: TokenCursor) -> str:
    """Parse `in`, `out`, `in out`, or nothing."""
    if cursor.accept("in"):
        return "in out" if cursor.accept("out") else "in"
    return "out" if cursor.accept("out") else ""


def _parse_prototype(cursor: TokenCursor) -> Prototype:
    """Parse a prototype up to its `;`."""
    start = cursor.token.offset
    name = cursor.expect_declared("a prototype")
    cursor.accept("refined", "to")
    category = _parse_prototype_category(cursor)
    classifier = "" if cursor.token.kind != "name" else cursor.expect_path("a classifier")
    if cursor.accept("["):
        cursor.expect("]")
    parse_property_list(cursor)
    cursor.expect(";")
    return Prototype(name, category, classifier, cursor.span_from(start))


def _parse_prototype_category(cursor: TokenCursor) -> str:
    if direction := _parse_direction(cursor):
        port = accept_one_of(cursor, (*PORTS, "feature"))
        return f"{direction} {port}" if port else direction
    if cursor.accept("requires") or cursor.accept("provides"):
        return accept_one_of(cursor, _ACCESSES)
    category = accept_one_of(cursor, ("feature group", "feature", *CATEGORIES))
    if not category:
        cursor.fail("a category is missing here: data, subprogram, thread, ...")
    return category


def _parse_bindings(cursor: TokenCursor) -> dict[str, PrototypeBinding]:
    """Parse `(message => data chat::Chat, ...)` if it stands here."""
    if not cursor.accept("("):
        return {}
    bindings: dict[str, PrototypeBinding] = {}
    with cursor.deeper():
        for _ in cursor.walk_entries(")", ","):
            name = cursor.expect_name("a prototype")
            cursor.expect("=>")
            bindings[name.lower()] = _parse_actual(cursor)
    return bindings


def _parse_actual(cursor: TokenCursor) -> PrototypeBinding:
    if cursor.accept("("):
        # An array of actuals: the first stands for all.
        with cursor.deeper():
            first, *_ = cursor.parse_separated(lambda: _parse_actual(cursor), ",")
        cursor.expect(")")
        return first
    direction = _parse_direction(cursor)
    if direction or cursor.accept("requires") or cursor.accept("provides"):
        category = accept_one_of(cursor, (*PORTS, *_ACCESSES, "feature"))
    else:
        category = accept_one_of(cursor, ("feature group", "feature", *CATEGORIES))
    classifier = "" if cursor.at(")") or cursor.at(",") else cursor.expect_path("a classifier")
    return PrototypeBinding(category, classifier, _parse_bindings(cursor))


def _parse_feature(cursor: TokenCursor) -> AadlFeature:
    """Parse a feature up to its `;`."""
    start = cursor.token.offset
    name = cursor.expect_declared("a feature")
    feature = AadlFeature(name, "", cursor.span_from(start))
    feature.refined = cursor.accept("refined", "to")
    feature.direction = _parse_direction(cursor)
    if not feature.direction:
        feature.direction = "requires" if cursor.accept("requires") else "provides" if cursor.accept("provides") else ""
    kinds = _ACCESSES if feature.direction in {"requires", "provides"} else _PLAIN_KINDS
    kind_token = cursor.token
    feature.kind = accept_one_of(cursor, kinds) or ("feature" if cursor.at("prototype") else "")
    if feature.kind == "port group":
        feature.kind = "feature group"
    if not feature.kind:
        cursor.fail(
            f"no feature begins so: {' or '.join(f'`{kind}`' for kind in kinds if kind != 'port group')} is missing here"
        )
    if feature.kind.endswith("port") and not feature.direction:
        words = "a port has a direction: `in`, `out` or `in out`"
        raise AadlSyntaxError(words, kind_token, "write it before the kind of the port")
    _parse_feature_type(cursor, feature)
    feature.dimensions = _parse_dimensions(cursor)
    feature.properties = parse_property_list(cursor)
    cursor.expect(";")
    feature.span = cursor.span_from(start)
    return feature


def _parse_feature_type(cursor: TokenCursor, feature: AadlFeature) -> None:
    if cursor.accept("inverse", "of"):
        feature.inverse = True
    if feature.kind == "feature" or feature.kind in _ACCESSES:
        # `feature prototype p`, and `data access data p::c` of older texts.
        accept_one_of(cursor, ("feature", *CATEGORIES))
    cursor.accept("prototype")
    if cursor.token.kind == "name":
        feature.classifier = cursor.expect_path("a classifier")
        if feature.kind == "feature group" and cursor.accept("inverse", "of"):
            feature.inverse, feature.classifier = True, cursor.expect_path("a feature group")


def _parse_dimensions(cursor: TokenCursor) -> tuple[str, ...]:
    """Parse `[3][n]` if it stands here."""
    dimensions: list[str] = []
    while cursor.accept("["):
        text = ""
        while not cursor.accept("]"):
            if cursor.token.kind not in {"name", "number"} and not cursor.at("::"):
                cursor.fail("`]` is missing here")
            text += cursor.advance().text
        dimensions.append(text)
    return tuple(dimensions)


# Those of AADL's first version, `data port` and such, are read too.
_CONNECTION_KINDS = (*_ACCESSES, "port", *PORTS, "parameter", "feature group", "port group", "feature")


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
            classifier.bindings = _parse_bindings(cursor)
        elif cursor.at("("):
            classifier.bindings = _parse_bindings(cursor)
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
        "prototypes": lambda: classifier.prototypes.append(_parse_prototype(cursor)),
        "features": lambda: classifier.features.append(_parse_feature(cursor)),
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
    subcomponent.bindings = _parse_bindings(cursor)
    subcomponent.dimensions = _parse_dimensions(cursor)
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
        _parse_bindings(cursor)


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
