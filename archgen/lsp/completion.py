"""What may stand at a place: keys that are not there yet, names that fit, words, units.

A mark is put where the cursor is, and the text is read with it: so the place is known in blocks, braces and lists alike.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from lsprotocol import types

from archgen.findings.rule_pages import summarise_rule
from archgen.frozen import NamedTuple
from archgen.language.key_paths import OWN_DATA, SLICE, find_inner_part
from archgen.language.language_tables import ENTRIES, KEYS, OFFERS, SECTION_KINDS, WORDS
from archgen.live.warm_project import EditedProject
from archgen.pipeline import index_all_rules
from archgen.schema.language_schema import find_part_schema, resolve_part
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode, YamlNode
from archgen.views.elements.element_names import elements_by_kind
from archgen.views.offered_names import OfferedName

_MARK = "archgenCursorMark"
_NUMBER = re.compile(r"(?P<number>[0-9]+(?:\.[0-9]+)?) ?[A-Za-z/%]*\Z")
_UNITS = re.compile(r" \?(?:\(\?:([A-Za-z/|]+)\)|(%))\$\Z")
_WORDS = re.compile(r"\^\(\?:([a-z0-9_|]+)\)\$\Z")
_LAST_WORDS = {"selectors": re.compile(r"[\w.:/*-]*\Z"), "types": re.compile(r"[^<>,\[\]]*\Z")}
"""The part of a text that is being written, where names stand among signs."""
_SCOPED_OFFERS = {"type_input": ("types",), "references": ("sources",), "frame.by": ("implemented", "nodes")}
"""What is offered where the description says nothing since it depends on what stands around: an input of a component type has a
type alone, an output of a composed component one of its own outputs.
"""
_PORT_TABLES = {"publishes": "outputs", "serves": "outputs", "subscribes": "inputs", "calls": "inputs"} | {
    name: name for name in ("inputs", "outputs")
}
"""The keys of nodes, and of `timing`, below which ports of components stand, and where these are declared."""


class _Place(NamedTuple):
    """Where the mark stands: the part of the language, the path to it, what was typed there, and from which column on."""

    part: str
    path: tuple[str | int, ...]
    typed: str
    column: int
    mapping: MappingNode | None
    """The mapping of which a key is being written; None for a value."""
    may_be_key: bool
    """Whether what stands there alone may become a key, or whether it is one."""
    wanted_type: str | None = None
    """The `type` that is written beside it."""


class Offer(NamedTuple):
    """What may be written: its label, what is put in place of the text from a column on, and what it means."""

    label: str
    text: str
    column: int
    kind: types.CompletionItemKind
    detail: str = ""
    explanation: str = ""


def list_offers(project: EditedProject, file: str, line: int, column: int) -> list[Offer]:
    """Return what may stand at a place, the best first."""
    place = _find_place(project, file, line, column)
    if place is None:
        return []
    line_text = project.line_of(file, line) or ""
    end = "" if re.match(r"[\w.-]*\s*:", line_text[column - 1 :]) else ":"
    offers = list(_list_keys(project, place, end)) if place.may_be_key else []
    return offers + (list(_list_values(project, place)) if place.mapping is None else [])


def _find_place(project: EditedProject, file: str, line: int, column: int) -> _Place | None:
    lines = project.warm.read_lines(file)
    line_text = project.line_of(file, line) or ""
    if not 0 < line <= len(lines):
        return None
    end = lines[line - 1][len(lines[line - 1].rstrip("\r\n")) :]
    before, after = line_text[: column - 1], re.sub(r"\A[\w./-]*", "", line_text[column - 1 :])
    closing = _close_brackets(before)
    for written in (f"{_MARK}{after}", f"{_MARK}:{after}", f"{_MARK}{closing}", f"{_MARK}: x{closing}"):
        lines[line - 1] = f"{before}{written}{end}"
        document, _ = parse_yaml(file, "".join(lines))
        place = _find_mark(document.root, SLICE, (), None) if document else None
        if place is not None:
            return place
    return None


def _close_brackets(text: str) -> str:
    """Return what closes the brackets and quotes that are open at the end of a line."""
    closing: list[str] = []
    quote = ""
    for at, sign in enumerate(text):
        if quote:
            quote = "" if sign == quote else quote
        elif sign in "\"'" and (not at or text[at - 1] in " [{,:"):
            quote = sign
        elif sign in "[{":
            closing.append("]" if sign == "[" else "}")
        elif sign in "]}" and closing:
            closing.pop()
    return quote + "".join(reversed(closing))


def _find_mark(
    node: YamlNode, part: str, path: tuple[str | int, ...], key_line: int | None, holder: MappingNode | None = None
) -> _Place | None:
    """Return the place of the mark below a node; the key that leads to it stands in `key_line`, in the mapping `holder`."""
    if isinstance(node, ScalarNode):
        if _MARK not in node.text or node.span.line != node.span.end_line:
            return None
        column = node.span.column + (not node.is_plain)
        is_below = key_line is not None and node.span.line > key_line
        may_be_key = is_below and (part in KEYS or part in ENTRIES)
        wanted = holder.get("type") if holder else None
        wanted_type = wanted.text if isinstance(wanted, ScalarNode) else None
        return _Place(part, path, node.text.partition(_MARK)[0], column, None, may_be_key, wanted_type)
    if isinstance(node, SequenceNode):
        inner = find_inner_part(part, 0)
        inner = part if inner == OWN_DATA or (part in OFFERS and inner not in OFFERS) else inner
        found = (_find_mark(item, inner, (*path, number), None, holder) for number, item in enumerate(node.items))
        return next(filter(None, found), None)
    for entry in node:
        if _MARK in entry.key:
            return _Place(part, path, entry.key.partition(_MARK)[0], entry.key_span.column, node, may_be_key=True)
        inner = find_inner_part(part, entry.key)
        line = entry.key_span.line
        place = _find_mark(entry.value, inner, (*path, entry.key), line, node) if inner != OWN_DATA else None
        if place is not None:
            return place
    return None


def _list_keys(project: EditedProject, place: _Place, end: str) -> Iterator[Offer]:
    """Yield the keys of a place that are not written yet, then the ids that fit there."""
    written = place.mapping.entries.keys() if place.mapping else ()
    blank = " " if end else ""
    for key in KEYS.get(place.part, ()):
        if key not in written:
            explanation = find_part_schema(place.part, key).get("description", "")
            yield Offer(key, f"{key}{end}{blank}", place.column, types.CompletionItemKind.Property, "", explanation)
    for each in _list_ids(project, place):
        if each.name not in written:
            yield Offer(
                each.name, f"{each.name}{end}{blank}", place.column, types.CompletionItemKind.Field, each.meaning
            )


def _list_ids(project: EditedProject, place: _Place) -> Sequence[OfferedName]:
    """Return the ids that may be keys of a place: elements that another file declares (of libraries: none), ports of a node's components."""
    section = place.part
    if section in SECTION_KINDS:
        return project.offered_names.get(section, ())
    if section == "rules":
        return [OfferedName(name, summarise_rule(rule)) for name, rule in index_all_rules().items() if not rule.fixed]
    table = _PORT_TABLES.get(str(place.path[-1])) if place.path else None
    of_node = bool(place.path) and place.path[0] == "nodes"
    return _list_ports(project, place, table) if table and (of_node or "timing" in place.path) else []


