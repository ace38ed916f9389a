"""Check a document against the JSON Schema, report what differs, and take it out of the tree.

Later stages rely on it: what is left has the kind of value that the schema asks for.

Find components whose inputs and outputs are exchanged, and put them right, so that one slip is one finding. Find groups
whose components are lines of their description: indented a little too far, they belong to that text.
"""

from __future__ import annotations

import functools
import re
from typing import TYPE_CHECKING, Any

import jsonschema_rs

from archgen.diagnostics import NO_SPAN, Diagnostic, Label
from archgen.language.language_tables import SECTION_KINDS
from archgen.schema.component_sugar import DECLARATION_KEYS
from archgen.schema.language_schema import load_schema
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, find_value, list_entries

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from archgen.schema.schema_wording import ErrorPlace
    from archgen.syntax.yaml_tree import MappingEntry, YamlDocument, YamlNode

_USABLE_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,199}\Z", re.ASCII)
"""Ids that only break a rule of style are reported but kept, so that references to them are not reported as well."""


def validate_document(document: YamlDocument) -> tuple[Diagnostic, ...]:
    """Report what the schema does not allow, and remove it from the document's tree in place."""
    diagnostics = [
        *mend_exchanged_ports(document),
        *find_swallowed_components(document),
    ]
    data = _to_validator_data(document.root)
    validator = _get_validator()
    if validator.is_valid(data):
        return tuple(diagnostics)
    from archgen.schema import misplaced_elements

    misplaced = tuple(misplaced_elements.mend_misplaced_elements(document))
    if misplaced:
        diagnostics.extend(misplaced)
        data = _to_validator_data(document.root)
    wrong_places: list[tuple[ErrorPlace, str | None]] = []
    seen_paths = set[tuple[str | int, ...]]()
    # Wrong types first: what else the validator says of the same value follows from it and is then left out.
    for error in sorted(validator.iter_errors(data), key=lambda error: error.kind.name != "type"):
        _record_error(document, error, diagnostics, wrong_places, seen_paths)
    # Only now: while errors are being located, their paths must still lead through an unchanged tree.
    for place, key in wrong_places:
        _prune_node(place, key)
    _drop_holes(document.root)
    return tuple(diagnostics)


@functools.cache
def _get_validator() -> jsonschema_rs.Draft202012Validator:
    schema = load_schema()
    # These are the only keys that begin with a digit: the validator sees them with the mark.
    marked = {
        name: schema["$defs"][name]
        | {"pattern": schema["$defs"][name]["pattern"].replace("^", f"^{_NUMERIC_KEY_MARK}?", 1)}
        for name in ("core_number", "deadline_share")
    }
    return jsonschema_rs.Draft202012Validator({**schema, "$defs": schema["$defs"] | marked})


def list_sections() -> frozenset[str]:
    """Return the names of the top-level sections."""
    return frozenset(load_schema()["properties"])


def _to_validator_data(node: YamlNode) -> object:
    """Turn a tree into what the validator takes.

    Floats go as text, because the validator reads NaN as null and 5.0 as a whole number. Integers are clamped to what
    it can hold.
    """
    if isinstance(node, ScalarNode):  # first: most nodes are
        plain_value = node.value
        # `type(...) is`: a bool is an int as well, and must stay a bool.
        if type(plain_value) is int:
            return max(-_INTEGER_LIMIT, min(plain_value, _INTEGER_LIMIT))
        return node.text if type(plain_value) is float else plain_value
    if isinstance(node, MappingNode):
        return {
            _NUMERIC_KEY_MARK + key if key[0] in _NUMERIC_KEY_STARTS else key: _to_validator_data(entry.value)
            for key, entry in node.entries.items()
        }
    return [_to_validator_data(item) for item in node.items]


_NUMERIC_KEY_MARK = "\0"
_NUMERIC_KEY_STARTS = frozenset("0123456789+\0")
"""First characters of keys that get the mark: the validator's paths do not tell the key `0` from the index 0."""
_INTEGER_LIMIT = 1 << 60
"""Larger than any number that the language allows, and small enough for the validator."""


