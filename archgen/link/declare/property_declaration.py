"""Declare what properties may be, and the glossary."""

from __future__ import annotations

import unicodedata
from decimal import Decimal

from archgen.diagnostics.diagnostic import Diagnostic, diagnose_repetition
from archgen.link import mapping_values
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.architecture import GlossaryTerm
from archgen.model.element_annotations import read_figure
from archgen.syntax.yaml_tree import MappingNode


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
    resolver.diagnostics.append(Diagnostic("wrong-value", message, span, help=help_line, element=property_id))
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
    resolver.diagnostics.append(Diagnostic("wrong-value", message, span, help=help_line, element=property_id))
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
