"""Declare the start-up of nodes: what is written below `start`, with the nodes and components that it names."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics import Diagnostic, Span
from archgen.link import mapping_values, sanity_checks
from archgen.link.reference_resolution import ReferenceResolver, find_inner_component
from archgen.link.value_readers import read_values
from archgen.model.node import ReadyConditions, StartTarget, StartUp
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, list_entries

_NOT_INHERITED = frozenset({"ready", "once"})
"""What a composed component says of itself, and not of each node inside."""


def declare_start(body: MappingNode, resolver: ReferenceResolver, node_id: str) -> StartUp | None:
    """Return what a node says of its start-up; None where it says nothing."""
    start = body.get("start")
    if not isinstance(start, MappingNode) or not start.entries:
        return None
    sanity_checks.report_empty_list(start, "after", "node or component", node_id, resolver.diagnostics)
    manager = mapping_values.get_scalar(start, "by")
    targets = (_resolve_target(each, resolver, node_id) for each in mapping_values.get_scalars(start, "after"))
    return StartUp(
        **read_values("start", StartUp, start),
        after=tuple(dict.fromkeys(filter(None, targets))),
        ready=_read_conditions(mapping_values.get_mapping(start, "ready"), resolver, node_id),
        by=_resolve_target(manager, resolver, node_id) if manager else None,
        by_written=manager is not None,
        places={
            **_list_places(start),
            **{f"environment.{each.name}": each.at for each in mapping_values.list_placed_texts(start, "environment")},
        },
    )


def read_command(body: MappingNode, resolver: ReferenceResolver, node_id: str) -> tuple[str, ...]:
    """Return the words of a node's command."""
    sanity_checks.report_empty_list(body, "command", "program", node_id, resolver.diagnostics)
    return mapping_values.get_texts(body, "command")


def _read_conditions(ready: MappingNode, resolver: ReferenceResolver, node_id: str) -> ReadyConditions:
    return ReadyConditions(
        **read_values("start_ready", ReadyConditions, ready),
        within=sanity_checks.read_positive(ready, "within", "duration", node_id, resolver.diagnostics),
        places=_list_places(ready),
    )


def _list_places(mapping: MappingNode) -> dict[str, Span]:
    # The span of a mapping may cover lines: its key is shown instead.
    return {e.key: e.key_span if isinstance(e.value, MappingNode) else e.value.span for e in mapping}


def _resolve_target(
    reference: ScalarNode, resolver: ReferenceResolver, element_id: str, component_id: str | None = None
) -> StartTarget | None:
    """Return the component that a reference names; where no component is called so, the node."""
    inner_id = find_inner_component(reference.text, resolver, component_id) if component_id else None
    if inner_id is not None:
        return StartTarget("component", inner_id, reference.span)
    # A node often has the name of the component that it implements: both would be meant by one word.
    has_component = resolver.names.resolve_path(reference.text, ("component",), component_id=component_id).count > 0
    kinds = ("component",) if has_component else ("component", "node")
    target = resolver.resolve_reference(reference, kinds, element_id, component_id)
    if target is None:
        return None
    return StartTarget("node" if target.kind == "node" else "component", target.id, reference.span)


def resolve_start(body: MappingNode, resolver: ReferenceResolver, component_id: str) -> MappingNode:
    """Return what a component says of its node with complete ids in `after` and `by`: others inherit these.

    What cannot be resolved is reported and left out.
    """

    def complete(entry: MappingEntry) -> MappingEntry | None:
        targets = [
            ScalarNode(target.id, target.id, scalar.span)
            for scalar in mapping_values.list_scalars(entry.value)
            if (target := _resolve_target(scalar, resolver, component_id, component_id))
        ]
        if entry.key == "by":
            return entry.with_value(targets[0]) if targets else entry
        return entry.with_value(SequenceNode([*targets], entry.value.span)) if targets else None

    return body.change_keys({"start": lambda start: start.change_keys(dict.fromkeys(("after", "by"), complete))})


def diagnose_idle_start(node_body: MappingNode, component_id: str) -> Iterator[Diagnostic]:
    """Yield what a composed component says that is no process of its own: of each node inside it cannot be meant."""
    for entry in list_entries(node_body, "start"):
        if entry.key in _NOT_INHERITED:
            yield Diagnostic(
                "idle-start",
                f"`{entry.key}` of `{component_id}` has no effect: it is no process of its own",
                entry.key_span,
                help="write it at a component inside, or `whole: true` where all of it runs as one node",
                element=component_id,
            )


def inherit_start(entry: MappingEntry) -> MappingEntry | None:
    """Return what a composed component says of the start-up of all nodes inside; None where that is nothing."""
    if not isinstance(entry.value, MappingNode):
        return None
    entries = {each.key: each for each in entry.value if each.key not in _NOT_INHERITED}
    return entry.with_entries(entries) if entries else None
