"""Say where a key belongs that stands at the wrong level, or an element that stands beside its section."""

from __future__ import annotations

from typing import Any

from archgen.diagnostics import find_closest, join_words
from archgen.language.language_tables import OTHER_WORDS, SECTION_KINDS
from archgen.schema.language_schema import TELLING_NOTHING, list_keys, load_schema, resolve_part
from archgen.schema.schema_wording import add_article
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode

KeyPath = tuple[str | int, ...]

_SETTING_SECTIONS = frozenset({"component_types", "libraries", "properties"})
"""Sections whose elements have no keys by which they could be told from components, or from data."""
_ELEMENT_SECTIONS = {section: kind for section, kind in SECTION_KINDS.items() if section not in _SETTING_SECTIONS}
_HOMELESS_KINDS = frozenset({"requirement", "view", "policy"})
"""Kinds whose own keys are words of many meanings: `parent`, `kind`, `source`, `show`, `level`, `accepted`."""
_HOMES = {
    "node": "`nodes: {{NODE: {{{implements}{key}: ...}}}}`",
    "topic_use": "`nodes: {{NODE: {{{implements}{use}: {{{port}: {{{key}: ...}}}}}}}}`",
    "timing": "`timing: {{{key}: ...}}` of the component or of its node",
    "type": "`types: {{{type}: {{{key}: ...}}}}`",
    "component": "`groups: {{GROUP: {{components: {{COMPONENT: {{{key}: ...}}}}}}}}`",
}
"""Where the keys of a kind are written, where that is not below its section alone."""
_HOMES |= {
    kind: f"`{section}: {{{{{kind.upper().replace('_', '-')}: {{{{{{key}}: ...}}}}}}}}`"
    for section, kind in _ELEMENT_SECTIONS.items()
    if kind not in {*_HOMES, *_HOMELESS_KINDS}
}
"""The first kind that has a key is its home."""
_GIVER_KEYS = frozenset({"promise"})
"""Keys that only an output has."""
_READER_KEYS = frozenset({"freshness", "optional"})
"""Keys that only an input has, and that say by themselves what they are about: `from` and `type` do not."""
_FORBIDDEN_OF = (
    "a flow has two ends: `forbid: {from: ..., to: ...}`; `of` belongs to `require`, which asks something of elements"
)
_REQUIRED_ENDS = "`require` asks something of elements: `require: {of: ..., inputs_from: ...}`; what may not flow stands below `forbid`"
_POLICY_KEYS = {
    "forbid": dict.fromkeys(("of", "inputs_from", "outputs_to"), _FORBIDDEN_OF),
    "require": dict.fromkeys(("from", "to"), _REQUIRED_ENDS),
}
"""Help for the keys that one kind of policy has and the other has not."""
_PORT_USES = {"inputs": "subscribes", "outputs": "publishes"}
"""Ports, and the key at a node below which their topics stand."""
_NODE_DEPTH = 2
_KINDRED_SECTIONS = frozenset({"groups", "nodes", "component_types", "types", "containers"})
"""Sections whose elements say parts of one thing: a key that stands at the wrong one of them belongs to another. A word of an element
elsewhere, such as the `latency` of a chain, is no key of a link for all that.
"""
_KINDRED_KINDS = ("timing", "node", "topic_use", "type")
_PORT_HOMES = ("type", "topic_use", "timing", "node")
"""The order at an input or an output: its message is that of its type, its topic and QoS are the node's."""
_NAMED_ELEMENTS = {"node": "nodes", "nodes": "nodes", "type": "types", "host": "hosts", "chain": "chains"}
"""Words for an element where an element of another kind is written, and their sections."""


def find_key_home(key: str, path: KeyPath, kind: str) -> str | None:
    """Return the place where a key is written that an element of a kind (its title in the schema) does not have."""
    is_port = path[:1] == ("groups",) and path[-2:-1] in {("inputs",), ("outputs",)}
    is_policy = path[:1] == ("policies",) and key in _POLICY_KEYS.get(str(path[-1]), {})
    if is_policy or (path[:1] == ("variants",) and path[2:] == ("changes",)):
        return _POLICY_KEYS[str(path[-1])][key] if is_policy else _find_changes_help(key)
    port_use = _PORT_USES.get(key) if path[:1] == ("nodes",) and len(path) == _NODE_DEPTH else None
    parent = _find_parent(key, kind) if port_use is None else None
    if path == ("generate",) and find_closest(key, ("backends", "into")) is None:
        parent = "backends"  # a generator's name
    if parent is not None or key in TELLING_NOTHING:
        return f"write it below `{parent}`: `{parent}: {{{key}: ...}}`" if parent else None
    if key in _READER_KEYS and kind != "Input":
        return f"write it at the input that reads it: `inputs: {{INPUT: {{from: ..., {key}: ...}}}}`"
    if key in _GIVER_KEYS and kind != "Output":
        return f"write it at the output that it is about: `outputs: {{OUTPUT: {{{key}: ...}}}}`"
    home, key = _find_home(key, _list_homes(path, is_port=is_port))
    if home is None or port_use:
        return (
            f"{key} stand at the component; the topic of one stands at the node below `{port_use}`"
            if port_use
            else _find_section_help(key, path)
        )
    component = _find_component(path)
    place = _HOMES[home].format(
        key=key,
        implements=f"implements: {component}, " if component else "",
        port=path[-1] if is_port else "PORT",
        use="subscribes" if "inputs" in path else "publishes",
        type="TYPE",
    )
    return f"write it as {place}"


