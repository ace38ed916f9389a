"""Does what outputs promise agree with what their types say, and is it enough for who reads them?"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, join_words
from archgen.model.architecture import Architecture
from archgen.model.component import Output
from archgen.model.component_nesting import ReliedOutput, list_described_outputs, list_relied_outputs
from archgen.model.known_interfaces import find_only_number, list_units
from archgen.model.promise import Promise, format_limit
from archgen.model.quantity import Quantity


def unpromised_freshness(architecture: Architecture) -> Iterator[Diagnostic]:
    """A reader needs fresher data than its source promises."""
    if not any(output.promise and output.promise.max_age for _, output in list_described_outputs(architecture)):
        return
    told: set[tuple[str, str]] = set()
    for counted in list_relied_outputs(architecture):
        promise, freshness = counted.port.promise, counted.reader.freshness
        if promise is None or promise.max_age is None or freshness is None:
            continue
        if promise.max_age.value > freshness.value and (counted.reader.id, counted.port.id) not in told:
            told.add((counted.reader.id, counted.port.id))
            yield _diagnose_freshness(counted, promise, promise.max_age, freshness)


def _diagnose_freshness(counted: ReliedOutput, promise: Promise, max_age: Quantity, freshness: Quantity) -> Diagnostic:
    reader, port = counted.reader, counted.port
    return Diagnostic(
        "unpromised-freshness",
        f"`{reader.id}` needs what is no older than {freshness}: `{port.id}` promises no more than {max_age}",
        reader.freshness_at if reader.freshness_at != NO_SPAN else reader.at,
        labels=(Label(promise.places.get("max_age", promise.at), "promised here"),),
        help="agree on one figure: a shorter `max_age` there, or a longer `freshness` here",
        element=reader.component,
    )


def contradictory_promise(architecture: Architecture) -> Iterator[Diagnostic]:
    """What an output promises of its data is not what its type says."""
    for component, output in list_described_outputs(architecture):
        promise = output.promise
        if promise is None:
            continue
        for key, message, help_line in _find_contradictions(architecture, output, promise):
            labels = [
                Label(each.at, f"the type `{each.name}`")
                for name in [output.type or ""]
                if (each := architecture.types.get(name)) and each.at.file
            ]
            yield Diagnostic(
                "contradictory-promise",
                message,
                promise.places.get(key, promise.at),
                labels=tuple(labels),
                help=help_line,
                element=component.id,
            )


def _find_contradictions(
    architecture: Architecture, output: Output, promise: Promise
) -> Iterator[tuple[str, str, str]]:
    """Yield the key of each promise that something else denies, what is wrong, and what to do."""
    carried_type = architecture.types.get(output.type or "")
    message = architecture.message_of(output)
    typed_frame = carried_type.frame if carried_type else None
    other_frame = output.frame or typed_frame
    if promise.frame is not None and other_frame is not None and promise.frame != other_frame:
        said_by = "itself says" if output.frame else f"its type `{output.type}` says"
        yield (
            "frame",
            f"`{output.id}` promises the frame `{promise.frame}`, and {said_by} `{other_frame}`",
            "write the frame once",
        )
    units = list_units(architecture.interfaces, message)
    if promise.unit is not None and units and promise.unit not in units:
        fields = join_words([f"`{unit}`" for unit in units], "and")
        yield (
            "unit",
            f"`{output.id}` promises `{promise.unit}`, and the fields of `{message}` are in {fields}",
            "name the unit of the fields",
        )
    number = find_only_number(architecture.interfaces, message) if promise.range is not None else None
    if promise.range is None or number is None:
        return
    for limit in promise.range:
        if not number.least <= limit <= number.greatest and abs(limit) != float("inf"):
            yield (
                "range",
                f"`{output.id}` promises values up to {format_limit(limit)}, and its only number `{number.name}` is a "
                f"`{number.type}`: {number.least} to {number.greatest}"
                if limit > number.greatest
                else f"`{output.id}` promises values from {format_limit(limit)} on, and its only number "
                f"`{number.name}` is a `{number.type}`: {number.least} to {number.greatest}",
                "promise what the field can hold, or give it another type",
            )
            return


RULES = ((unpromised_freshness, Severity.WARNING), (contradictory_promise, Severity.WARNING))