def _list_ports(project: EditedProject, place: _Place, table: str) -> list[OfferedName]:
    """Return the ports of the component that a place stands in, or of those that its node implements."""
    architecture = project.checked.architecture
    components: Iterable[str] = (_find_component(place),)
    if len(place.path) > 1 and place.path[0] == "nodes":
        node = architecture.nodes.get(str(place.path[1]))
        components = node.implements if node else ()
    elif place.path[0] == "component_types":
        scope = _find_scope(project, place)
        components = (scope,) if "components" not in place.path else ()
    found = (architecture.components.get(each) or architecture.shells.get(each) for each in components)
    ports = {port.name: port.type or "" for each in found if each for port in getattr(each, table).values()}
    return [OfferedName(*each) for each in ports.items()]


def _find_component(place: _Place) -> str:
    """Return the id of the component that a place stands in; empty where it stands in none."""
    steps = [str(step) for step in place.path]
    if steps[:1] == ["variants"]:
        steps = steps[3:]
    parts = steps[1:2] if steps[:1] == ["groups"] else []
    rest = steps[2:]
    while len(rest) > 1 and rest[0] == "components":
        parts.append(rest[1])
        rest = rest[2:]
    return ".".join(parts) if len(parts) > 1 else ""


def _list_values(project: EditedProject, place: _Place) -> Iterator[Offer]:
    schema_part = resolve_part(find_part_schema(place.part))
    match = _NUMBER.match(place.typed)
    units = _UNITS.search(schema_part.get("pattern", ""))
    if match and units:
        for unit in (units[1] or units[2]).split("|"):
            text = f"{match['number']} {unit}"
            yield Offer(text, text, place.column, types.CompletionItemKind.Unit)
    pattern = _WORDS.match(schema_part.get("pattern", ""))
    words = WORDS.get(place.part) or (pattern[1].split("|") if pattern else ())
    kinds_of_value = schema_part.get("type", ())
    if "boolean" in kinds_of_value and (words or "string" not in kinds_of_value):
        words = [*words, "true", "false"]
    for word in dict.fromkeys(words):
        yield Offer(word, word, place.column, types.CompletionItemKind.EnumMember)
    kinds = _SCOPED_OFFERS.get(place.part) or OFFERS.get(place.part, ())
    if kinds == ("component_type_names",) and "<" in place.typed:
        kinds = ("types",)
    if kinds == ("selectors",):
        kinds = ("selectors", "implemented")  # a schema would become too large with them
    if kinds:
        offered = _list_ports(project, place, "inputs") if kinds == ("inputs",) else []
        offered = offered or [each for kind in kinds for each in project.offered_names[kind]]
        last_word = _LAST_WORDS.get(kinds[0])
        column = place.column + (last_word.search(place.typed).start() if last_word else 0)  # type: ignore[union-attr]
        for each in _sort_sources(project, place, offered) if kinds == ("sources",) else offered:
            yield Offer(each.name, each.name, column, types.CompletionItemKind.Reference, each.meaning)