def find_meant_key(entry: MappingEntry, title: str) -> str | None:
    """Return the key of an element that is called by another word elsewhere."""
    if entry.key in load_schema()["properties"] and isinstance(entry.value, MappingNode):
        return None  # a section that is indented too far
    kinds = (kind for kind in OTHER_WORDS if load_schema()["$defs"][kind]["title"] == title)
    return next((OTHER_WORDS[kind].get(entry.key) for kind in kinds), None)


def find_sibling_help(entry: MappingEntry, path: KeyPath, kind: str) -> str | None:
    """Return help for an unknown key that looks like an element indented too far, or too little."""
    if not path:
        section = find_section_of(entry)
        return f"put it below `{section}:`, indented" if section else None
    is_component, section_kind = _looks_like(entry.value, "component"), _ELEMENT_SECTIONS.get(str(path[0]))
    match path:
        case ("groups", element_id) if looks_like_part(entry.value, load_schema()["$defs"]["group"]) and _holds(
            entry, "components"
        ):
            return f"it looks like a group of its own: begin it in the column of `{element_id}`"
        case ("groups", element_id) if is_component:
            return f"it looks like a component: indent it below `components:` of `{element_id}`"
        case ("groups", _, "components", element_id) if is_component:
            return f"it looks like a component: begin it in the column of `{element_id}`"
        case (_, element_id) if section_kind and _looks_like(entry.value, section_kind):
            wrapped_keys = [f"`{key}`" for key in entry.value.entries] if isinstance(entry.value, MappingNode) else []
            return (
                f"write {join_words(wrapped_keys)} at `{element_id}` itself"
                if entry.key in OTHER_WORDS.get(section_kind, ())
                else f"it looks like {add_article(kind)} of its own: begin it in the column of `{element_id}`"
            )
    return None


def _holds(entry: MappingEntry, key: str) -> bool:
    return isinstance(entry.value, MappingNode) and key in entry.value.entries


def find_section_of(entry: MappingEntry) -> str | None:
    """Return the section that an entry is an element of by its keys; None where none or several fit."""
    sections = [section for section, kind in _ELEMENT_SECTIONS.items() if _looks_like(entry.value, kind)]
    return sections[0] if len(sections) == 1 else None


def find_other_section(entry: MappingEntry) -> str | None:
    """Return the section whose elements stand below another section's name; None where its own may be meant."""
    own_kind = _ELEMENT_SECTIONS.get(entry.key)
    if own_kind is None or not isinstance(entry.value, MappingNode):
        return None
    bodies = [
        part.value.entries.keys() - TELLING_NOTHING for part in entry.value if isinstance(part.value, MappingNode)
    ]
    foreign_keys = [key for body in bodies for key in body if key not in list_keys(own_kind)]
    # One such key may be a slip in an element of this section.
    if len(foreign_keys) < 2 or any(body and body <= list_keys(own_kind) for body in bodies):  # noqa: PLR2004
        return None
    sections = [name for name, kind in _ELEMENT_SECTIONS.items() if all(body <= list_keys(kind) for body in bodies)]
    return sections[0] if len(sections) == 1 else None


def may_be_section(entry: MappingEntry, section: str) -> bool:
    """Whether what an entry holds may be meant as a section: its elements have keys that those of the section have."""
    kind = _ELEMENT_SECTIONS.get(section)
    if kind is None or not isinstance(entry.value, MappingNode):
        return True
    known_keys = list_keys(kind)
    bodies = [part.value for part in entry.value if isinstance(part.value, MappingNode) and part.value.entries]
    return not bodies or any(not known_keys.isdisjoint(body.entries) for body in bodies)