def _record_error(
    document: YamlDocument,
    error: jsonschema_rs.ValidationError,
    diagnostics: list[Diagnostic],
    wrong_places: list[tuple[ErrorPlace, str | None]],
    seen_paths: set[tuple[str | int, ...]],
) -> None:
    # Sound files, which are nearly all, need no words for what is wrong with keys.
    from archgen.schema import key_wording, schema_wording

    # `seen_paths` are those already reported: one finding for each place, the first one, which is a wrong type if any.
    place = _locate_error(document.root, [_remove_key_mark(step) for step in error.instance_path])
    schema_part = _find_schema_part(error.schema_path)
    kind = error.kind.name
    # The library reports one error for all unknown keys of a mapping; each becomes a finding of its own, at its key.
    if kind == "additionalProperties" and isinstance(place.node, MappingNode):
        unexpected_kind: Any = error.kind  # its attributes depend on the kind, which the library's types do not say
        unknown_keys = tuple(map(_remove_key_mark, unexpected_kind.unexpected))
        wrong_places.extend((place, key) for key in unknown_keys)
        diagnostics.extend(key_wording.diagnose_unknown_keys(place, unknown_keys, schema_part))
    elif kind == "propertyNames" and isinstance(place.node, MappingNode):
        names_kind: Any = error.kind
        key = _remove_key_mark(names_kind.error.instance)
        if (*place.path, key, "") not in seen_paths:  # no key is empty, so this is no value's path
            seen_paths.add((*place.path, key, ""))
            diagnostics.append(key_wording.diagnose_wrong_key(place.node.entries[key], schema_part, place.path))
            if not _USABLE_ID.match(key):
                wrong_places.append((place, key))
    elif place.path not in seen_paths:
        seen_paths.add(place.path)
        diagnostics.append(schema_wording.diagnose_wrong_value(kind, place, schema_part))
        wrong_places.append((place, None))


def _remove_key_mark(step: Any) -> Any:  # noqa: ANN401 - a key or a number
    return step[1:] if isinstance(step, str) and step[0] == _NUMERIC_KEY_MARK else step


def _locate_error(root: MappingNode, path: list[str | int]) -> ErrorPlace:
    node: YamlNode = root
    parent: MappingNode | SequenceNode | None = None
    entry: MappingEntry | None = None
    for step in path:
        parent = node if isinstance(node, MappingNode | SequenceNode) else None
        if isinstance(node, MappingNode):
            entry = node.entries[str(step)]
            node = entry.value
        elif isinstance(node, SequenceNode):
            node = node.items[int(step)]
    from archgen.schema.schema_wording import ErrorPlace

    return ErrorPlace(tuple(path), node, parent, entry)


def _find_schema_part(path: Iterable[str | int]) -> dict[str, Any]:
    """Return the part of the schema that an error comes from: all but the last step, which is the keyword."""
    schema_part: Any = load_schema()
    for step in list(path)[:-1]:
        schema_part = schema_part[step]
    return schema_part  # type: ignore[no-any-return]


# Stands in for a wrong list entry until all are found: removing one at once would shift the indices of the others.
# Compared by identity, and gone from the tree when validation returns.
_HOLE_NODE = ScalarNode(None, "", NO_SPAN)
_KEPT_LIST_KEYS = frozenset({"from", "implements", "through"})
"""Keys whose absence a rule reports. Where nothing sound is left of one, an empty list keeps the fact that it was
written, so that the same mistake is not reported a second time as a missing key.
"""
_KEYS_OF_IDS = frozenset(SECTION_KINDS) | {
    *("components", "inputs", "outputs", "publishes", "subscribes", "serves", "calls"),
}


def _prune_node(place: ErrorPlace, key: str | None) -> None:
    """Take a wrong key or value out of its tree.

    An element keeps its id and loses only its content, so that references to it are not reported as well.
    """
    if key is not None and isinstance(place.node, MappingNode):
        place.node.entries.pop(key, None)
    elif isinstance(place.parent, SequenceNode):
        place.parent.items[int(place.path[-1])] = _HOLE_NODE
    elif isinstance(place.parent, MappingNode) and place.entry is not None:
        if _is_kept_list(place.path):
            place.entry.value = SequenceNode([], NO_SPAN)
        # An empty value below an id declares the element, as in `rgbd:`; normalising turns it into `{}`.
        elif len(place.path) > 1 and (place.path[-2] in _KEYS_OF_IDS or _is_part_of_declaration(place.path)):
            place.entry.value = ScalarNode(None, "", place.node.span)
        else:
            place.parent.entries.pop(place.entry.key, None)


def _is_part_of_declaration(path: tuple[str | int, ...]) -> bool:
    """Whether a path leads to a key of a parameter's declaration: without it the rest would be a set of parameters."""
    return path[-1] in DECLARATION_KEYS and "parameters" in path[:-1] and path[0] != "nodes"


def _is_kept_list(path: tuple[str | int, ...]) -> bool:
    """Whether a path is that of a key in `_KEPT_LIST_KEYS`, not of an element that happens to have such an id."""
    match path:
        case (*_, "inputs", _, "from") | ("nodes" | "chains", _, "implements" | "through"):
            return True
    return False


