"""What a variant writes to: it may add elements, but a slip in an id must not make a second one."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.suggestions import did_you_mean
from archgen.language.language_tables import DECLARING_KEYS, SECTION_KINDS
from archgen.link import mapping_values
from archgen.link.slice_merging import declares_itself
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

_INSTANCE_KEYS = frozenset({"is", "same_as"})


class ChangeTargets:
    """Sorts what a variant writes: `sound` is what has a target, or declares something new."""

    def __init__(self, root: MappingNode, changes: MappingNode, lost_keys: frozenset[str]) -> None:
        """Take the project before the changes, the changes, and what could not be read: nobody knows of its elements."""
        self.diagnostics: list[Diagnostic] = []
        self._root = root
        self._lost_keys = lost_keys
        self.sound = MappingNode(
            {section.key: self._keep_sound(section) for section in changes}, changes.span, changes.declares
        )

    def _keep_sound(self, section: MappingEntry) -> MappingEntry:
        if not isinstance(section.value, MappingNode):
            return section
        known = mapping_values.get_mapping(self._root, section.key)
        if section.key == "groups":
            kept = {e.key: self._keep_group(known, e) for e in section.value if self._is_known_group(known, e)}
        elif (kind := SECTION_KINDS.get(section.key, "")) in DECLARING_KEYS:
            kept = {e.key: e for e in section.value if self._is_sound(kind, known, e)}
        else:
            return section
        return MappingEntry(section.key, section.key_span, MappingNode(kept, section.value.span))

    def _is_sound(self, kind: str, known_body: MappingNode, entry: MappingEntry) -> bool:
        body = mapping_values.get_body(entry)
        is_new = entry.key not in known_body.entries and entry.key not in self._lost_keys
        if is_new and body.entries.keys().isdisjoint(DECLARING_KEYS[kind]):
            needed = " or ".join(f"`{key}`" for key in DECLARING_KEYS[kind][:2])
            self._report(entry, kind, entry.key, list(known_body.entries), f"a new one has {needed}")
            return False
        return True

    def _is_known_group(self, known_body: MappingNode, group: MappingEntry) -> bool:
        body = mapping_values.get_body(group)
        if group.key in known_body.entries or group.key in self._lost_keys or not body.entries:
            return True
        if "title" in body.entries or any(
            declares_itself(component.value) for component in mapping_values.get_mapping(body, "components")
        ):
            return True
        self._report(group, "group", group.key, list(known_body.entries), "a new one has a title or a component")
        return False

    def _keep_group(self, known_body: MappingNode, group: MappingEntry) -> MappingEntry:
        below = known_body.entries.get(group.key)
        return self._keep_parts(
            group, mapping_values.get_body(below) if below else mapping_values.EMPTY_MAPPING, group.key
        )

    def _keep_parts(self, holder: MappingEntry, known_body: MappingNode, holder_id: str) -> MappingEntry:
        """Return a group or component with the components inside that the project has, or that declare themselves."""
        body = mapping_values.get_body(holder)
        # What an instance has inside is in its type: writing out types judges that.
        if "components" not in body.entries or not _INSTANCE_KEYS.isdisjoint({*body.entries, *known_body.entries}):
            return holder
        known = mapping_values.get_mapping(known_body, "components")
        kept: dict[str, MappingEntry] = {}
        for part in mapping_values.get_mapping(body, "components"):
            part_id = f"{holder_id}.{part.key}"
            if part.key in known.entries:
                kept[part.key] = self._keep_parts(part, mapping_values.get_body(known.entries[part.key]), part_id)
            elif declares_itself(part.value) or _is_stub(part) or part.key in self._lost_keys:
                kept[part.key] = part
            else:
                names = [f"{holder_id}.{name}" for name in known.entries]
                help_line = "a new one has a title, a functionality, inputs or outputs"
                self._report(part, "component", part_id, names, help_line)
        components = body.entries["components"]
        parts = MappingNode(kept, components.value.span)
        entries = {**body.entries, "components": MappingEntry("components", components.key_span, parts)}
        return MappingEntry(holder.key, holder.key_span, MappingNode(entries, body.span, body.declares))

    def _report(self, entry: MappingEntry, kind: str, name: str, known_names: list[str], new_help: str) -> None:
        self.diagnostics.append(
            Diagnostic(
                "undeclared-element",
                f"a variant changes the {kind} `{name}`, which nothing declares",
                entry.key_span,
                help=did_you_mean(name, known_names) or new_help,
                element=name,
            )
        )


def _is_stub(part: MappingEntry) -> bool:
    return isinstance(part.value, MappingNode) and not part.value.entries and part.value.declares


def list_declared_anew(changes: MappingNode) -> Iterator[str]:
    """Yield the components that a variant declares, by complete ids, also such as the project has."""
    for group in mapping_values.get_mapping(changes, "groups"):
        yield from _list_declared(group, group.key)


def _list_declared(holder: MappingEntry, holder_id: str) -> Iterator[str]:
    for part in mapping_values.get_mapping(mapping_values.get_body(holder), "components"):
        body = mapping_values.get_body(part)
        part_id = f"{holder_id}.{part.key}"
        own_keys = MappingNode({e.key: e for e in body if e.key != "components"}, body.span, body.declares)
        if _is_stub(part) or (own_keys.entries and declares_itself(own_keys)):
            yield part_id
        yield from _list_declared(part, part_id)
