"""Is what outputs promise kept by what follows from the figures of timing?"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import NO_SPAN
from archgen.model.relied_outputs import list_described_outputs
from archgen.timing.chains.read_ages import find_sent_ages
from archgen.timing.figures.figure_wording import format_duration, format_rate
from archgen.timing.figures.value_arithmetic import add_values, is_boundless, is_known_bound, smallest_value
from archgen.timing.system import activity_builder

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from fractions import Fraction

    from archgen.diagnostics.source_span import Span
    from archgen.model.architecture import Architecture
    from archgen.model.promise import Promise
    from archgen.timing.analysis import Analysis, EventPace
    from archgen.timing.figures.timing_values import TimingValue
    from archgen.timing.system.timing_system import Arc


_NOUNS = {"rate": "", "max_gap": "gaps of at most ", "max_age": "no greater age than "}


class _BrokenPromise(NamedTuple):
    """A promise that figures do not keep: its key, what follows instead, and where that is read."""

    key: str
    words: str
    help: str
    reader_at: Span = NO_SPAN


class BrokenPromise(NamedTuple):
    """A promise of an output that what is sent by a leaf (`leaf`, its output) does not keep, in words."""

    port: str
    leaf: str
    key: str
    promised: str
    words: str
    help: str
    at: Span
    reader_at: Span


def broken_promise(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """What follows from the figures of timing is worse than what an output promises."""
    told: set[tuple[str, str, Span]] = set()
    for broken in find_broken_promises(architecture, analysis):
        # What is passed on as it is promised inside is not told twice.
        if (broken.key, broken.leaf, broken.at) not in told:
            told.add((broken.key, broken.leaf, broken.at))
            yield _diagnose_broken(broken)


def find_broken_promises(architecture: Architecture, analysis: Analysis) -> Iterator[BrokenPromise]:
    """Yield what outputs promise and figures do not keep, leaves first."""
    promises = [
        (output, output.promise)
        for _, output in list_described_outputs(architecture)
        if output.promise and (output.promise.rate or output.promise.max_gap or output.promise.max_age)
    ]
    if not promises:
        return
    paces = _find_paces(architecture, analysis)
    leaves = {leaf for output, _ in promises for leaf in architecture.leaf_ports_of("output", output.id)}
    ages: dict[str, list[tuple[Arc, TimingValue]]] = defaultdict(list)
    for arc, age in find_sent_ages(analysis, leaves):
        ages[arc.output].append((arc, age))
    promises.sort(key=lambda promise: promise[0].id not in architecture.outputs)
    for output, promise in promises:
        for leaf in architecture.leaf_ports_of("output", output.id):
            for broken in _find_broken(promise, paces.get(leaf, ()), ages.get(leaf, ())):
                yield BrokenPromise(
                    output.id,
                    leaf,
                    broken.key,
                    f"{_NOUNS[broken.key]}{getattr(promise, broken.key)}",
                    broken.words,
                    broken.help,
                    promise.places.get(broken.key, promise.at),
                    broken.reader_at,
                )


def _find_paces(architecture: Architecture, analysis: Analysis) -> Mapping[str, Sequence[EventPace]]:
    """Return how often something is sent at each output, by its nodes."""
    activity_names = activity_builder.name_activities(architecture)
    paces: dict[str, list[EventPace]] = defaultdict(list)
    for endpoint in architecture.endpoints:
        if endpoint.use == "publishes" and endpoint.port:
            activity = activity_builder.activity_of_endpoint(activity_names, endpoint)
            pace = analysis.outputs.get((activity, activity_builder.endpoint_key(endpoint)))
            if pace is not None:
                paces[endpoint.port].append(pace)
    return paces


def _find_broken(
    promise: Promise, paces: Sequence[EventPace], ages: Sequence[tuple[Arc, TimingValue]]
) -> Iterator[_BrokenPromise]:
    if paces and promise.rate is not None:
        rate = add_values(pace.rate for pace in paces)
        is_limit = rate.side == "at most" or (rate.side == "exact" and rate.complete)
        if all(pace.behaviour == "once" for pace in paces):
            yield _BrokenPromise("rate", "it is sent once", "let it be sent again and again, or promise no rate")
        elif rate.value is not None and is_limit and rate.value < promise.rate.value:
            side = "at most " if rate.side == "at most" else ""
            words = f"{side}{format_rate(rate.value)} follows from the timing"
            yield _BrokenPromise("rate", words, "let it be sent more often, or promise a lower rate")
    if paces and promise.max_gap is not None:
        gap = smallest_value(pace.gap for pace in paces)
        gap_words = _describe_excess(gap, promise.max_gap.value, "between two messages")
        if gap_words:
            yield _BrokenPromise(
                "max_gap", gap_words, "let it be sent more often and at each run, or promise a longer gap"
            )
    if promise.max_age is not None:
        worst: tuple[Arc, TimingValue] | None = None
        for arc, age in ages:
            if _describe_excess(age, promise.max_age.value, "") and (
                worst is None or _rank_value(age) > _rank_value(worst[1])
            ):
                worst = (arc, age)
        if worst:
            arc, age = worst
            words = _describe_excess(age, promise.max_age.value, f"where `{arc.target}` reads it") or ""
            help_line = "let it be sent more often, let it fire its reader, or promise a greater age"
            yield _BrokenPromise("max_age", words, help_line, arc.at)


def _rank_value(value: TimingValue) -> tuple[bool, object]:
    return (value.value is None, value.value or 0)


def _describe_excess(value: TimingValue, limit: Fraction, where: str) -> str | None:
    """Return in words that a duration (ns) may exceed a limit; None where it does not, or figures are missing."""
    place = f" {where}" if where else ""
    if value.value is not None and value.value > limit:
        return f"it may be {format_duration(value.value)}{place}"
    if is_boundless(value) or (
        value.value is None and not value.missing and not is_known_bound(value) and value.complete
    ):
        return f"there is no bound{place}"
    return None


def _diagnose_broken(broken: BrokenPromise) -> Diagnostic:
    labels = (Label(broken.reader_at, "read here"),) if broken.reader_at != NO_SPAN else ()
    return Diagnostic(
        "broken-promise",
        f"`{broken.port}` promises {broken.promised}: {broken.words}",
        broken.at,
        labels=labels,
        help=broken.help,
        element=broken.port.rpartition(".")[0],
    )


RULES = ((broken_promise, Severity.WARNING),)
