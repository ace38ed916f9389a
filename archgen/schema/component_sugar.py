"""Write out the short forms of composed components (lists of types, dotted ids, and `to` at an output) and of parameters:
sets become dotted names, values mappings; what contradicts itself is reported.

They stand for what is written in one file, so they are gone before slices are merged. Normalising twice changes nothing.
"""

from __future__ import annotations

import re
from collections import deque
from typing import TYPE_CHECKING

from archgen.diagnostics import Diagnostic, diagnose_repetition, did_you_mean
from archgen.frozen import NamedTuple
from archgen.model.parameter import MAX_NAME_LENGTH
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, list_entries

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from archgen.diagnostics import Span
    from archgen.syntax.yaml_tree import YamlDocument, YamlNode

_LAST_WORD = re.compile(r"[^/]*\Z")
_WORD_BREAK = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])|[^A-Za-z0-9]+")
_PORT_SIDES = ("inputs", "outputs")


def list_component_bodies(root: MappingNode) -> Iterator[tuple[str, MappingNode]]:
    """Yield the bodies of all components and component types of a document by complete id, outer ones first."""
    for holder in _list_holders(root):
        if not holder.is_group:
            yield holder.id, holder.body


def expand_sugar(document: YamlDocument) -> tuple[Diagnostic, ...]:
    """Replace the short forms of composed components in a validated document, in place."""
    return (*name_listed_elements(document.root), *move_targets(document.root))


def name_listed_elements(root: MappingNode) -> tuple[Diagnostic, ...]:
    """Replace lists of components and ports, and dotted ids, by what they stand for, in place."""
    diagnostics: list[Diagnostic] = []
    for holder in _list_holders(root):
        _expand_components(holder.body, diagnostics)
    return tuple(diagnostics)


def move_targets(root: MappingNode) -> tuple[Diagnostic, ...]:
    """Replace `to` at outputs by `from` at the inputs that it names, in place."""
    diagnostics: list[Diagnostic] = []
    for holder in _list_holders(root):
        _move_targets(holder.body, diagnostics)
    return tuple(diagnostics)


def name_port_after(type_name: str) -> str:
    """Return the id of a port that is listed by its type: `laser_pose` for `Laser pose`, `scan/LaserPose`, `LaserPose`."""
    last = _LAST_WORD.search(type_name.split("<", 1)[0].strip())
    return "_".join(word.lower() for word in _WORD_BREAK.split(last[0] if last else "") if word)


class _Holder(NamedTuple):
    """What may hold components: a group, a component type, or a component, by complete id."""

    id: str
    body: MappingNode
    is_group: bool = False


def _list_holders(root: MappingNode) -> Iterator[_Holder]:
    """Yield all that may hold components, outer ones first. What is replaced on the way is followed."""
    waiting = deque((entry.key, entry.value, False) for entry in list_entries(root, "component_types"))
    waiting.extend((entry.key, entry.value, True) for entry in list_entries(root, "groups"))
    while waiting:
        holder_id, body, is_group = waiting.popleft()
        if isinstance(body, MappingNode):
            yield _Holder(holder_id, body, is_group)
            # Listed only now: who got this holder has replaced its lists meanwhile.
            parts = list_entries(body, "components")
            waiting.extend((f"{holder_id}.{entry.key}", entry.value, False) for entry in parts)


def _expand_components(holder: MappingNode, diagnostics: list[Diagnostic]) -> None:
    for side in _PORT_SIDES:
        ports = holder.entries.get(side)
        if ports is not None and isinstance(ports.value, SequenceNode):
            ports.value = _name_items(ports.value, "type", name_port_after, diagnostics)
    components = holder.entries.get("components")
    if components is None:
        return
    if isinstance(components.value, SequenceNode):
        components.value = _make_instances(components.value, diagnostics)
    elif isinstance(components.value, MappingNode) and any("." in key for key in components.value.entries):
        components.value = _nest_dotted_ids(components.value, diagnostics)


