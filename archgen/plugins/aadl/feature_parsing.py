"""Parse prototypes, their bindings, and features."""

from __future__ import annotations

from archgen.plugins.aadl.aadl_tree import AadlFeature, Prototype, PrototypeBinding
from archgen.plugins.aadl.property_parsing import parse_property_list
from archgen.plugins.aadl.token_cursor import AadlSyntaxError, TokenCursor

CATEGORIES = (
    *("abstract", "bus", "data", "device", "memory", "process", "processor", "subprogram group", "subprogram"),
    *("system", "thread group", "thread", "virtual bus", "virtual processor"),
)
"""Categories of components; those of two words come before those that begin as they do."""
PORTS = ("event data port", "event port", "data port")
ACCESSES = ("virtual bus access", "bus access", "data access", "subprogram group access", "subprogram access")
_PLAIN_KINDS = (*PORTS, "parameter", "feature group", "port group", "feature")
_WORDS = {words: tuple(words.split()) for words in (*CATEGORIES, *ACCESSES, *_PLAIN_KINDS)}


def accept_one_of(cursor: TokenCursor, choices: tuple[str, ...]) -> str:
    """Go behind the first of these that stands here, and return it; or return nothing."""
    return next((words for words in choices if cursor.accept(*_WORDS.get(words) or words.split())), "")


def parse_direction(cursor: TokenCursor) -> str:
    """Parse `in`, `out`, `in out`, or nothing."""
    if cursor.accept("in"):
        return "in out" if cursor.accept("out") else "in"
    return "out" if cursor.accept("out") else ""


def parse_prototype(cursor: TokenCursor) -> Prototype:
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
    if direction := parse_direction(cursor):
        port = accept_one_of(cursor, (*PORTS, "feature"))
        return f"{direction} {port}" if port else direction
    if cursor.accept("requires") or cursor.accept("provides"):
        return accept_one_of(cursor, ACCESSES)
    category = accept_one_of(cursor, ("feature group", "feature", *CATEGORIES))
    if not category:
        cursor.fail("a category is missing here: data, subprogram, thread, ...")
    return category


def parse_bindings(cursor: TokenCursor) -> dict[str, PrototypeBinding]:
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
    direction = parse_direction(cursor)
    if direction or cursor.accept("requires") or cursor.accept("provides"):
        category = accept_one_of(cursor, (*PORTS, *ACCESSES, "feature"))
    else:
        category = accept_one_of(cursor, ("feature group", "feature", *CATEGORIES))
    classifier = "" if cursor.at(")") or cursor.at(",") else cursor.expect_path("a classifier")
    return PrototypeBinding(category, classifier, parse_bindings(cursor))


def parse_feature(cursor: TokenCursor) -> AadlFeature:
    """Parse a feature up to its `;`."""
    start = cursor.token.offset
    name = cursor.expect_declared("a feature")
    feature = AadlFeature(name, "", cursor.span_from(start))
    feature.refined = cursor.accept("refined", "to")
    feature.direction = parse_direction(cursor)
    if not feature.direction:
        feature.direction = "requires" if cursor.accept("requires") else "provides" if cursor.accept("provides") else ""
    kinds = ACCESSES if feature.direction in {"requires", "provides"} else _PLAIN_KINDS
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
    feature.dimensions = parse_dimensions(cursor)
    feature.properties = parse_property_list(cursor)
    cursor.expect(";")
    feature.span = cursor.span_from(start)
    return feature


def _parse_feature_type(cursor: TokenCursor, feature: AadlFeature) -> None:
    if cursor.accept("inverse", "of"):
        feature.inverse = True
    if feature.kind == "feature" or feature.kind in ACCESSES:
        # `feature prototype p`, and `data access data p::c` of older texts.
        accept_one_of(cursor, ("feature", *CATEGORIES))
    cursor.accept("prototype")
    if cursor.token.kind == "name":
        feature.classifier = cursor.expect_path("a classifier")
        if feature.kind == "feature group" and cursor.accept("inverse", "of"):
            feature.inverse, feature.classifier = True, cursor.expect_path("a feature group")


def parse_dimensions(cursor: TokenCursor) -> tuple[str, ...]:
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
