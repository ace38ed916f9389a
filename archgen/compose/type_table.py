"""The component types of a project by name, with what each is made from laid under it and its generic names bound."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from archgen.compose.expanded_project import MAX_TYPE_LENGTH, TypeExpression, bind_type_name, parse_type_expression
from archgen.compose.instance_overlay import InstanceOverlay
from archgen.compose.library_types import library_of_type
from archgen.diagnostics import Diagnostic, Label, Span, did_you_mean, join_words
from archgen.frozen import dataclass, field
from archgen.syntax.yaml_tree import (
    MappingEntry,
    MappingNode,
    ScalarNode,
    SequenceNode,
    YamlNode,
    find_value,
    list_entries,
)

MAX_BASES = 60
"""So many types a type may be made from, one of the other."""
_TYPE_KEYS = ("generic", "abstract", "title", "owner", "version", "deprecated")
"""Keys of a type that its instances do not have: they are about the type itself."""
_NAMING_KEYS = frozenset({"type", "is", "same_as"})
"""Keys whose values name types."""
_DATA_KEYS = frozenset({"parameters", "node", "hints", "properties"})
"""Keys below which nothing names a type."""
_KEYS_OF_IDS = frozenset({"inputs", "outputs", "components", "operations"})
OPERATION_PARTS = frozenset({"request", "response"})
"""Keys of an operation that hold the name of a type, or those of fields by name."""

MissingTypeDescriber = Callable[[str], str | None]
"""Returns what is to be known of a type that a library lacks, by its name; None for nothing."""


@dataclass(slots=True)
class TypeTable:
    """Finds component types by name. What is wrong with a type, or with the name of one, goes to `diagnostics` once.

    Of `incomplete_libraries` something could not be read: what they seem to lack is not reported.
    """

    entries: Mapping[str, MappingEntry]
    diagnostics: list[Diagnostic]
    incomplete_libraries: frozenset[str] = frozenset()
    describe_missing_type: MissingTypeDescriber | None = None
    library_names: dict[str, None] = field(default_factory=dict)
    """The types of libraries that were asked for, in that order."""
    _bodies: dict[TypeExpression, MappingNode | None] = field(default_factory=dict)
    _open_names: list[str] = field(default_factory=list)

    def find_type(self, reference: ScalarNode, element_id: str, *, is_base: bool = False) -> TypeExpression | None:
        """Return what the name of a type means; None, and a diagnostic, if there is none of it."""
        # A generic type that holds `chain<pair<T>>` of itself gets a longer name each time: the length is what ends it.
        if len(reference.text) > MAX_TYPE_LENGTH:
            message = (
                f"the name of this type has {len(reference.text):,} letters; a type that holds itself grows for ever"
            )
            self.diagnostics.append(Diagnostic("too-large", message, reference.span, element=element_id))
            return None
        expression = parse_type_expression(reference.text)
        entry = self.entries.get(expression.name) if expression else None
        # The part of the library that could not be read may have held it.
        if entry is None and library_of_type(reference.text) in self.incomplete_libraries:
            return None
        if expression is None or entry is None:
            self.diagnostics.append(self._diagnose_unknown_type(reference, expression, element_id))
            return None
        generic_names = list_generic_names(entry)
        if len(generic_names) != len(expression.arguments):
            self.diagnostics.append(_diagnose_arguments(reference, entry, generic_names, element_id))
            return None
        # To be made from is what abstract types are for; only instances of them are wrong.
        if not is_base and is_abstract(entry):
            self.diagnostics.append(_diagnose_abstract(reference, entry, self._list_derived(entry.key), element_id))
            return None
        if library_of_type(expression.name):
            self.library_names[expression.name] = None
        return expression

    def ask_replacement(self, name: str) -> None:
        """Report what replaces a deprecated type where there is no such type; one of a library counts as used."""
        body = self.entries[name].value
        reference = find_value(body, "deprecated", "use")
        if not isinstance(reference, ScalarNode) or reference.value is None:
            return
        library = library_of_type(reference.text)
        if reference.text in self.entries:
            self.library_names |= {reference.text: None} if library else {}
        elif library not in self.incomplete_libraries:
            self.diagnostics.append(self._diagnose_unknown_type(reference, TypeExpression(reference.text, ()), name))

    def get_body(self, expression: TypeExpression) -> MappingNode | None:
        """Return the body of a type, with what it is made from; None where that goes in a circle."""
        # None is kept as well: a circle is reported once, however many instances lead into it.
        if expression not in self._bodies:
            self._bodies[expression] = self._make_body(expression)
        return self._bodies[expression]

    def may_replace(self, replaced: ScalarNode, replacing: ScalarNode, component_id: str) -> bool:
        """Whether a type may stand in the place of another: it has all of its ports. Reports why not."""
        old, new = parse_type_expression(replaced.text), self.find_type(replacing, component_id)
        if old is None or old.name not in self.entries or new is None:
            return old is None or old.name not in self.entries
        own_ports = self._list_ports(new)
        missing_ports = [name for side, name in self._list_ports(old) if (side, name) not in own_ports]
        if missing_ports:
            names = join_words([f"`{port}`" for port in missing_ports])
            self.diagnostics.append(
                Diagnostic(
                    "narrower-type",
                    f"`{replacing.text}` stands for `{replaced.text}` in `{component_id}`, but has no {names}",
                    replacing.span,
                    labels=(Label(self.entries[old.name].key_span, "the type that it replaces"),),
                    help=f"name a type that is made from `{old.name}`, or has its ports",
                    element=component_id,
                )
            )
        return not missing_ports

    def _list_ports(self, expression: TypeExpression) -> list[tuple[str, str]]:
        """Return the ports of a type and of what it is made from, each with its side: its body may be in the making just now."""
        bodies: dict[str, YamlNode | None] = {}
        base: TypeExpression | None = expression
        while base and base.name in self.entries and base.name not in bodies:
            bodies[base.name] = self.entries[base.name].value
            base = _read_base(bodies[base.name])
        sides = [(side, body) for side in ("inputs", "outputs") for body in reversed(bodies.values())]
        return list(dict.fromkeys((side, port.key) for side, body in sides for port in list_entries(body, side)))

    def _make_body(self, expression: TypeExpression) -> MappingNode | None:
        entry = self.entries[expression.name]
        # By name, not by expression: `chain<T>` made from `chain<pair<T>>` would never come to the same expression again.
        if expression.name in self._open_names:
            start = self._open_names.index(expression.name)
            self.diagnostics.append(diagnose_circle(entry, self._open_names[start:], "is made from"))
            return None
        body = entry.value if isinstance(entry.value, MappingNode) else MappingNode({}, entry.key_span)
        bindings = dict(zip(list_generic_names(entry), expression.arguments, strict=True))
        own_body = bind_type_body(body.without(*_TYPE_KEYS), bindings) if bindings else body.without(*_TYPE_KEYS)
        base_reference = own_body.get("is")
        # The base is laid under the body: from here on nothing is left to be made from.
        own_body.entries.pop("is", None)
        if not isinstance(base_reference, ScalarNode):
            return own_body
        if len(self._open_names) > MAX_BASES:
            message = f"this type is made from a type that is made from a type, more than {MAX_BASES} times"
            self.diagnostics.append(
                Diagnostic("too-large", message, base_reference.span, help="name a type further up", element=entry.key)
            )
            return own_body
        self._open_names.append(expression.name)
        base = self.find_type(base_reference, expression.name, is_base=True)
        base_body = self.get_body(base) if base else None
        self._open_names.pop()
        if base_body is None:
            return own_body
        overlay = InstanceOverlay(self.diagnostics, self.may_replace)
        return overlay.lay_over_type(base_body, own_body, expression.name)

    def _list_derived(self, name: str) -> Iterator[str]:
        for entry in self.entries.values():
            base = _read_base(entry.value)
            if base and base.name == name and not is_abstract(entry):
                yield entry.key

    def _diagnose_unknown_type(
        self, reference: ScalarNode, expression: TypeExpression | None, element_id: str
    ) -> Diagnostic:
        if expression is None:
            message = f"the brackets of `{reference.text}` do not match, or something is missing between them"
            help_line: str | None = "a generic type is bound as `filter<Pose>`, two as `pair<Pose, Twist>`"
            return Diagnostic("wrong-value", message, reference.span, help=help_line, element=element_id)
        names = tuple(self.entries)
        library = library_of_type(expression.name)
        own_names = [name for name in names if library_of_type(name) == library]
        if library and any(_is_inside(reference.span, self.entries[name].value.span) for name in own_names):
            return _diagnose_in_library(reference, library, own_names, element_id)
        ending = next((name for name in names if name.rpartition(".")[2] == expression.name), None)
        guess = self.describe_missing_type(expression.name) if self.describe_missing_type else None
        guess = guess or (f"did you mean `{ending}`?" if ending else did_you_mean(expression.name, names))
        return Diagnostic(
            "unknown-reference",
            f"no component type named `{expression.name}`",
            reference.span,
            help=guess or _suggest_place(library, own_names),
            element=element_id,
        )


def _suggest_place(library: str | None, own_names: list[str]) -> str:
    if library and own_names:
        return f"`archgen list --of component_types --library {library}` lists those that it has"
    return "write it below `component_types`, or describe the component itself"


def _is_inside(inner: Span, outer: Span) -> bool:
    starts_inside = (outer.line, outer.column) <= (inner.line, inner.column)
    return inner.file == outer.file and starts_inside and inner[3:] <= outer[3:]


def _diagnose_in_library(reference: ScalarNode, library: str, library_names: list[str], element_id: str) -> Diagnostic:
    """Return the finding for a name that is written in a library: what the project knows is no help there."""
    name = reference.text.removeprefix(f"{library}.")
    return Diagnostic(
        "unknown-reference",
        f"no component type named `{name}` in the library `{library}`",
        reference.span,
        help=did_you_mean(name, [each.removeprefix(f"{library}.") for each in library_names])
        or "the component types of a library see only one another: write it below `component_types` there",
        element=element_id,
    )


def _read_base(body: YamlNode | None) -> TypeExpression | None:
    reference = find_value(body, "is")
    return parse_type_expression(reference.text) if isinstance(reference, ScalarNode) else None


def list_generic_names(entry: MappingEntry) -> tuple[str, ...]:
    """Return the names of a type that stand for conceptual types; none where it is not generic."""
    names = find_value(entry.value, "generic")
    items = names.items if isinstance(names, SequenceNode) else []
    return tuple(dict.fromkeys(item.text for item in items if isinstance(item, ScalarNode)))


def is_abstract(entry: MappingEntry) -> bool:
    """Whether there is no instance of a type."""
    flag = find_value(entry.value, "abstract")
    return isinstance(flag, ScalarNode) and flag.value is True


def diagnose_circle(entry: MappingEntry, names: list[str], verb: str) -> Diagnostic:
    """Report types that are made from, or hold, themselves."""
    way = " > ".join(f"`{name}`" for name in (*names, names[0]))
    return Diagnostic(
        "circular-types",
        f"the component type `{entry.key}` {verb} itself: {way}"
        if len(names) > 1
        else f"the component type `{entry.key}` {verb} itself",
        entry.key_span,
        help="take one of them out of the circle",
        element=entry.key,
    )


def _diagnose_arguments(
    reference: ScalarNode, entry: MappingEntry, generic_names: tuple[str, ...], element_id: str
) -> Diagnostic:
    form = f"{entry.key}<{', '.join(generic_names)}>"
    if generic_names:
        asked = "type" if len(generic_names) == 1 else f"{len(generic_names)} types"
        message = f"`{reference.text}` does not say for which {asked} `{form}` stands"
        help_line = f"write `{form}` with types of the project"
    else:
        message = f"the component type `{entry.key}` is not generic"
        help_line = f"write `{entry.key}`, or give the type `generic: [T]`"
    labels = (Label(entry.key_span, "the type"),)
    return Diagnostic("unbound-generic", message, reference.span, labels=labels, help=help_line, element=element_id)


def _diagnose_abstract(
    reference: ScalarNode, entry: MappingEntry, derived: Iterator[str], element_id: str
) -> Diagnostic:
    names = list(derived)[:3]
    help_line = (
        f"name a type that is made from it: {', '.join(f'`{name}`' for name in names)}"
        if names
        else "write a type that is made from it: `is` and what it adds"
    )
    return Diagnostic(
        "abstract-type",
        f"there is no instance of the abstract component type `{entry.key}`",
        reference.span,
        labels=(Label(entry.key_span, "abstract"),),
        help=help_line,
        element=element_id,
    )


def bind_type_body(node: MappingNode, bindings: Mapping[str, str], *, has_ids: bool = False) -> MappingNode:
    """Return a copy of a type's body in which generic names are replaced by what they stand for.

    `has_ids`: its keys are ids of ports or components, whatever they are called.
    """
    return MappingNode(
        {e.key: e.with_value(_bind_value(e.key, e.value, bindings, has_ids=has_ids)) for e in node},
        node.span,
    )


def _bind_value(key: str, node: YamlNode, bindings: Mapping[str, str], *, has_ids: bool) -> YamlNode:
    if isinstance(node, MappingNode):
        # A port may be called `request` or `type`: where keys are ids, their words mean nothing.
        if not has_ids and key in OPERATION_PARTS:
            fields = {e.key: e.with_value(_bind_value("type", e.value, bindings, has_ids=False)) for e in node}
            return MappingNode(fields, node.span)
        is_data = key in _DATA_KEYS and not has_ids
        return node if is_data else bind_type_body(node, bindings, has_ids=key in _KEYS_OF_IDS and not has_ids)
    if key in _NAMING_KEYS | OPERATION_PARTS and isinstance(node, ScalarNode) and node.value is not None:
        text = bind_type_name(node.text, bindings)
        return node if text == node.text else ScalarNode(text, text, node.span)
    return node
