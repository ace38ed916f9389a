"""Declare elements by the language's tables: what a key says by its value alone, then what takes the rest of the project.

What keys say together with the rest of the project: what they name, and figures that cannot be.

Declare what properties may be, and the glossary.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Mapping
from decimal import Decimal
from functools import cache, partial
from typing import Any, TypeVar

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Span, diagnose_repetition
from archgen.language.language_tables import KEYS, OFFERS, SECTION_KINDS
from archgen.link import mapping_values, sanity_checks
from archgen.link.declare.timing_declaration import read_deadline
from archgen.link.promise_reading import read_day
from archgen.link.reference_resolution import SECTIONS_OF_PLAIN_NAMES, ReferenceResolver
from archgen.link.value_readers import find_type, find_value_reader, list_held_keys, read_element, store_value
from archgen.model.architecture import GlossaryTerm, Milestone, Partner
from archgen.model.deployment import Host, Link, Resource
from archgen.model.element_annotations import PropertyDeclaration, read_figure
from archgen.model.path_resolver import ElementRef
from archgen.model.quantity import Quantity
from archgen.model.requirement import Requirement, Verification
from archgen.syntax.yaml_tree import MappingEntry, MappingNode


def read_range(
    body: MappingNode, key: str, property_id: str, resolver: ReferenceResolver
) -> tuple[Decimal, Decimal] | None:
    """Return the smallest and the greatest number of a property; what is none is reported."""
    texts = mapping_values.get_texts(body, key)
    if not texts:
        return None
    numbers = [limit for limit in map(_read_limit, texts) if limit is not None]
    if len(texts) == len(numbers) == 2 and numbers[0] <= numbers[1]:  # noqa: PLR2004 - smallest and greatest
        return numbers[0], numbers[1]
    message = f"the range of the property `{property_id}` is not its smallest and its greatest number"
    help_line = "write `range: [1, 9]`; what they are measured in is `unit`"
    span = mapping_values.get_span(body, key)
    resolver.report("wrong-value", message, span, help_line=help_line, element=property_id)
    return None


def _read_limit(text: str) -> Decimal | None:
    if text.lower().lstrip("+-") == ".inf":  # as YAML writes it
        return Decimal("-Infinity" if text.startswith("-") else "Infinity")
    figure = read_figure(text)
    return figure.value if figure and not figure.unit else None


def read_required(body: MappingNode, key: str, property_id: str, resolver: ReferenceResolver) -> bool:
    """Return whether every element of some kinds has a property; of which ones is reported where it is not said."""
    is_required = mapping_values.get_flag(body, key)
    if not is_required or mapping_values.get_texts(body, "of"):
        return is_required
    message = f"the property `{property_id}` is required of every kind of element"
    help_line = "say of which ones: `of: [component]`"
    span = mapping_values.get_span(body, key)
    resolver.report("wrong-value", message, span, help_line=help_line, element=property_id)
    return False


def declare_glossary(root: MappingNode, diagnostics: list[Diagnostic]) -> dict[str, GlossaryTerm]:
    """Return the terms with what they mean. Two that texts could not tell apart are reported; the first one counts."""
    terms: dict[str, GlossaryTerm] = {}
    terms_by_key: dict[str, GlossaryTerm] = {}
    section = mapping_values.get_mapping(root, "glossary")
    for entry in section:
        text = mapping_values.get_text(section, entry.key)
        if text is None:
            continue
        term = GlossaryTerm(" ".join(entry.key.split()), text, entry.key_span)
        first_term = terms_by_key.setdefault(fold_term(term.term), term)
        if first_term is term:
            terms[term.term] = term
            continue
        diagnostics.append(
            diagnose_repetition(
                "conflicting-values",
                f"the term `{term.term}` is in the glossary twice: a first capital does not count",
                entry.key_span,
                first_term.at,
                help_line="keep one of them",
            )
        )
    return terms


def fold_term(term: str) -> str:
    """Return a term in the form in which terms are told apart: a first capital counts only in what has others, too.

    `Arm` and `arm` are one term, `IT` and `it` are two.
    """
    folded = " ".join(unicodedata.normalize("NFC", term).split())
    return folded if folded[1:] != folded[1:].lower() else folded.lower()


Element = TypeVar("Element")
_SECTIONS = {kind: section for section, kind in SECTION_KINDS.items()}
_PLAIN_KINDS = {section: kind for kind, section in SECTIONS_OF_PLAIN_NAMES.items()}


def declare_sections(root: MappingNode, resolver: ReferenceResolver) -> dict[str, Any]:
    """Declare the elements of which the tables say all, by section and id."""
    return {
        section: declare_elements(root, kind, DECLARED_CLASSES[kind], resolver)
        for section, kind in SECTION_KINDS.items()
        if kind in DECLARED_CLASSES
    }


def declare_elements(
    root: MappingNode, kind: str, made_class: type[Element], resolver: ReferenceResolver
) -> dict[str, Element]:
    """Declare the elements of a kind, by id."""
    section = mapping_values.get_mapping(root, _SECTIONS[kind])
    return {entry.key: declare_element(kind, made_class, entry, resolver) for entry in section}


def declare_element(
    kind: str,
    made_class: type[Element],
    entry: MappingEntry,
    resolver: ReferenceResolver,
    **own_fields: Any,  # noqa: ANN401 - of any field
) -> Element:
    """Declare an element: what is not written, or cannot be read, has the default of its class.

    `own_fields` are those that the declaration of its kind reads by itself.
    """
    body = mapping_values.get_body(entry)
    plain_class: type = made_class
    values = read_element(kind, plain_class, entry, body)
    for key, names, declare_key in _list_declarers(kind, plain_class):
        if key in body.entries:
            store_value(values, names, declare_key(body, key, entry.key, resolver))
    return made_class(**values, **own_fields)


@cache
def _list_declarers(kind: str, made_class: type) -> tuple[tuple[str, tuple[str, ...], KeyDeclarer], ...]:
    """Return the keys of a kind that say something together with the rest of the project, and how they are declared."""
    held_keys = list_held_keys(kind, made_class)
    return tuple(
        (key, names, declarer) for key, names in held_keys.items() if (declarer := find_declarer(kind, key)) is not None
    )


def find_declarer(kind: str, key: str) -> KeyDeclarer | None:
    """Return what declares a key, None where its value alone says all, and where the declaration of the kind does it."""
    part = find_type(kind, key)
    if f"{kind}.{key}" in DECLARERS:
        return DECLARERS[f"{kind}.{key}"]
    if find_value_reader(kind, key):
        return None
    named_kinds = [_PLAIN_KINDS.get(section) for section in OFFERS.get(KEYS[kind][key], ())]
    if part in NAMING_TYPES and len(named_kinds) == 1 and named_kinds[0]:
        return partial(NAMING_TYPES[part], kind=named_kinds[0])
    return DECLARERS.get(part)


DECLARED_CLASSES: Mapping[str, type] = {
    "partner": Partner,
    "milestone": Milestone,
    "requirement": Requirement,
    "property_declaration": PropertyDeclaration,
    "host": Host,
    "resource": Resource,
    "link": Link,
}
"""The classes of the kinds of which the tables say all; their sections are fields of the architecture."""


KeyDeclarer = Callable[[MappingNode, str, str, ReferenceResolver], Any]
"""Returns what stands at a key of the element with an id; what is wrong with it goes to the resolver's diagnostics."""


