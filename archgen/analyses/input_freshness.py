"""Is what is read at an input as fresh as its reader needs it?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import NO_SPAN
from archgen.timing.chains.read_ages import ReadAge, find_read_ages
from archgen.timing.figures import figure_wording
from archgen.timing.figures.value_arithmetic import is_boundless, is_known_bound, is_unfound

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.timing.analysis import Analysis


def stale_input(_: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """What an element reads at an input may be older than the input's `freshness` allows."""
    for read_age in find_read_ages(analysis):
        if read_age.state == "broken":
            yield _report_age(analysis, read_age)


def _report_age(analysis: Analysis, read_age: ReadAge) -> Diagnostic:
    arc, age = read_age.arc, read_age.age
    reader, source = analysis.system.activities[arc.target], analysis.system.activities[arc.source]
    port = arc.input.rpartition(".")[2]
    limit_text = figure_wording.format_duration(read_age.limit)
    if is_boundless(age):
        age_text = f"is sent once or need not come at all, so that it may be of any age at `{reader.id}`"
    elif is_unfound(age) or age.value is None or not is_known_bound(age):
        age_text = f"may be of any age at `{reader.id}`, for no bound was found"
    else:
        age_text = f"may be {figure_wording.format_duration(age.value)} old when `{reader.id}` reads it"
    return Diagnostic(
        "stale-input",
        f"what `{source.id}` sends to `{port}` {age_text}: its freshness is {limit_text}",
        arc.at if arc.at != NO_SPAN else reader.at,
        labels=(Label(source.at, f"`{source.id}` sends it"),) if source.at != NO_SPAN else (),
        help="let the source send more often, or let what it sends fire the reader",
        element=reader.id,
    )


RULES = ((stale_input, Severity.WARNING),)
