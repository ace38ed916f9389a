"""Expand the short forms, file by file, so that later stages never see them: every element becomes a mapping.

Empty entries are removed too (they count as not written), but below an id an empty entry declares the element and
becomes `{}`. Normalising twice changes nothing.
"""

from __future__ import annotations

import unicodedata
from typing import TYPE_CHECKING

from archgen.diagnostics import Diagnostic, Severity, diagnose_repetition
from archgen.frozen import dataclass, field, replace
from archgen.language.key_paths import SLICE
from archgen.language.language_tables import DATA_PARTS, ENTRIES, KEYS, LISTED_PARTS, SHORT_KEYS
from archgen.model.generic_names import write_generic_name
from archgen.schema import component_sugar
from archgen.schema.component_sugar import expand_parameters
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, find_value, list_entries

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.syntax.yaml_tree import YamlDocument, YamlNode


@dataclass(frozen=True, slots=True)
class ElementForm:
    """What a kind of element looks like.

    A scalar or list in the element's place is the value of every key in `short_keys`. The keys in `list_keys` always
    hold lists. `keyed_forms` are the keys that hold elements by id, `part_forms` those that hold a single one. The
    values of `raw_keys` are left as they are.
    """

    short_keys: tuple[str, ...] = ()
    list_keys: frozenset[str] = frozenset()
    keyed_forms: dict[str, ElementForm] = field(default_factory=dict)
    part_forms: dict[str, ElementForm] = field(default_factory=dict)
    raw_keys: frozenset[str] = frozenset()


_PLAIN_FORM = ElementForm()
_UNREAD_PARTS = frozenset({"variant_changes", "review.accepted"})
"""Parts that are normalised by themselves: sections once more, and lists of what was accepted."""


def _leaves_as_written(part: str) -> bool:
    return part in DATA_PARTS or ENTRIES.get(part) in DATA_PARTS or part in _UNREAD_PARTS


_FORMS: dict[str, ElementForm] = {}


def find_form(kind: str) -> ElementForm:
    """Return what elements of a kind look like."""
    if kind in _FORMS:
        return _FORMS[kind]
    form = ElementForm(
        SHORT_KEYS.get(kind, ()),
        frozenset(key for key, part in KEYS[kind].items() if part in LISTED_PARTS),
        raw_keys=frozenset(key for key, part in KEYS[kind].items() if _leaves_as_written(part)),
    )
    # Components hold components: a form that holds itself is found here while its keys are looked at.
    _FORMS[kind] = form
    for key, part in KEYS[kind].items():
        if key in form.raw_keys:
            continue
        if (entry := ENTRIES.get(part, "")) in SHORT_KEYS:
            form.keyed_forms[key] = find_form(entry)
        elif part in KEYS and (part_form := find_form(part)) != _PLAIN_FORM:
            form.part_forms[key] = part_form
    return form


def normalise_document(document: YamlDocument) -> tuple[Diagnostic, ...]:
    """Bring a validated document into the normal form. Its tree is changed in place."""
    inner_diagnostics = (*_normalise_libraries(document), *_normalise_changes(document))
    # Types and indicators first: both look at short forms that _normalise_mapping expands.
    types = document.root.get("types")
    type_diagnostics = tuple(_fold_type_names(types)) if isinstance(types, MappingNode) else ()
    sugar_diagnostics = component_sugar.expand_sugar(document)
    indicator_diagnostics = tuple(
        diagnostic
        for _, component in component_sugar.list_component_bodies(document.root)
        for diagnostic in _collect_overall(component)
    )
    parameter_diagnostics = tuple(expand_parameters(document.root))
    _normalise_mapping(document.root, find_form(SLICE))
    _drop_empty_step_keys(document.root)
    review = document.root.get("review")
    for entry in list_entries(review, "accepted"):
        entry.value = _list_accepted(entry)
    return inner_diagnostics + type_diagnostics + sugar_diagnostics + indicator_diagnostics + parameter_diagnostics


def _drop_empty_step_keys(root: MappingNode) -> None:
    """Drop the empty keys in the steps of use cases, in place: these are no elements by id."""
    for entry in list_entries(root, "use_cases"):
        steps = find_value(entry.value, "steps")
        for step in steps.items if isinstance(steps, SequenceNode) else ():
            if isinstance(step, MappingNode):
                _normalise_mapping(step, _PLAIN_FORM)


def _normalise_libraries(document: YamlDocument) -> Iterator[Diagnostic]:
    """Normalise what a packed file holds of its libraries, each as if it were a file of its own."""
    for library in list_entries(document.root, "libraries"):
        if isinstance(library.value, MappingNode):
            yield from normalise_document(replace(document, root=library.value))


def _normalise_changes(document: YamlDocument) -> Iterator[Diagnostic]:
    """Normalise what each variant writes over the project, each as if it were a file of its own."""
    for variant in list_entries(document.root, "variants"):
        changes = find_value(variant.value, "changes")
        if isinstance(changes, MappingNode):
            empty_keys = list(_list_empty_keys(changes))
            yield from normalise_document(replace(document, root=changes))
            for path, entry, holder in empty_keys:
                if entry.key not in holder.entries:  # an empty parameter is a value, an empty element is an element
                    holder.declares &= bool(holder.entries)
                    yield Diagnostic(
                        "missing-variant-part",
                        f"`{entry.key}` is empty, which changes nothing in a variant",
                        entry.key_span,
                        Severity.WARNING,
                        help=f"to take it out, write `drop: [{'.'.join((*path, entry.key))}]` in the variant instead",
                        element=variant.key,
                    )