def _resolve_id(body: MappingNode, key: str, element_id: str, resolver: ReferenceResolver, kind: str) -> str | None:
    return resolver.resolve_plain_id(mapping_values.get_scalar(body, key), kind, element_id)


def _resolve_ids(
    body: MappingNode, key: str, element_id: str, resolver: ReferenceResolver, kind: str
) -> tuple[str, ...]:
    return resolver.resolve_plain_ids(mapping_values.get_scalars(body, key), kind, element_id)


def _read_positive(
    body: MappingNode, key: str, element_id: str, resolver: ReferenceResolver, dimension: str
) -> Quantity | None:
    return sanity_checks.read_positive(body, key, dimension, element_id, resolver.diagnostics)


def _read_day(body: MappingNode, key: str, element_id: str, resolver: ReferenceResolver) -> str | None:
    return read_day(body, key, element_id, resolver.diagnostics)


def read_link_ends(
    body: MappingNode, key: str, link_id: str, resolver: ReferenceResolver
) -> tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    """Return the hosts that a link connects, the components that are devices on it, and the ends that name neither."""
    ends = _resolve_ends(body, key, resolver, link_id)
    hosts, devices = (
        tuple(dict.fromkeys(end.id for _, end in ends if end and end.kind == kind)) for kind in ("host", "component")
    )
    return hosts, devices, tuple(text for text, end in ends if end is None)


