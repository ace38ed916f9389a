"""Where a change stands in the files of the second version: at the changed key, the element, or what held it."""

from __future__ import annotations

from archgen.compare.comparison import Change, Comparison
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.diagnostics import NO_SPAN, Span
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.declared_timing import Timing
from archgen.model.node import Node


def find_change_span(change: Change, comparison: Comparison) -> Span:
    """Return where a change stands in the second version. What was removed stood in its parent; NO_SPAN without one."""
    kind = "input" if change.element_kind == "connection" else change.element_kind
    if kind == "project" and change.key and change.key.startswith("agreements."):
        return _find_agreement_span(change.key, comparison)
    element = _find_element(kind, change.element_id, comparison)
    if element is None:
        return _find_parent_span(kind, change.element_id, comparison)
    key_span = _find_key_span(element, change.key, comparison.after.architecture) if change.key else NO_SPAN
    return key_span if key_span.file else getattr(element, "at", NO_SPAN)


def find_old_file(change: Change, comparison: Comparison) -> str:
    """Return the file of the first version in which a removed element stood, empty if that is not known."""
    spec = ELEMENT_KINDS.get(change.element_kind)
    elements = spec.elements(comparison.before) if spec and spec.elements else {}
    span: Span = getattr(elements.get(change.old_id or change.element_id), "at", NO_SPAN)
    return span.file


def _find_element(kind: str, element_id: str, comparison: Comparison) -> object | None:
    architecture = comparison.after.architecture
    if kind == "project":
        return architecture.project
    if kind == "port":
        node = architecture.nodes.get(element_id.partition(".")[0])
        names = {element_id.rpartition(".")[2]}
        uses = (use for use in node.uses if f".{use.use}." in element_id) if node else ()
        return next((use for use in uses if names & {use.key, (use.port or "").rpartition(".")[2]}), node)
    spec = ELEMENT_KINDS.get(kind)
    return spec.elements(comparison.after).get(element_id) if spec and spec.elements else None


def _find_agreement_span(key: str, comparison: Comparison) -> Span:
    """Return where an agreement says something: at the key of its signature, else the signature, else itself."""
    _, agreement_id, *path = key.split(".", 2)
    agreement = comparison.after.architecture.agreements.get(agreement_id)
    if agreement is None:
        return comparison.after.architecture.project.at
    signed = agreement.signed
    places = {".".join(names): span for names, span in signed.places.items()} if signed else {}
    return places.get("".join(path)) or (signed.at if signed else agreement.at)


def _find_parent_span(kind: str, element_id: str, comparison: Comparison) -> Span:
    """Return the span of what held a removed element: of an output its component, of a component its group."""
    architecture, matched_ids = comparison.after.architecture, comparison.matched_ids
    parent_id = element_id.rpartition(".")[0]
    component = architecture.components.get(matched_ids.common_id("component", parent_id))
    if kind in {"input", "output"} and component:
        return component.at
    if kind in {"input", "output", "component"}:
        group_id = matched_ids.common_id("group", element_id.partition(".")[0])
        return architecture.groups[group_id].at if group_id in architecture.groups else NO_SPAN
    return NO_SPAN


def _find_key_span(element: object, key: str, architecture: Architecture) -> Span:
    """Return the span of a key's value, NO_SPAN if the model does not hold it."""
    first_word = key.partition(".")[0]
    topic_spans: tuple[Span, ...] = getattr(element, "topic_places", ())
    spans = [
        # Before the span of the whole `timing`, which is an attribute as well.
        *(
            timing.places.get(name, NO_SPAN)
            for timing in _list_timings(element, architecture)
            for name in _spell_key(key)
        ),
        getattr(element, "executor_places", {}).get(first_word, NO_SPAN),
        getattr(element, f"{first_word}_at", NO_SPAN),
        topic_spans[0] if first_word == "topic" and topic_spans else NO_SPAN,
        getattr(getattr(element, first_word, None), "at", NO_SPAN),
    ]
    return next((span for span in spans if span.file), NO_SPAN)


def _spell_key(key: str) -> tuple[str, ...]:
    """Return the keys of timing that a changed key may be written as: a period is compared as a rate."""
    if not key.startswith("timing."):
        return ()
    name = key.split(".")[1]
    return (name, "period") if name == "rate" else (name,)


def _list_timings(element: object, architecture: Architecture) -> list[Timing]:
    if isinstance(element, Node):
        return list(element.timing.values())
    if not isinstance(element, Component):
        return []
    # What a component's only node says of timing is compared as the component's own.
    node_timings = [node.timing.get(element.id) for node in architecture.nodes.values()]
    return [timing for timing in (element.timing, *node_timings) if timing]