def is_meant_for_language(entry: MappingEntry) -> bool:
    """Whether a key of a file without sections was certainly meant for the language: a misspelt section with elements
    that have its keys only, or a group or node beside its section.
    """
    if not isinstance(entry.value, MappingNode):
        return False
    if not {"components", "implements"}.isdisjoint(entry.value.entries):
        return find_section_of(entry) is not None
    if entry.key == "components":
        return any(_looks_like(part.value, "component") for part in entry.value)
    section = find_closest(entry.key, _ELEMENT_SECTIONS)
    bodies = [part.value for part in entry.value if isinstance(part.value, MappingNode)]
    return section is not None and any(bodies) and all(_looks_like(body, _ELEMENT_SECTIONS[section]) for body in bodies)


def looks_like_frames(mapping: MappingNode) -> bool:
    """Whether a mapping holds coordinate frames: nothing else's keys, and a frame that stands in another."""
    values = [entry.value for entry in mapping]
    bodies = [value for value in values if isinstance(value, MappingNode)]
    parents = [body.get("parent") for body in bodies if "parent" in body.entries]
    parents += [value for value in values if isinstance(value, ScalarNode) and value.text in mapping.entries]
    return bool(parents) and all(list_keys("frame").issuperset(body.entries) for body in bodies)


def find_common_kind(keys: tuple[str, ...]) -> str | None:
    """Return the kind of element that has all of several keys, such as `component` for inputs and outputs; None where none has."""
    return next((kind for kind in _HOMES if list_keys(kind).issuperset(keys)), None) if len(keys) > 1 else None


def _list_homes(path: KeyPath, *, is_port: bool) -> tuple[str, ...]:
    """Return the kinds of which a key may be that stands at an element: the surest first."""
    if is_port:
        return _PORT_HOMES
    if path[:1] == ("variants",):
        path = path[3:]
    if not path:
        # Beside the sections stands what should have a group around it: its `components` are meant, not those of a component.
        return ("group", *_HOMES)
    if path[0] == "groups" and len(path) == _NODE_DEPTH:
        return ("component", *_KINDRED_KINDS)
    return (*_KINDRED_KINDS, "component") if path[0] in _KINDRED_SECTIONS else ()


def _find_home(key: str, kinds: tuple[str, ...]) -> tuple[str | None, str]:
    """Return the kind that has a key, and the key, by which a word of elsewhere is meant."""
    if (kind := _find_kind(key, kinds)) is not None:
        return kind, key
    words = {kind: OTHER_WORDS.get(kind, {}).get(key) for kind in kinds}
    return next(((kind, meant) for kind, meant in words.items() if meant), (None, key))


def _find_kind(key: str, kinds: tuple[str, ...]) -> str | None:
    return next((kind for kind in kinds if key in list_keys(kind)), None)


def _find_parent(key: str, kind: str) -> str | None:
    """Return the key of an element below which another key is written: `timing` for `rate`."""
    definitions = (load_schema(), *load_schema()["$defs"].values())
    definition: dict[str, Any] = next((part for part in definitions if part.get("title") == kind), {})
    for parent, part in definition.get("properties", {}).items():
        below = resolve_part(part)
        if key in below.get("properties", ()) and below.get("title") != kind:
            return str(parent)
    return None


def _find_changes_help(key: str) -> str | None:
    """Return help for a key that no section of a variant's changes has."""
    if key == "components":
        return "components are changed in their group: `groups: {GROUP: {components: {COMPONENT: ...}}}`"
    if key in list_keys("variant"):
        return f"`{key}` says something of the variant: begin it in the column of `changes`"
    if key in load_schema()["properties"]:
        return f"no variant changes `{key}`: it says what the project is, and holds in all of them"
    home = _find_kind(key, tuple(_HOMES))
    return (
        f"write it as {_HOMES[home].format(key=key, implements='', use='publishes', port='PORT', type='TYPE')}"
        if home
        else None
    )


def _find_component(path: KeyPath) -> str | None:
    """Return the id of the component that a path leads into."""
    match path:
        case ("groups", group, "components", component, *_):
            return f"{group}.{component}"
    return None


def _find_section_help(key: str, path: KeyPath) -> str | None:
    section = _NAMED_ELEMENTS.get(key)
    if section == "nodes" and (component := _find_component(path)):
        return f"nodes are written in their own section: `nodes: {{NODE: {{implements: {component}}}}}`"
    if path and (section or key in load_schema()["properties"]):
        return f"`{section or key}` is a section of its own: it begins in the first column"
    return None


def _looks_like(node: YamlNode, kind: str) -> bool:
    """Whether a mapping has keys of a kind only, and one that not every kind has."""
    return looks_like_part(node, load_schema()["$defs"][kind])


def looks_like_part(node: YamlNode, schema_part: dict[str, Any]) -> bool:
    """Whether a mapping has keys of a part of the schema only, and one that not every kind of element has."""
    known_keys = schema_part.get("properties", {})
    return (
        isinstance(node, MappingNode)
        and all(key in known_keys for key in node.entries)
        and not TELLING_NOTHING.issuperset(node.entries)
    )