def _name_items(
    listed: SequenceNode, key: str, name_item: Callable[[str], str], diagnostics: list[Diagnostic]
) -> MappingNode:
    """Return elements of the listed types: `[Laser pose]` is `{laser_pose: {type: Laser pose}}`, `[lidar]` is `{lidar: {is: lidar}}`."""
    elements = MappingNode({}, listed.span)
    for item in listed.items:
        if isinstance(item, ScalarNode):
            body = MappingNode({key: MappingEntry(key, item.span, item)}, item.span)
            _add_entry(elements, MappingEntry(name_item(item.text), item.span, body), diagnostics)
    return elements


def _make_instances(listed: SequenceNode, diagnostics: list[Diagnostic]) -> MappingNode:
    return _name_items(listed, "is", lambda text: text.split("<", 1)[0].rpartition(".")[2], diagnostics)


def _add_entry(mapping: MappingNode, entry: MappingEntry, diagnostics: list[Diagnostic]) -> None:
    first_entry = mapping.entries.setdefault(entry.key, entry)
    if first_entry is not entry:
        diagnostics.append(
            diagnose_repetition(
                "duplicate-key",
                f"two entries of the list are called `{entry.key}`",
                entry.key_span,
                first_entry.key_span,
                help_line="write a mapping, with an id for each",
            )
        )


def _nest_dotted_ids(components: MappingNode, diagnostics: list[Diagnostic]) -> MappingNode:
    """Return components with `arm.motor: ...` written as `arm: {components: {motor: ...}}`, which declares neither."""
    nested = MappingNode({e.key: e for e in components if "." not in e.key}, components.span)
    for entry in components:
        if "." in entry.key:
            *outer_ids, last = entry.key.split(".")
            target: MappingNode | None = nested
            for outer_id in outer_ids:
                target = _find_inner(target, outer_id, entry) if target is not None else None
            if target is not None:
                body = entry.value if isinstance(entry.value, MappingNode) else MappingNode({}, entry.key_span)
                body.declares = False
                _add_entry(target, MappingEntry(last, entry.key_span, body), diagnostics)
    return nested


def _find_inner(components: MappingNode, outer_id: str, entry: MappingEntry) -> MappingNode | None:
    """Return the components inside one of these, made if need be."""
    outer = components.entries.get(outer_id)
    if outer is None or not isinstance(outer.value, MappingNode):
        body = MappingNode({}, entry.key_span, declares=False)
        if outer is not None and isinstance(outer.value, ScalarNode):
            body.declares = True
            if outer.value.value is not None:
                body.entries["title"] = MappingEntry("title", outer.value.span, outer.value)
        outer = MappingEntry(outer_id, outer.key_span if outer else entry.key_span, body)
        components.entries[outer_id] = outer
    body_node = outer.value
    if not isinstance(body_node, MappingNode):
        return None
    inner = body_node.entries.setdefault(
        "components", MappingEntry("components", entry.key_span, MappingNode({}, entry.key_span))
    )
    if isinstance(inner.value, ScalarNode):
        inner.value = MappingNode({}, entry.key_span)
    elif isinstance(inner.value, SequenceNode):
        inner.value = _make_instances(inner.value, [])
    return inner.value if isinstance(inner.value, MappingNode) else None


def _move_targets(holder: MappingNode, diagnostics: list[Diagnostic]) -> None:
    """Write the `to` of each output as `from` of the inputs that it names, which stand beside it."""
    components = holder.get("components")
    for component in list_entries(components):
        for output in list_entries(component.value, "outputs"):
            # Taken out of the output: from here on there is one way to write a connection.
            target_entry = output.value.entries.pop("to", None) if isinstance(output.value, MappingNode) else None
            if target_entry is not None and isinstance(components, MappingNode):
                node = target_entry.value
                for target in node.items if isinstance(node, SequenceNode) else (node,):
                    if isinstance(target, ScalarNode) and target.value is not None:
                        path = f"{component.key}.{output.key}"
                        source = ScalarNode(path, path, target.span)
                        _connect_target(components, target, source, diagnostics)


