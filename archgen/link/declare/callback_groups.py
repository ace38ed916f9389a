"""Declare the callback groups of a node: which of its components exclude one another."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.link import mapping_values, sanity_checks
from archgen.link.path_guesses import take_path_end
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.unknown_references import diagnose_unknown_reference
from archgen.syntax.yaml_tree import MappingNode, ScalarNode

EXECUTOR_KEYS = ("threads", "scheduling", "callback_groups", "reentrant")
"""The keys of a node that say how its callbacks are run."""


def declare_callback_groups(
    body: MappingNode, resolver: ReferenceResolver, node_id: str, implements: tuple[str, ...]
) -> dict[str, tuple[str, ...]]:
    """Return the components of each callback group, by the group's id.

    What the node does not implement is left out and reported, and so is a component that is named again.
    """
    groups: dict[str, tuple[str, ...]] = {}
    first_spans: dict[str, Span] = {}
    groups_body = mapping_values.get_mapping(body, "callback_groups")
    written_names = {scalar.text for scalar in mapping_values.get_scalars(body, "implements")}
    is_complete = 0 < len(written_names) <= len(implements)
    for entry in groups_body:
        sanity_checks.report_empty_list(groups_body, entry.key, "component", node_id, resolver.diagnostics)
        members: list[str] = []
        for scalar in mapping_values.get_scalars(groups_body, entry.key):
            component = _resolve_component(scalar, resolver, node_id, implements, is_complete=is_complete)
            if component in first_spans:
                resolver.diagnostics.append(_diagnose_second_group(scalar, first_spans[component], node_id))
            elif component is not None:
                first_spans[component] = scalar.span
                members.append(component)
        if members:
            groups[entry.key] = tuple(members)
    return groups


def _resolve_component(
    reference: ScalarNode,
    resolver: ReferenceResolver,
    node_id: str,
    implements: tuple[str, ...],
    *,
    is_complete: bool,
) -> str | None:
    """Return the component of the node that a reference means: its id, or the end of it.

    Where not all that the node implements is known (`is_complete`), it may be what is not.
    """
    matching = [name for name in implements if name == reference.text or name.endswith(f".{reference.text}")]
    if len(matching) == 1:
        return matching[0]
    if matching:
        resolver.diagnostics.append(
            Diagnostic(
                "ambiguous-reference",
                f"`{reference.text}` can mean {' or '.join(f'`{name}`' for name in matching)}",
                reference.span,
                help=f"write `{matching[0]}`, for instance",
                element=node_id,
            )
        )
    elif is_complete and not resolver.is_lost(reference.text):
        length = reference.text.count(".") + 1
        guess = resolver.guesser.guess_name(reference.text, [take_path_end(name, length) for name in implements])
        diagnostic = diagnose_unknown_reference(
            reference, f"component of `{node_id}`", guess, NO_SPAN, node_id, known_names=implements
        )
        resolver.diagnostics.append(diagnostic)
    return None


def _diagnose_second_group(reference: ScalarNode, first_span: Span, node_id: str) -> Diagnostic:
    return Diagnostic(
        "conflicting-values",
        f"`{reference.text}` is in two places of `callback_groups`",
        reference.span,
        labels=(Label(first_span, "named here"),),
        help="a component is in one group: keep one of them",
        element=node_id,
    )
