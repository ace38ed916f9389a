"""Lay what an instance writes over what its type has, on normal forms: leaf by leaf, lists whole.

Neither tree is changed: what only one of them has is shared, so that a thousand instances of one type cost little.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from archgen.compose.library_types import LibraryWord
from archgen.diagnostics import Diagnostic, Label, did_you_mean
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode

_EXCLUSIVE_KEYS: tuple[tuple[frozenset[str], frozenset[str]], ...] = (
    (frozenset({"period"}), frozenset({"rate"})),
    (frozenset({"from"}), frozenset({"external"})),
    (frozenset({"executable"}), frozenset({"plugin"})),
    (frozenset({"command"}), frozenset({"package", "executable", "plugin"})),
    (frozenset({"value"}), frozenset({"from"})),
)
"""Keys that say the same in two ways: writing one of a side takes those of the other side away."""
_PART_KINDS = {"inputs": "input", "outputs": "output", "components": "component"}
_KEYS_OF_IDS = frozenset(
    {
        *("parameters", "operations", "performance", "urls", "containers", "frames", "properties", "calls", "uses"),
        "environment",
    }
    | {"publishes", "subscribes", "serves", "inputs", "outputs"}
)
"""Keys whose mappings have ids or names as keys: one called `rate` does not replace another called `period`."""
_USE_NAMES = {"publishes": "topic", "subscribes": "topic", "serves": "name", "calls": "name"}
"""The key of the name on the wire, by the section of a node that has it."""
_JOINED_LISTS = frozenset({"requirements", "tags"})
"""Lists that an instance adds to: it has its type's requirements and tags, and its own."""


MayReplace = Callable[[ScalarNode, ScalarNode, str], bool]
"""Says whether the second type may stand in the place of the first, in a component inside; it reports why not."""


class InstanceOverlay:
    """Lays instances over types; what instances name and types do not have goes to `diagnostics`."""

    def __init__(self, diagnostics: list[Diagnostic], may_replace: MayReplace) -> None:
        """Take the list that findings go to, and what says whether one type may stand in the place of another."""
        self.diagnostics = diagnostics
        self._may_replace = may_replace

    def lay_over_type(self, base: MappingNode, derived: MappingNode, type_name: str) -> MappingNode:
        """Return a type with another made from it laid over: it may add ports, components and parameters."""
        return self._lay_component(base, derived, type_name, is_open=True)

    def lay_components(self, base: MappingNode | None, over: MappingNode, holder_id: str) -> MappingNode:
        """Return components with others laid over them by their ids; new ones are added."""
        return self._lay_parts(base, over, "component", holder_id, is_open=True)

    def lay_over_instance(self, base: MappingNode, instance: MappingNode, instance_id: str) -> MappingNode:
        """Return a type's body with an instance laid over, which adds neither ports nor components."""
        return self._lay_component(base, instance, instance_id, is_open=False)

    def _lay_component(self, base: MappingNode, over: MappingNode, holder_id: str, *, is_open: bool) -> MappingNode:
        entries = dict(base.entries)
        for entry in over:
            below = entries.get(entry.key)
            part_kind = _PART_KINDS.get(entry.key)
            if part_kind and isinstance(entry.value, MappingNode):
                base_parts = below.value if below and isinstance(below.value, MappingNode) else None
                parts = self._lay_parts(base_parts, entry.value, part_kind, holder_id, is_open=is_open)
                if below is not None or parts.entries or is_open:
                    entries[entry.key] = MappingEntry(entry.key, (below or entry).key_span, parts)
            elif entry.key in _JOINED_LISTS and below and isinstance(below.value, SequenceNode):
                own = entry.value.items if isinstance(entry.value, SequenceNode) else [entry.value]
                items = [*below.value.items, *own]
                entries[entry.key] = entry.with_value(SequenceNode(items, entry.value.span))
            else:
                _lay_entry(entries, entry)
        _drop_library_status(base, over, entries)
        return MappingNode(entries, base.span if is_open else over.span)

    def _lay_parts(
        self, base: MappingNode | None, over: MappingNode, part_kind: str, holder_id: str, *, is_open: bool
    ) -> MappingNode:
        """Return ports or components by id; what only an instance writes is reported, and left out."""
        entries = dict(base.entries) if base else {}
        for entry in over:
            below = entries.get(entry.key)
            if below is None:
                if is_open:
                    entries[entry.key] = entry
                else:
                    self.diagnostics.append(_diagnose_unknown_part(entry, part_kind, holder_id, base))
                continue
            body = below.value if isinstance(below.value, MappingNode) else MappingNode({}, below.key_span)
            own = entry.value if isinstance(entry.value, MappingNode) else MappingNode({}, entry.key_span)
            if part_kind == "component":
                inner_id = f"{holder_id}.{entry.key}"
                own = self._keep_wider_type(body, own, inner_id)
                # What an inner instance has is not known before its own type is laid under it: it is judged then.
                is_instance = not {"is", "same_as"}.isdisjoint({*body.entries, *own.entries})
                value = self._lay_component(body, own, inner_id, is_open=is_open or is_instance)
            else:
                value = lay_mapping(body, own)
            entries[entry.key] = MappingEntry(entry.key, below.key_span, value)
        return MappingNode(entries, base.span if base else over.span)

    def _keep_wider_type(self, body: MappingNode, own: MappingNode, inner_id: str) -> MappingNode:
        """Return what is laid over an inner component, without a type that may not stand in the place of its own."""
        replaced, replacing = body.get("is"), own.get("is")
        if (
            isinstance(replaced, ScalarNode)
            and isinstance(replacing, ScalarNode)
            and replaced.text != replacing.text
            and not self._may_replace(replaced, replacing, inner_id)
        ):
            return own.without("is")
        return own


