"""Declare what a requirement is a part of, and what shows that it is met."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.link import mapping_values
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.requirement import Verification
from archgen.syntax.yaml_tree import MappingNode


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
            resolver.diagnostics.append(
                Diagnostic(
                    "ambiguous-reference",
                    f"`{text}` can mean the use case or the chain of this name",
                    scalar.span,
                    labels=(Label(use_case_span, "the use case"), Label(chain_span, "the chain")),
                    help="rename one of them",
                    element=requirement_id,
                )
            )
        elif use_case_span:
            found.append(Verification("use_case", text, scalar.span))
        elif chain_span:
            found.append(Verification("chain", text, scalar.span))
        else:
            is_sentence = any(letter.isspace() for letter in text)
            found.append(Verification("text" if is_sentence else "file", text, scalar.span))
    return tuple(found)
