"""Declare the requirements: what each is a part of, which use cases it serves, and what shows that it is met."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.link import mapping_values
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.requirement import Requirement, Verification
from archgen.syntax.yaml_tree import MappingEntry, MappingNode


def declare_requirements(root: MappingNode, resolver: ReferenceResolver) -> dict[str, Requirement]:
    """Declare the requirements, with the parents and use cases that are declared."""
    return {
        name: _declare_requirement(name, entry, body, resolver)
        for name, entry, body in mapping_values.iterate_elements(root, "requirements")
    }


def _declare_requirement(name: str, entry: MappingEntry, body: MappingNode, resolver: ReferenceResolver) -> Requirement:
    parents = mapping_values.get_scalars(body, "parent")
    return Requirement(
        id=name,
        title=mapping_values.get_text(body, "title") or name,
        description=mapping_values.get_text(body, "description"),
        parents=resolver.resolve_plain_ids(parents, "requirement", name),
        kind=mapping_values.get_text(body, "kind"),
        priority=mapping_values.get_text(body, "priority"),
        rationale=mapping_values.get_text(body, "rationale"),
        source=mapping_values.get_text(body, "source"),
        verified_by=tuple(_read_verifications(body, resolver, name)),
        use_cases=resolver.resolve_plain_ids(mapping_values.get_scalars(body, "use_cases"), "use case", name),
        tags=mapping_values.get_texts(body, "tags"),
        urls=mapping_values.get_text_mapping(body, "urls"),
        annotations=mapping_values.get_annotations(body),
        at=entry.key_span,
        parent_at=parents[0].span if parents else entry.key_span,
    )


def _read_verifications(body: MappingNode, resolver: ReferenceResolver, name: str) -> Iterator[Verification]:
    """Yield what shows that a requirement is met, each once; of what is both a use case and a chain nothing."""
    seen_texts: set[str] = set()
    for scalar in mapping_values.get_scalars(body, "verified_by"):
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
                    element=name,
                )
            )
        elif use_case_span:
            yield Verification("use_case", text, scalar.span)
        elif chain_span:
            yield Verification("chain", text, scalar.span)
        else:
            is_sentence = any(letter.isspace() for letter in text)
            yield Verification("text" if is_sentence else "file", text, scalar.span)