def _connect_target(
    components: MappingNode, target: ScalarNode, source: ScalarNode, diagnostics: list[Diagnostic]
) -> None:
    component_id, dot, input_id = target.text.partition(".")
    component = components.entries.get(component_id)
    if component is None or not dot or "." in input_id:
        help_line = did_you_mean(component_id, components.entries) if component is None else None
        diagnostics.append(
            Diagnostic(
                "unknown-reference",
                f"`to` names an input of a component beside this one, not `{target.text}`",
                target.span,
                help=help_line or "write `component.input`, or write `from` at the input",
            )
        )
        return
    body = _as_mapping(component, "title")
    inputs_entry = body.entries.setdefault(
        "inputs", MappingEntry("inputs", target.span, MappingNode({}, target.span, declares=False))
    )
    inputs = _as_mapping(inputs_entry, None)
    input_entry = inputs.entries.setdefault(
        input_id, MappingEntry(input_id, target.span, MappingNode({}, target.span, declares=False))
    )
    input_body = _as_mapping(input_entry, "from")
    from_entry = input_body.entries.setdefault("from", MappingEntry("from", target.span, SequenceNode([], target.span)))
    if isinstance(from_entry.value, ScalarNode):
        items: list[YamlNode] = [from_entry.value] if from_entry.value.value is not None else []
        from_entry.value = SequenceNode(items, from_entry.value.span)
    if isinstance(from_entry.value, SequenceNode):
        from_entry.value.items.append(source)


def _as_mapping(entry: MappingEntry, short_key: str | None) -> MappingNode:
    """Return an entry's value as a mapping, with what its short form says at a key."""
    node = entry.value
    if isinstance(node, MappingNode):
        return node
    is_empty = isinstance(node, ScalarNode) and node.value is None
    entries = {} if is_empty or short_key is None else {short_key: MappingEntry(short_key, node.span, node)}
    body = MappingNode(entries, node.span)
    entry.value = body
    return body


DECLARATION_KEYS = (
    *("type", "value", "unit", "range", "choices", "description", "read_only", "visibility", "from", "hints"),
)
"""The keys of a declaration. A mapping with any other key is a set of parameters."""
_TELLING_KEYS = frozenset({"value", "type", "choices", "from"})
"""One of them makes a mapping with keys of a declaration only a declaration."""
_TEXT_KEYS = frozenset({"type", "unit", "description", "visibility", "from"})
_TYPE_WORDS = frozenset({"boolean", "integer", "float", "string", "bool", "int", "double", "number", "text", "str"})
"""Types as archgen and other tools call them: who writes one of them means a declaration."""
_WORDS_OF_OTHERS = {
    **dict.fromkeys(("default", "default_value"), "write the value as `value`"),
    **dict.fromkeys(
        ("min", "max", "minimum", "maximum", "lower", "upper", "bounds", "limits", "validation"),
        "write what it may be as `range: [LOWEST, HIGHEST]` or `choices: [...]`",
    ),
}
"""What generate_parameter_library and dynamic_reconfigure call the same."""
_LIMIT_COUNT = 2


def expand_parameters(root: MappingNode) -> Iterator[Diagnostic]:
    """Bring the parameters of all components into the normal form, in place: declarations by dotted name."""
    for component_id, body in list_component_bodies(root):
        entry = body.entries.get("parameters")
        if entry is not None and isinstance(entry.value, MappingNode):
            expander = _SetExpander(component_id)
            expander.expand_set(entry.value, "")
            entry.value = MappingNode(expander.declarations, entry.value.span)
            yield from expander.diagnostics