def _list_empty_keys(
    mapping: MappingNode, path: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], MappingEntry, MappingNode]]:
    """Yield the keys without a value, each with the keys that lead to it and the mapping that holds it."""
    for entry in mapping:
        if isinstance(entry.value, MappingNode):
            yield from _list_empty_keys(entry.value, (*path, entry.key))
        elif isinstance(entry.value, ScalarNode) and entry.value.value is None:
            yield path, entry, mapping


def _list_accepted(accepted_entry: MappingEntry) -> SequenceNode:
    """Return what is accepted of an element as a list of mappings: one for each key of it and partner."""
    node, form = accepted_entry.value, ElementForm(("reason",))
    if isinstance(node, SequenceNode):
        return SequenceNode([_normalise_element(item, form) for item in node.items], node.span)
    body = _normalise_element(node, form)
    return SequenceNode([MappingNode(body.entries, accepted_entry.key_span)], node.span)


def fold_type_name(name: str) -> str:
    """Return a type's name as it is compared: runs of blanks folded to one, in Unicode's composed form (NFC).

    `Envelope< Pose,Twist >` is `Envelope<Pose, Twist>`.
    """
    # Nearly every name is plain ASCII without double blanks and needs no work.
    is_folded = name.isascii() and "  " not in name and "<" not in name and name == name.strip()
    return name if is_folded else write_generic_name(unicodedata.normalize("NFC", " ".join(name.split())))


def _normalise_element(node: YamlNode, form: ElementForm) -> MappingNode:
    """Return an element as a mapping: itself, or its short form expanded; empty becomes `{}`."""
    if isinstance(node, MappingNode):
        _normalise_mapping(node, form)
        return node
    if isinstance(node, ScalarNode) and node.value is None:
        return MappingNode({}, node.span)
    # All keys share the node where there are several: safe, because scalars and lists are not changed after this.
    return MappingNode(
        {key: MappingEntry(key, node.span, _normalise_leaf(key, node, form)) for key in form.short_keys}, node.span
    )


def _normalise_leaf(key: str, node: YamlNode, form: ElementForm) -> YamlNode:
    return SequenceNode([node], node.span) if key in form.list_keys and isinstance(node, ScalarNode) else node


def _normalise_mapping(mapping: MappingNode, form: ElementForm) -> None:
    """Bring the entries of a mapping into the normal form in place, and drop those that are empty."""
    empty_keys: list[str] = []
    for key, entry in mapping.entries.items():
        node = entry.value
        if isinstance(node, ScalarNode) and node.value is None:
            empty_keys.append(key)
        elif key in form.part_forms:
            entry.value = _normalise_element(node, form.part_forms[key])
        elif isinstance(node, MappingNode):
            _normalise_below(key, node, form)
        else:
            entry.value = _normalise_leaf(key, node, form)
    for key in empty_keys:
        del mapping.entries[key]


def _normalise_below(key: str, mapping: MappingNode, form: ElementForm) -> None:
    if key in form.keyed_forms:
        element_form = form.keyed_forms[key]
        for entry in mapping.entries.values():
            entry.value = _normalise_element(entry.value, element_form)
    elif key not in form.raw_keys:
        _normalise_mapping(mapping, _PLAIN_FORM)


def _fold_type_names(types: MappingNode) -> Iterator[Diagnostic]:
    """Replace the names of types by their folded form, and report names that fold to the same."""
    if all(fold_type_name(key) == key for key in types.entries):
        return
    folded_types: dict[str, MappingEntry] = {}
    for entry in types:
        name = fold_type_name(entry.key)
        first_entry = folded_types.setdefault(name, entry)
        if first_entry is not entry:
            yield diagnose_repetition(
                "duplicate-key", f"the type `{name}` is written twice", entry.key_span, first_entry.key_span
            )
        entry.key = name
    types.entries = folded_types


# The figures of an indicator that may be written directly in `performance`.
_DIRECT_KEYS = ("accuracy", "execution_time")


def _collect_overall(component: MappingNode) -> Iterator[Diagnostic]:
    """Move figures written directly in `performance` into its indicator `overall`."""
    performance = component.get("performance")
    if isinstance(performance, MappingNode):
        yield from _move_to_overall(performance)


def _move_to_overall(performance: MappingNode) -> Iterator[Diagnostic]:
    direct_entries = [performance.entries[key] for key in _DIRECT_KEYS if isinstance(performance.get(key), ScalarNode)]
    for entry in direct_entries:
        del performance.entries[entry.key]
    written_entries = [
        entry for entry in direct_entries if isinstance(entry.value, ScalarNode) and entry.value.value is not None
    ]
    if not written_entries:
        return
    # Validation has left either a mapping or an empty `overall:`, which gives way to the figures.
    overall_entry = performance.entries.get("overall")
    if overall_entry is None or not isinstance(overall_entry.value, MappingNode):
        overall_entry = MappingEntry(
            "overall", written_entries[0].key_span, MappingNode({}, written_entries[0].key_span)
        )
        performance.entries = {"overall": overall_entry} | performance.entries | {"overall": overall_entry}
    for entry in written_entries:
        first_entry = (
            overall_entry.value.entries.setdefault(entry.key, entry)
            if isinstance(overall_entry.value, MappingNode)
            else entry
        )
        if first_entry is not entry:
            message = f"`{entry.key}` of the indicator `overall` is written twice"
            yield diagnose_repetition("conflicting-values", message, entry.value.span, first_entry.value.span)
