"""Declare what a project says of properties, and its glossary."""

from __future__ import annotations

import unicodedata
from decimal import Decimal
from typing import get_args

from archgen.diagnostics.diagnostic import Diagnostic, diagnose_repetition
from archgen.link import mapping_values
from archgen.model.architecture import GlossaryTerm
from archgen.model.element_annotations import PropertyDeclaration, PropertyType, read_figure
from archgen.syntax.yaml_tree import MappingNode

_TYPES = frozenset(get_args(PropertyType))


def declare_properties(root: MappingNode, diagnostics: list[Diagnostic]) -> dict[str, PropertyDeclaration]:
    """Return the declared properties by id. What contradicts itself is reported, and left out."""
    return {
        name: PropertyDeclaration(
            id=name,
            title=mapping_values.get_title(body, name),
            description=mapping_values.get_text(body, "description"),
            of=tuple(dict.fromkeys(mapping_values.get_texts(body, "of"))),
            type=_read_type(body),
            unit=mapping_values.get_text(body, "unit"),
            range=_read_range(body, name, diagnostics),
            choices=mapping_values.get_texts(body, "choices"),
            required=_read_required(body, name, diagnostics),
            at=entry.key_span,
        )
        for name, entry, body in mapping_values.iterate_elements(root, "properties")
    }


def _read_type(body: MappingNode) -> PropertyType | None:
    word = mapping_values.get_text(body, "type")
    return word if word in _TYPES else None  # type: ignore[return-value]


def _read_range(body: MappingNode, name: str, diagnostics: list[Diagnostic]) -> tuple[Decimal, Decimal] | None:
    texts = mapping_values.get_texts(body, "range")
    if not texts:
        return None
    numbers = [limit for limit in map(_read_limit, texts) if limit is not None]
    if len(texts) == len(numbers) == 2 and numbers[0] <= numbers[1]:  # noqa: PLR2004 - smallest and greatest
        return numbers[0], numbers[1]
    message = f"the range of the property `{name}` is not its smallest and its greatest number"
    help_line = "write `range: [1, 9]`; what they are measured in is `unit`"
    diagnostics.append(
        Diagnostic("wrong-value", message, mapping_values.get_span(body, "range"), help=help_line, element=name)
    )
    return None


def _read_limit(text: str) -> Decimal | None:
    if text.lower().lstrip("+-") == ".inf":  # as YAML writes it
        return Decimal("-Infinity" if text.startswith("-") else "Infinity")
    figure = read_figure(text)
    return figure.value if figure and not figure.unit else None


def _read_required(body: MappingNode, name: str, diagnostics: list[Diagnostic]) -> bool:
    is_required = mapping_values.get_flag(body, "required")
    if not is_required or mapping_values.get_texts(body, "of"):
        return is_required
    message = f"the property `{name}` is required of every kind of element"
    help_line = "say of which ones: `of: [component]`"
    diagnostics.append(
        Diagnostic("wrong-value", message, mapping_values.get_span(body, "required"), help=help_line, element=name)
    )
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
