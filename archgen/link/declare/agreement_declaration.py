"""Declare the agreements of partners: terms in words, and what was signed."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.suggestions import did_you_mean
from archgen.link import mapping_values
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.value_readers import read_values
from archgen.model.agreed_terms import Agreement, Signature
from archgen.syntax.yaml_tree import MappingEntry, MappingNode


def declare_agreements(root: MappingNode, resolver: ReferenceResolver) -> dict[str, Agreement]:
    """Declare the agreements by id. One with nobody, with oneself, or that stands there in both orders is reported."""
    agreements: dict[str, Agreement] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "agreements"):
        signed = body.entries.get("signed")
        agreement = Agreement(
            name,
            mapping_values.get_text_mapping(body, "terms"),
            _read_texts_by_name(mapping_values.get_mapping(body, "interfaces")),
            _read_signature(signed) if signed and isinstance(signed.value, MappingNode) else None,
            entry.key_span,
        )
        if fault := _find_fault(agreement, root, agreements, resolver):
            message, help_line = fault
            resolver.diagnostics.append(
                Diagnostic("unknown-reference", message, entry.key_span, help=help_line, element=name)
            )
        agreements[name] = agreement
        _report_unknown_outputs(mapping_values.get_mapping(body, "interfaces"), name, resolver)
    return agreements


def _find_fault(
    agreement: Agreement, root: MappingNode, agreements: dict[str, Agreement], resolver: ReferenceResolver
) -> tuple[str, str] | None:
    """Return what is wrong with the id of an agreement, and what to do about it."""
    partners = mapping_values.get_mapping(root, "partners").entries
    first, second = agreement.pair
    unknown = next((each for each in (first, second) if each not in partners and not resolver.is_lost(each)), None)
    if unknown:
        return f"there is no partner `{unknown}`", did_you_mean(unknown, partners) or "partners stand below `partners`"
    if first == second:
        return f"`{agreement.id}` names one partner twice", "an agreement is between two partners"
    if f"{second}-{first}" in agreements:
        return f"`{agreement.id}` is `{second}-{first}` the other way round", "write all of it below one of them"
    return None


def _read_signature(entry: MappingEntry) -> Signature:
    body = mapping_values.get_body(entry)
    versions = mapping_values.get_mapping(body, "versions")
    parts: list[tuple[tuple[str, ...], MappingNode]] = [((), body)]
    parts += [((giver.key,), mapping_values.get_body(giver)) for giver in versions]
    return Signature(
        **read_values("signature", Signature, body),
        by=mapping_values.get_text_mapping(body, "by"),
        versions=_read_texts_by_name(versions),
        at=entry.key_span,
        places={(*path, each.key): each.key_span for path, mapping in parts for each in mapping},
    )


def _read_texts_by_name(mapping: MappingNode) -> dict[str, dict[str, str]]:
    return {entry.key: dict(mapping_values.get_text_mapping(mapping, entry.key)) for entry in mapping}


def _report_unknown_outputs(interfaces: MappingNode, name: str, resolver: ReferenceResolver) -> None:
    """Report terms of outputs that there are not. Names of topics follow from the outputs: they are judged elsewhere."""
    for entry in interfaces:
        if entry.key.startswith("/") or entry.key in resolver.spans["output"] or resolver.is_lost(entry.key):
            continue
        guess = resolver.guesser.guess_name(entry.key, resolver.spans["output"])
        help_line = f"did you mean `{guess}`?" if guess else "name an output by its complete id, or a topic: `/tf`"
        message = f"no output named `{entry.key}`"
        resolver.diagnostics.append(
            Diagnostic("unknown-reference", message, entry.key_span, help=help_line, element=name)
        )
