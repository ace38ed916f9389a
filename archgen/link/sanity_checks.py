"""Report figures that are well-formed but impossible, such as a period of zero or a best case above the worst.

They are left out of the model: whatever would follow from an impossible figure is noise.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from itertools import pairwise
from typing import Any

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Span
from archgen.frozen import replace
from archgen.link import mapping_values
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.declared_timing import Timing
from archgen.model.quantity import Quantity
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, SequenceNode

_UNKNOWN_HELP = "leave it out where it is not known"


def drop_senseless(timing: Timing, element_id: str, diagnostics: list[Diagnostic]) -> Timing:
    """Report what makes no sense in a timing, and return the timing without it."""
    dropped_keys: dict[str, Any] = {}
    for key, message, help_line, *labels in _find_senseless(timing):
        diagnostics.append(_diagnose_senseless(message, timing.places[key], help_line, element_id, *labels))
        dropped_keys[key] = None
    return replace(timing, **dropped_keys) if dropped_keys else timing


def read_positive(
    mapping: MappingNode, key: str, dimension: str, element_id: str, diagnostics: list[Diagnostic]
) -> Quantity | None:
    """Read a quantity that cannot be zero; None, and a diagnostic, if it is."""
    quantity = mapping_values.get_quantity(mapping, key, dimension)
    if quantity is None or quantity.value:
        return quantity
    message = f"`{key}` cannot be zero"
    diagnostics.append(_diagnose_senseless(message, (mapping, key), _UNKNOWN_HELP, element_id))
    return None


def report_empty_list(
    mapping: MappingNode, key: str, kind: str, element_id: str, diagnostics: list[Diagnostic]
) -> None:
    """Report an empty list where it has no meaning."""
    node = mapping.get(key)
    # Without a place: what was written there is reported already.
    if isinstance(node, SequenceNode) and not node.items and node.span != NO_SPAN:
        message, help_line = f"`{key}` names no {kind}", f"name one or more, or leave `{key}` out"
        diagnostics.append(_diagnose_senseless(message, node.span, help_line, element_id))


def report_exchanged(
    mapping: MappingNode,
    smaller: tuple[str, Quantity | None],
    larger: tuple[str, Quantity | None],
    element_id: str,
    diagnostics: list[Diagnostic],
) -> bool:
    """Report two durations (each with its key) of which the one that should be smaller is larger; whether it is."""
    (small_key, small_quantity), (large_key, large_quantity) = smaller, larger
    if small_quantity is None or large_quantity is None or small_quantity.value <= large_quantity.value:
        return False
    label = Label(mapping_values.get_span(mapping, large_key), f"`{large_key}`")
    message = f"`{small_key}` ({small_quantity}) is above `{large_key}` ({large_quantity})"
    help_line = f"exchange them, or leave `{small_key}` out"
    diagnostics.append(_diagnose_senseless(message, (mapping, small_key), help_line, element_id, label))
    return True


def report_times_of_none(input_body: MappingNode, element_id: str, diagnostics: list[Diagnostic]) -> bool:
    """Report execution times of a callback that there is not, as the input is stored at once; whether there are any."""
    key = next((key for key in ("wcet", "bcet") if input_body.get(key) is not None), None)
    if key is None:
        return False
    message = f"`{key}` is the time of a callback that stores the input, and `stored: at_once` says that there is none"
    label = Label(mapping_values.get_span(input_body, "stored"), "nothing has to be run")
    diagnostics.append(_diagnose_senseless(message, (input_body, key), "leave one of them out", element_id, label))
    return True


def report_falling_percentiles(
    wcet_body: MappingNode,
    percentiles: Mapping[str, Quantity],
    longest: Quantity | None,
    element_id: str,
    diagnostics: list[Diagnostic],
) -> bool:
    """Report the first percentile that is above a higher one, or above the longest time; whether there is one."""
    rising = [*percentiles.items(), ("max", longest)]
    return any(
        report_exchanged(wcet_body, smaller, larger, element_id, diagnostics) for smaller, larger in pairwise(rising)
    )


def report_missing_maximum(entry: MappingEntry, element_id: str, diagnostics: list[Diagnostic]) -> None:
    """Report a resource of which only the shortest use is written."""
    if mapping_values.get_body(entry).entries:
        message, help_line = f"`{entry.key}` has no `max`", f"write how long it is used at most: `{entry.key}: 12 ms`"
        diagnostics.append(_diagnose_senseless(message, entry.key_span, help_line, element_id))


def report_rate_of_static(frame_body: MappingNode, element_id: str, diagnostics: list[Diagnostic]) -> None:
    """Report how often a frame is written that never moves."""
    label = Label(mapping_values.get_span(frame_body, "static"), "it never moves")
    message, help_line = "`rate` of a static frame: it is written once", "take one of `rate` and `static` out"
    diagnostics.append(_diagnose_senseless(message, (frame_body, "rate"), help_line, element_id, label))


def report_mixed_trigger(trigger_body: MappingNode, element_id: str, diagnostics: list[Diagnostic]) -> None:
    """Report keys of a trigger that have no meaning beside `all`."""
    if trigger_body.get("all") is None:
        return
    label = Label(mapping_values.get_span(trigger_body, "all"), "waits for all of these, whatever their time")
    for key in ("match", "within"):
        if trigger_body.get(key) is not None:
            message = f"`{key}` has no effect beside `all`"
            help_line = "write either `{all: [...]}`, or `{match: [...], within: 30 ms}`"
            diagnostics.append(_diagnose_senseless(message, (trigger_body, key), help_line, element_id, label))


def report_repetition(mapping: MappingNode, key: str, element_id: str, diagnostics: list[Diagnostic]) -> None:
    """Report the first entry of a list that is written a second time."""
    first_spans: dict[str, Span] = {}
    for scalar in mapping_values.get_scalars(mapping, key):
        if scalar.text in first_spans:
            help_line = "take one of them out, or name what was meant"
            label = Label(first_spans[scalar.text], "first written here")
            message = f"`{key}` names `{scalar.text}` twice"
            diagnostics.append(_diagnose_senseless(message, scalar.span, help_line, element_id, label))
            return
        first_spans[scalar.text] = scalar.span


def report_lonely_within(trigger_body: MappingNode, element_id: str, diagnostics: list[Diagnostic]) -> None:
    """Report a `within` of a trigger that names no inputs."""
    if trigger_body.get("within") is not None and trigger_body.entries.keys() == {"within"}:
        help_line = "name the inputs that it fires for: `{match: [image, cloud], within: 30 ms}`"
        place = (trigger_body, "within")
        diagnostics.append(_diagnose_senseless("`within` needs `match`", place, help_line, element_id))


def check_match(  # noqa: PLR0913 - what a match consists of
    trigger_body: MappingNode,
    inputs: Collection[str],
    within: Quantity | None,
    element_id: str,
    diagnostics: list[Diagnostic],
    *,
    is_damaged: bool = False,
) -> bool:
    """Whether a `match` is complete: two inputs or more of each component, and `within`; else it is reported.

    Of a damaged element `within` may be what could not be read: that is reported already.
    """
    place = (trigger_body, "match")
    # What could not be resolved is reported, and may be the second one.
    has_unresolved = len(mapping_values.get_texts(trigger_body, "match")) > len(inputs)
    counts = Counter(port.rpartition(".")[0] for port in inputs)
    if min(counts.values()) < 2 and not has_unresolved:  # noqa: PLR2004
        message = "`match` names one input only" if len(inputs) == 1 else "`match` names one input only of a component"
        help_line = "name two or more inputs of one component; one input alone is `trigger: [input]`"
        diagnostics.append(_diagnose_senseless(message, place, help_line, element_id))
        return False
    if within is None and not is_damaged:
        message = "`match` needs `within`: how far apart the times of matched messages may be"
        help_line = "write `within: 30 ms` beside it; `within: 0 ms` matches the same time only"
        diagnostics.append(_diagnose_senseless(message, place, help_line, element_id))
    return within is not None and min(counts.values()) > 1


def read_latency(
    link_body: MappingNode, key: str, link_id: str, resolver: ReferenceResolver
) -> tuple[Quantity | None, Quantity | None]:
    """Read the best and the worst latency of a link; the best is None, and reported, if it is above the worst."""
    mapping = mapping_values.get_mapping(link_body, key)
    best, worst = (
        mapping_values.get_quantity(mapping, "best", "duration"),
        mapping_values.get_quantity(mapping, "worst", "duration"),
    )
    if best is None or worst is None or best.value <= worst.value:
        return best, worst
    label = Label(mapping_values.get_span(mapping, "worst"), "the worst")
    message = f"the best latency ({best}) is above the worst ({worst})"
    resolver.diagnostics.append(_diagnose_senseless(message, (mapping, "best"), "exchange them", link_id, label))
    return None, worst


def _find_senseless(timing: Timing) -> Iterator[tuple[str, str, str, *tuple[Label, ...]]]:
    """Yield what makes no sense in a timing: the key to leave out, why, what to do, and labels."""
    spans = timing.places
    for key, quantity in (("period", timing.period), ("rate", timing.rate)):
        if quantity is not None and quantity.value == 0:
            yield key, f"a {key} cannot be zero", _UNKNOWN_HELP
    # Of two figures that contradict each other one is dropped: the rate here, the best case below.
    if timing.period is not None and timing.rate is not None:
        label = Label(spans["period"], "the period")
        help_line = "write one of them: each follows from the other"
        yield "rate", "`rate` and `period` are both written", help_line, label
    if timing.bcet is not None and timing.wcet is not None and timing.bcet.value > timing.wcet.value:
        label = Label(spans["wcet"], "the worst case")
        message = f"the best case execution time (`bcet`, {timing.bcet}) is above the worst (`wcet`, {timing.wcet})"
        yield "bcet", message, "exchange them, or leave `bcet` out", label
    if timing.core is not None and timing.cores is not None:
        label = Label(spans["core"], "one core")
        help_line = "write one of them: `core: 3` is `cores: [3]`"
        yield "cores", "`core` and `cores` are both written", help_line, label
    if timing.every is not None and timing.every < 1:
        yield "every", "`every` is 1 or more", "`every: 3` fires at each third input"


def _diagnose_senseless(
    message: str, place: Span | tuple[MappingNode, str], help_line: str, element_id: str, *labels: Label
) -> Diagnostic:
    """Return what is wrong at a place, which may be the value of a key."""
    span = place if isinstance(place, Span) else mapping_values.get_span(*place)
    return Diagnostic("wrong-value", message, span, labels=labels, help=help_line, element=element_id)
