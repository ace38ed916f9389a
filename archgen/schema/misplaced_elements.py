"""Find sections that hold another section's elements, and elements and keys one level too deep or too high, and put
them right in the tree, so that one slip of the indentation or of a section's name is one finding.

It is only asked of files that the schema refuses: whatever is valid stays as it was written.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from archgen.diagnostics import Diagnostic, find_closest
from archgen.schema import key_places, key_wording
from archgen.schema.language_schema import load_schema, resolve_part
from archgen.schema.schema_wording import add_article, element_of_path
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, list_entries

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.schema.key_places import KeyPath
    from archgen.syntax.yaml_tree import YamlDocument, YamlNode

SchemaPart = dict[str, Any]


def mend_misplaced_elements(document: YamlDocument) -> Iterator[Diagnostic]:
    """Report what stands in a wrong section or at a wrong level, and move it where it belongs."""
    yield from _mend_section_names(document.root)
    yield from _mend_levels(document.root, load_schema(), ())


def _mend_section_names(root: MappingNode) -> Iterator[Diagnostic]:
    for entry in list(root):
        section = key_places.find_other_section(entry)
        if section is not None:
            yield _diagnose_section_name(entry, section)
            _rename_section(root, entry, section)


def _diagnose_section_name(entry: MappingEntry, section: str) -> Diagnostic:
    return Diagnostic(
        "unknown-key",
        f"what stands below `{entry.key}` are elements of `{section}`",
        entry.key_span,
        help=f"write `{section}:` instead of `{entry.key}:`",
    )


def _rename_section(root: MappingNode, entry: MappingEntry, section: str) -> None:
    target = root.get(section)
    if isinstance(target, MappingNode) and isinstance(entry.value, MappingNode):
        target.entries = {**entry.value.entries, **target.entries}
        del root.entries[entry.key]
    elif section not in root.entries:
        renamed_entry = MappingEntry(section, entry.key_span, entry.value)
        root.entries = {
            name: old
            for other in root
            for name, old in [(section, renamed_entry) if other is entry else (other.key, other)]
        }


def _mend_levels(holder: MappingNode, holder_part: SchemaPart, path: KeyPath) -> Iterator[Diagnostic]:
    """Mend all levels below a file or an element."""
    for name in list(holder.entries):
        elements, element_part = holder.get(name), _find_element_part(holder_part, name)
        if isinstance(elements, MappingNode) and element_part is not None:
            yield from _mend_keys(holder, holder_part, name, element_part, path)
            yield from _mend_elements(elements, element_part, (*path, name))
            for element in elements:
                if isinstance(element.value, MappingNode):
                    yield from _mend_levels(element.value, element_part, (*path, name, element.key))


def _mend_keys(
    holder: MappingNode, holder_part: SchemaPart, name: str, element_part: SchemaPart, path: KeyPath
) -> Iterator[Diagnostic]:
    """Mend keys that stand among the elements of `holder`'s mapping `name`: keys of the holder, or of the element above."""
    elements = holder.entries[name].value
    previous: MappingEntry | None = None
    is_reported = False
    for element in list_entries(elements):
        above = previous.value if previous else None
        strange_keys = _list_strange_keys(element.value, element_part)
        if strange_keys and element.key in element_part["properties"] and _lacks_key(above, element.key):
            owner_part, owner_path = element_part, (*path, name, *([previous.key] if previous else ()))
            help_line = f"indent it below `{owner_path[-1]}`"
            _lower_entry(elements, element, strange_keys, above)
        elif strange_keys and strange_keys >= _list_keys(element.value) and _can_rise(element, holder, holder_part):
            owner_part, owner_path, help_line = holder_part, path, f"begin it in the column of `{name}`"
            _move_entry(elements, element.key, holder)
        else:
            previous, is_reported = element, False
            continue
        # Several keys behind one another, shifted together, are one slip.
        if not is_reported:
            yield _diagnose_level(element, owner_part, element_part, help_line, owner_path)
        is_reported = True