def _resolve_ends(
    body: MappingNode, key: str, resolver: ReferenceResolver, link_id: str
) -> list[tuple[str, ElementRef | None]]:
    """Return what a link connects, each end as written and what it means: a host by its id wins over a component."""
    hosts = resolver.plain_spans["host"]
    ends: list[tuple[str, ElementRef | None]] = []
    for scalar in mapping_values.get_scalars(body, key):
        if scalar.text in hosts:
            ends.append((scalar.text, ElementRef("host", scalar.text)))
        elif _may_be_device(scalar.text, resolver):
            ends.append((scalar.text, resolver.resolve_reference(scalar, ("component",), link_id)))
        else:
            resolver.resolve_plain_id(scalar, "host", link_id)
            ends.append((scalar.text, None))
    return ends


def _may_be_device(text: str, resolver: ReferenceResolver) -> bool:
    """Whether an end of a link that is no host means a component, or a slip of the pen in the name of one."""
    if "." in text or resolver.names.ids_ending_in("component", text):
        return True
    if resolver.guesser.guess_name(text, resolver.plain_spans["host"]):
        return False
    component_names = {path.rpartition(".")[2] for path in resolver.spans["component"]}
    return resolver.guesser.guess_name(text, component_names) is not None


def read_parents(
    body: MappingNode, key: str, requirement_id: str, resolver: ReferenceResolver
) -> tuple[tuple[str, ...], Span]:
    """Return the requirements that one is a part of, and where the first of them is written."""
    parents = mapping_values.get_scalars(body, key)
    span = parents[0].span if parents else NO_SPAN
    return resolver.resolve_plain_ids(parents, "requirement", requirement_id), span


def read_verifications(
    body: MappingNode, key: str, requirement_id: str, resolver: ReferenceResolver
) -> tuple[Verification, ...]:
    """Return what shows that a requirement is met, each once; of what is both a use case and a chain nothing."""
    found: list[Verification] = []
    seen_texts: set[str] = set()
    for scalar in mapping_values.get_scalars(body, key):
        text = scalar.text.strip()
        if not text or text in seen_texts:
            continue
        seen_texts.add(text)
        use_case_span = resolver.plain_spans["use case"].get(text)
        chain_span = resolver.plain_spans["chain"].get(text)
        if use_case_span and chain_span:
            resolver.report(
                "ambiguous-reference",
                f"`{text}` can mean the use case or the chain of this name",
                scalar.span,
                labels=(Label(use_case_span, "the use case"), Label(chain_span, "the chain")),
                help_line="rename one of them",
                element=requirement_id,
            )
        elif use_case_span:
            found.append(Verification("use_case", text, scalar.span))
        elif chain_span:
            found.append(Verification("chain", text, scalar.span))
        else:
            is_sentence = any(letter.isspace() for letter in text)
            found.append(Verification("text" if is_sentence else "file", text, scalar.span))
    return tuple(found)


NAMING_TYPES = {"id": _resolve_id, "requirement_ids": _resolve_ids}
"""Types of what is named by its id alone; the description says what a key `offers`."""
DECLARERS: Mapping[str, KeyDeclarer] = {
    "bandwidth": partial(_read_positive, dimension="bandwidth"),
    "chain_deadline": read_deadline,
    "day": _read_day,
    "link.connects": read_link_ends,
    "link.latency": sanity_checks.read_latency,
    "property_declaration.range": read_range,
    "property_declaration.required": read_required,
    "requirement.parent": read_parents,
    "requirement.verified_by": read_verifications,
}
"""What declares the keys of a type, and single keys (`KIND.KEY`)."""