def _drop_holes(node: YamlNode) -> None:
    """Remove the holes from lists, and lists of which nothing is left from their mappings."""
    if isinstance(node, SequenceNode):
        node.items = [item for item in node.items if item is not _HOLE_NODE]
        for item in node.items:
            _drop_holes(item)
    elif isinstance(node, MappingNode):
        for entry in tuple(node):
            # A list that was written empty says "known to be none" and must survive.
            had_items = isinstance(entry.value, SequenceNode) and bool(entry.value.items)
            _drop_holes(entry.value)
            if (
                had_items
                and isinstance(entry.value, SequenceNode)
                and not entry.value.items
                and entry.key not in _KEPT_LIST_KEYS
            ):
                del node.entries[entry.key]


_COMPONENTS_IN_TEXT = re.compile(
    r"(?:^|(?<= ))components:[ ]*\n(?:[ ]*\n)*[ ]+[a-z][a-z0-9_]*:(?:[ ]*\n| \{)", re.MULTILINE
)
"""The key, and below it, further in, the line of a component in its long form or in braces: `lidar: sees the room` may be
prose. Where the text is folded, the key may stand behind the text's last words.
"""


def find_swallowed_components(document: YamlDocument) -> Iterator[Diagnostic]:
    """Report the descriptions of groups that hold the group's components.

    A group that has components besides is left alone: its description may well show how a project is written.
    """
    for group in list_entries(document.root, "groups"):
        body = group.value
        if isinstance(body, MappingNode) and "components" not in body.entries and "description" in body.entries:
            yield from _check_description(body.entries["description"], group.key)


def _check_description(entry: MappingEntry, group: str) -> Iterator[Diagnostic]:
    if isinstance(entry.value, ScalarNode) and _COMPONENTS_IN_TEXT.search(entry.value.text):
        yield Diagnostic(
            "wrong-value",
            "`components:` and what stands below it are lines of the text `description`",
            entry.key_span,
            help="begin `components:` in the column of `description:`",
            element=group,
        )


_DOTTED_PATH = re.compile(r"[a-z][a-z0-9_]*(?:\.[a-z][a-z0-9_]*)+\Z")
_TYPE_SIGN = re.compile(r"[A-Z /]")
"""What a reference never holds and nearly every type does: a capital, a blank, the slash of a message."""

_HOLDING_KEYS = frozenset({"components", "is", "same_as"})


def mend_exchanged_ports(document: YamlDocument) -> Iterator[Diagnostic]:
    """Report components whose outputs are references and whose inputs are types, and exchange the two in the tree."""
    for group in list_entries(document.root, "groups"):
        for component in list_entries(group.value, "components"):
            body = component.value
            inputs, outputs = find_value(body, "inputs"), find_value(body, "outputs")
            # What holds components passes on what they send: its outputs are references, and its inputs may be types.
            is_leaf = isinstance(body, MappingNode) and _HOLDING_KEYS.isdisjoint(body.entries)
            if isinstance(body, MappingNode) and is_leaf and _are_references(outputs) and _are_types(inputs):
                yield _diagnose_exchange(body, f"{group.key}.{component.key}")
                input_entry, output_entry = body.entries["inputs"], body.entries["outputs"]
                input_entry.value, output_entry.value = output_entry.value, input_entry.value


def _diagnose_exchange(component: MappingNode, component_id: str) -> Diagnostic:
    inputs, outputs = component.entries["inputs"], component.entries["outputs"]
    return Diagnostic(
        "wrong-value",
        f"the inputs and outputs of `{component_id}` look exchanged: the inputs are types, the outputs references",
        inputs.key_span,
        labels=(Label(outputs.key_span, "the references"),),
        help="exchange the two keys: an input says where it comes from, an output of what type it is",
        element=component_id,
    )


def _are_references(ports: YamlNode | None) -> bool:
    """Whether every port says where something comes from, and at least one by a dotted path."""
    has_dotted_path = False
    for port in list_entries(ports):
        for text in _list_texts(port.value, "from"):
            # Nearly always true of the first output: it has a type, and nothing else is looked at.
            if _TYPE_SIGN.search(text):
                return False
            has_dotted_path = has_dotted_path or _DOTTED_PATH.match(text) is not None
    return has_dotted_path


def _are_types(ports: YamlNode | None) -> bool:
    """Whether every port says of what type it is, and at least one by a text that no reference can be."""
    types = [text for port in list_entries(ports) for text in _list_texts(port.value, "type")]
    names_source = any(
        "from" in port.value.entries for port in list_entries(ports) if isinstance(port.value, MappingNode)
    )
    return not names_source and any(map(_TYPE_SIGN.search, types)) and not any(map(_DOTTED_PATH.match, types))


def _list_texts(port: YamlNode, key: str) -> list[str]:
    """Return what a port says in short form or at a key, as a list."""
    node = port.get(key) if isinstance(port, MappingNode) else port
    items = node.items if isinstance(node, SequenceNode) else [node]
    return [item.text for item in items if isinstance(item, ScalarNode) and item.value is not None]
