"""Report figures that are well-formed but impossible, such as a period of zero or a best case above the worst.

They are left out of the model: whatever would follow from an impossible figure is noise.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.link import mapping_values
from archgen.model.declared_timing import Timing
from archgen.model.quantity import Quantity
from archgen.syntax.yaml_tree import MappingNode, SequenceNode

_UNKNOWN_HELP = "leave it out where it is not known"


def drop_senseless(timing: Timing, element_id: str, diagnostics: list[Diagnostic]) -> Timing:
    """Report what makes no sense in a timing, and return the timing without it."""
    dropped_keys: dict[str, Any] = {}
    for key, finding in _find_senseless(timing, element_id):
        diagnostics.append(finding)
        dropped_keys[key] = None
    return replace(timing, **dropped_keys) if dropped_keys else timing


def read_positive(
    mapping: MappingNode, key: str, dimension: str, element_id: str, diagnostics: list[Diagnostic]
) -> Quantity | None:
    """Read a quantity that cannot be zero; None, and a diagnostic, if it is."""
    quantity = mapping_values.get_quantity(mapping, key, dimension)
    if quantity is None or quantity.value:
        return quantity
    diagnostics.append(
        _diagnose_senseless(f"`{key}` cannot be zero", mapping_values.get_span(mapping, key), _UNKNOWN_HELP, element_id)
    )
    return None


def report_empty_list(
    mapping: MappingNode, key: str, kind: str, element_id: str, diagnostics: list[Diagnostic]
) -> None:
    """Report an empty list where it has no meaning."""
    node = mapping.get(key)
    # Without a place: what was written there is reported already.
    if isinstance(node, SequenceNode) and not node.items and node.span != NO_SPAN:
        diagnostics.append(
            _diagnose_senseless(
                f"`{key}` names no {kind}", node.span, f"name one or more, or leave `{key}` out", element_id
            )
        )


def read_latency(
    mapping: MappingNode, element_id: str, diagnostics: list[Diagnostic]
) -> tuple[Quantity | None, Quantity | None]:
    """Read the best and the worst latency of a link; the best is None, and reported, if it is above the worst."""
    best, worst = (
        mapping_values.get_quantity(mapping, "best", "duration"),
        mapping_values.get_quantity(mapping, "worst", "duration"),
    )
    if best is None or worst is None or best.value <= worst.value:
        return best, worst
    label = Label(mapping_values.get_span(mapping, "worst"), "the worst")
    message = f"the best latency ({best}) is above the worst ({worst})"
    diagnostics.append(
        _diagnose_senseless(message, mapping_values.get_span(mapping, "best"), "exchange them", element_id, label)
    )
    return None, worst


def _find_senseless(timing: Timing, element_id: str) -> Iterator[tuple[str, Diagnostic]]:
    """Yield what makes no sense in a timing: the key to leave out, and the diagnostic that says why."""
    spans = timing.places
    for key, quantity in (("period", timing.period), ("rate", timing.rate)):
        if quantity is not None and quantity.value == 0:
            yield key, _diagnose_senseless(f"a {key} cannot be zero", spans[key], _UNKNOWN_HELP, element_id)
    # Of two figures that contradict each other one is dropped: the rate here, the best case below.
    if timing.period is not None and timing.rate is not None:
        label = Label(spans["period"], "the period")
        help_line = "write one of them: each follows from the other"
        yield (
            "rate",
            _diagnose_senseless("`rate` and `period` are both written", spans["rate"], help_line, element_id, label),
        )
    if timing.bcet is not None and timing.wcet is not None and timing.bcet.value > timing.wcet.value:
        label = Label(spans["wcet"], "the worst case")
        message = f"the best case execution time (`bcet`, {timing.bcet}) is above the worst (`wcet`, {timing.wcet})"
        yield (
            "bcet",
            _diagnose_senseless(message, spans["bcet"], "exchange them, or leave `bcet` out", element_id, label),
        )
    if timing.every is not None and timing.every < 1:
        yield (
            "every",
            _diagnose_senseless(
                "`every` is 1 or more", spans["every"], "`every: 3` fires at each third input", element_id
            ),
        )


def _diagnose_senseless(message: str, span: Span, help_line: str, element_id: str, *labels: Label) -> Diagnostic:
    return Diagnostic("wrong-value", message, span, labels=labels, help=help_line, element=element_id)