class _SetExpander:
    """Takes the sets of one component apart."""

    def __init__(self, component_id: str) -> None:
        self.component_id = component_id
        self.declarations: dict[str, MappingEntry] = {}
        self.diagnostics: list[Diagnostic] = []

    def expand_set(self, mapping: MappingNode, prefix: str) -> None:
        for entry in mapping:
            name = f"{prefix}{entry.key}"
            if len(name) > MAX_NAME_LENGTH:
                self._report(
                    f"the name of a parameter has more than {MAX_NAME_LENGTH} characters",
                    entry.key_span,
                    "use shorter names, or fewer sets in one another",
                )
            elif isinstance(entry.value, MappingNode) and entry.value.entries and not _is_declaration(entry.value):
                self._find_misspelt_key(entry.value, name)
                self.expand_set(entry.value, f"{name}.")
            else:
                self._add_declaration(MappingEntry(name, entry.key_span, self._make_declaration(entry)))

    def _add_declaration(self, entry: MappingEntry) -> None:
        first_entry = self.declarations.setdefault(entry.key, entry)
        if first_entry is not entry:
            self.diagnostics.append(
                diagnose_repetition(
                    "conflicting-values",
                    f"the parameter `{entry.key}` is written twice",
                    entry.key_span,
                    first_entry.key_span,
                    help_line="a set and a name with a dot mean the same: keep one of them",
                    element=self.component_id,
                )
            )

    def _make_declaration(self, entry: MappingEntry) -> MappingNode:
        node = entry.value
        if isinstance(node, ScalarNode) and node.value is None:
            return MappingNode({}, node.span)
        if not isinstance(node, MappingNode):
            return MappingNode({"value": MappingEntry("value", node.span, node)}, node.span)
        written_entries = [
            each for each in node if not (isinstance(each.value, ScalarNode) and each.value.value is None)
        ]
        for each in written_entries:
            if each.key in _TEXT_KEYS and isinstance(each.value, ScalarNode):
                # As text `1.10` stays `1.10` in a packed file, where all below `parameters` keeps the kind it has.
                each.value = ScalarNode(each.value.text, each.value.text, each.value.span, each.value.is_plain)
        if written_entries and _TELLING_KEYS.isdisjoint(each.key for each in written_entries):
            # `{value: , unit: m}`: without the empty key, it would be a set the next time.
            written_entries += [each for each in node if each.key in _TELLING_KEYS][:1]
        declaration = MappingNode({each.key: each for each in written_entries}, node.span)
        self._check_range(declaration)
        return declaration

    def _check_range(self, declaration: MappingNode) -> None:
        node = declaration.get("range")
        if not isinstance(node, SequenceNode):
            return
        limits = [item.value for item in node.items if isinstance(item, ScalarNode)]
        numbers = [limit for limit in limits if isinstance(limit, int | float) and not isinstance(limit, bool)]
        if len(numbers) == len(limits) == _LIMIT_COUNT and numbers[0] <= numbers[1]:
            return
        self._report("a range is the least and the greatest number", node.span, "write both: `range: [0, 1.5]`")
        del declaration.entries["range"]

    def _find_misspelt_key(self, parameter_set: MappingNode, name: str) -> None:
        """Report a key that makes a set of what is meant as a declaration: `{type: float, valeu: 0.5}`."""
        type_node = parameter_set.get("type")
        has_type = isinstance(type_node, ScalarNode) and type_node.text.removesuffix("[]") in _TYPE_WORDS
        # `{value: 2, limits: [0, 3]}`: all that is no key of a declaration is a word of others for one.
        others = parameter_set.entries.keys() - {*DECLARATION_KEYS}
        if not has_type and not ("value" in parameter_set.entries and others <= _WORDS_OF_OTHERS.keys()):
            return
        for entry in parameter_set:
            if entry.key in DECLARATION_KEYS:
                continue
            guess = _WORDS_OF_OTHERS.get(entry.key) or did_you_mean(entry.key, DECLARATION_KEYS)
            if guess:
                self.diagnostics.append(
                    Diagnostic(
                        "unknown-key",
                        f"the declaration of the parameter `{name}` has no key `{entry.key}`",
                        entry.key_span,
                        help=guess,
                        element=self.component_id,
                    )
                )

    def _report(self, message: str, span: Span, help_line: str) -> None:
        self.diagnostics.append(Diagnostic("wrong-value", message, span, help=help_line, element=self.component_id))


def _is_declaration(mapping: MappingNode) -> bool:
    """Whether a mapping declares one parameter; else it is a set of several."""
    return not _TELLING_KEYS.isdisjoint(mapping.entries) and all(key in DECLARATION_KEYS for key in mapping.entries)