def _diagnose_unknown_part(
    entry: MappingEntry, part_kind: str, instance_id: str, base: MappingNode | None
) -> Diagnostic:
    known_ids = tuple(base.entries) if base else ()
    rule = "unknown-component" if part_kind == "component" else "unknown-port"
    labels = (Label(base.span, f"its {part_kind}s"),) if base and base.entries else ()
    return Diagnostic(
        rule,
        f"the type of `{instance_id}` has no {part_kind} `{entry.key}`",
        entry.key_span,
        labels=labels,
        help=did_you_mean(entry.key, known_ids) or f"an instance adds no {part_kind}s: add it to the type",
        element=instance_id,
    )


def _drop_library_status(base: MappingNode, over: MappingNode, entries: dict[str, MappingEntry]) -> None:
    """Take away what a library says of its program's status where another package is named: that program is a project's own."""
    base_node, own_node, laid = base.get("node"), over.get("node"), entries.get("node")
    if not (isinstance(base_node, MappingNode) and isinstance(own_node, MappingNode) and laid):
        return
    package, own_package = base_node.get("package"), own_node.get("package")
    if isinstance(package, ScalarNode) and isinstance(own_package, ScalarNode) and package.text != own_package.text:
        for mapping in (entries, laid.value.entries if isinstance(laid.value, MappingNode) else {}):
            status = mapping["status"].value if "status" in mapping else None
            if isinstance(status, ScalarNode) and isinstance(status.text, LibraryWord):
                del mapping["status"]


def lay_mapping(base: MappingNode, over: MappingNode, holder_key: str = "") -> MappingNode:
    """Return a mapping with another laid over it, key by key, to any depth. `holder_key` is the key that holds it."""
    entries = dict(base.entries)
    for entry in over:
        _lay_entry(entries, entry, has_ids=holder_key in _KEYS_OF_IDS)
    return MappingNode(entries, base.span)


def _lay_entry(entries: dict[str, MappingEntry], entry: MappingEntry, *, has_ids: bool = False) -> None:
    """Put an entry over those of a base, and take away what it replaces. `has_ids`: its key is somebody's id."""
    for key in () if has_ids else _list_replaced_keys(entry.key):
        entries.pop(key, None)
    below = entries.get(entry.key)
    if below is None or not isinstance(below.value, MappingNode) or not isinstance(entry.value, MappingNode):
        entries[entry.key] = entry
    elif entry.key == "hints" and not has_ids:
        entries["hints"] = MappingEntry("hints", entry.key_span, lay_data(below.value, entry.value))
    elif entry.key == "node":
        entries["node"] = MappingEntry("node", entry.key_span, lay_node(below.value, entry.value))
    elif entry.key == "qos" and "profile" in entry.value.entries:
        entries[entry.key] = entry  # a profile is a value for every key of the quality of service
    else:
        value = lay_mapping(below.value, entry.value, entry.key)
        if entry.key == "timing":
            _drop_period(value, entry.value)
        entries[entry.key] = entry.with_value(value)


def lay_data(base: MappingNode, over: MappingNode) -> MappingNode:
    """Lay data over other data, key by key, to any depth: no key of it means anything to archgen."""
    entries = dict(base.entries)
    for entry in over:
        below = entries.get(entry.key)
        value = entry.value
        if below is not None and isinstance(below.value, MappingNode) and isinstance(value, MappingNode):
            value = lay_data(below.value, value)
        entries[entry.key] = entry.with_value(value)
    return MappingNode(entries, base.span)


def lay_node(base: MappingNode, over: MappingNode) -> MappingNode:
    """Lay a node over another. Its parameters are data: each whole one replaces the other."""
    node = lay_mapping(base, over)
    base_parameters, parameters = base.get("parameters"), over.entries.get("parameters")
    if parameters and isinstance(base_parameters, MappingNode) and isinstance(parameters.value, MappingNode):
        entries = {**base_parameters.entries, **parameters.value.entries}
        node.entries["parameters"] = MappingEntry(
            "parameters", parameters.key_span, MappingNode(entries, parameters.value.span)
        )
    if not {"executable", "plugin"}.isdisjoint(base.entries):
        for section, key in _USE_NAMES.items():
            _keep_program_names(base.get(section), node.get(section), key)
    return node


def _keep_program_names(base_uses: YamlNode | None, uses: YamlNode | None, key: str) -> None:
    """Keep what a type calls a port as its program's name, where what is laid over it puts the port somewhere else."""
    if not (isinstance(uses, MappingNode) and isinstance(base_uses, MappingNode)):
        return
    for entry in uses:
        base = base_uses.get(entry.key)
        if isinstance(base, MappingNode) and isinstance(entry.value, MappingNode):
            said, meant = _get_single(base, key), _get_single(entry.value, key)
            if said is not None and meant is not None and said.text != meant.text:
                entry.value.entries.setdefault("own_name", MappingEntry("own_name", entry.key_span, said))


def _get_single(mapping: MappingNode, key: str) -> ScalarNode | None:
    node = mapping.get(key)
    if isinstance(node, SequenceNode) and len(node.items) == 1:
        node = node.items[0]
    return node if isinstance(node, ScalarNode) else None


def _list_replaced_keys(key: str) -> Iterator[str]:
    for first, second in _EXCLUSIVE_KEYS:
        if key in first:
            yield from second
        elif key in second:
            yield from first


def _drop_period(timing: MappingNode, written_timing: MappingNode) -> None:
    behaviour = written_timing.get("behaviour")
    if isinstance(behaviour, ScalarNode) and behaviour.text != "periodic":
        for key in ("period", "rate", "jitter"):
            if key not in written_timing.entries:
                timing.entries.pop(key, None)