def _can_rise(element: MappingEntry, holder: MappingNode, holder_part: SchemaPart) -> bool:
    return element.key in holder_part["properties"] and element.key not in holder.entries


def _diagnose_level(
    entry: MappingEntry, owner_part: SchemaPart, element_part: SchemaPart, help_line: str, path: KeyPath
) -> Diagnostic:
    owner = f"a key of {add_article(owner_part['title'])}" if path else "a section"
    message = f"`{entry.key}` is {owner}, but stands where {add_article(element_part['title'])} does"
    return Diagnostic("unknown-key", message, entry.key_span, help=help_line, element=element_of_path(path))


def _mend_elements(elements: MappingNode, element_part: SchemaPart, path: KeyPath) -> Iterator[Diagnostic]:
    """Mend elements among the keys of another element: its siblings, or what it holds by id."""
    for element in list(elements):
        body = element.value
        for entry in list_entries(body):
            if entry.key in element_part["properties"]:
                continue
            target = _find_home(elements, body, entry, element_part)
            if target is not None and entry.key not in target.entries:
                yield key_wording.diagnose_unknown_key(entry, element_part, (*path, element.key))
                _move_entry(body, entry.key, target)


def _find_home(
    elements: MappingNode, body: YamlNode, entry: MappingEntry, element_part: SchemaPart
) -> MappingNode | None:
    """Return the mapping of elements that an entry belongs to by its keys, made if need be; None if that is unclear."""
    if key_places.looks_like_part(entry.value, element_part):
        return elements
    names = [
        name
        for name in element_part["properties"]
        if key_places.looks_like_part(entry.value, _find_element_part(element_part, name) or {})
    ]
    if len(names) != 1 or not isinstance(body, MappingNode):
        return None
    home = body.entries.setdefault(names[0], MappingEntry(names[0], entry.key_span, MappingNode({}, entry.key_span)))
    if isinstance(home.value, ScalarNode) and home.value.value is None:
        home.value = MappingNode({}, home.value.span)
    return home.value if isinstance(home.value, MappingNode) else None


def _find_element_part(schema_part: SchemaPart, name: str) -> SchemaPart | None:
    """Return the part of the schema for the elements that stand below a key by id; None where there are none."""
    below = resolve_part(schema_part["properties"].get(name, {}))
    elements = below.get("additionalProperties")
    element_part = resolve_part(elements) if isinstance(elements, dict) else {}
    return element_part if "properties" in element_part and "title" in element_part else None


def _list_keys(node: YamlNode) -> set[str]:
    return set(node.entries) if isinstance(node, MappingNode) else set()


def _list_strange_keys(node: YamlNode, element_part: SchemaPart) -> set[str]:
    """Return the keys of a mapping that are, and could be meant as, no keys of an element; none unless the first is one.

    What stands behind an element's own keys is a slip in that element.
    """
    known_keys = element_part["properties"]
    strange_keys: set[str] = set()
    for key in node.entries if isinstance(node, MappingNode) else ():
        if key not in known_keys and not find_closest(key, known_keys):
            strange_keys.add(key)
        elif not strange_keys:
            break
    return strange_keys


def _lacks_key(node: YamlNode | None, key: str) -> bool:
    return isinstance(node, MappingNode) and key not in node.entries


def _move_entry(source: YamlNode, key: str, target: YamlNode | None) -> None:
    if isinstance(source, MappingNode) and isinstance(target, MappingNode):
        target.entries[key] = source.entries.pop(key)


def _lower_entry(elements: YamlNode, entry: MappingEntry, strange_keys: set[str], above: YamlNode | None) -> None:
    """Move a key into the element above it, and with it what stood behind it there: that element's other keys."""
    _move_entry(elements, entry.key, above)
    for key in sorted(_list_keys(entry.value) - strange_keys):
        if _lacks_key(above, key):
            _move_entry(entry.value, key, above)