def _sort_sources(project: EditedProject, place: _Place, offered: Sequence[OfferedName]) -> list[OfferedName]:
    """Return what an input may read: what fits its type first, then what stands around it, then the shorter form; itself last."""
    outputs = elements_by_kind(project.checked.architecture)["output"].values()
    scope = _find_scope(project, place)
    own = [each for each in outputs if scope and each.id.startswith(f"{scope}.")]
    # A component type knows nothing outside of itself.
    names = {} if place.path[0] == "component_types" else {each.name: each for each in offered}
    for output in own:  # names from around win
        short = output.id[len(scope) + 1 :]
        names.setdefault(short, OfferedName(short, output.type or ""))
    ids = {name: each for each in (*outputs, *own) for name in (each.id, each.id.partition(".")[2])}
    ids |= {each.id[len(scope) + 1 :]: each for each in own}

    itself = _find_component(place)

    def rate(each: OfferedName) -> tuple[bool, bool, bool, int, str]:
        output = ids.get(each.name)
        is_itself = output is not None and bool(itself) and output.id.startswith(f"{itself}.")
        fits = output is not None and output.type is not None and output.type == place.wanted_type
        is_own = output is not None and bool(scope) and output.id.startswith(f"{scope}.")
        return is_itself, not fits, not is_own, each.name.count("."), each.name

    return sorted(names.values(), key=rate)


def _find_scope(project: EditedProject, place: _Place) -> str:
    """Return the id of what a place stands in: a group, or an instance of a component type; empty where neither is known."""
    if len(place.path) < 2 or place.path[0] not in {"groups", "component_types"}:  # noqa: PLR2004
        return ""
    name = str(place.path[1])
    if place.path[0] == "groups":
        return name
    architecture = project.checked.architecture
    instances = (each for each in (*architecture.shells.values(), *architecture.components.values()) if each.type_name)
    return next(
        (each.id for each in instances if name in {base.id for base in architecture.list_bases(each.type_name)}), ""
    )
