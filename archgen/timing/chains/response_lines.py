"""What the responses of an activity are made of, and how long what it only reads waits to be stored, line by line."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.timing.analysis import Analysis
from archgen.timing.chains.working_lines import ReasonLine, WorkingLines
from archgen.timing.figures import figure_wording
from archgen.timing.load.response_terms import ResponseTerms


def list_working_lines(analysis: Analysis, workings: ResponseTerms, name: str, depth: int) -> Iterator[ReasonLine]:
    """Explain what a response is made of, and the time of the longest run that ends with the activity."""
    lines = WorkingLines(analysis.system.tick)
    working = workings.find_response(name)
    if working is not None:
        yield from lines.explain_response(working, depth)
    run = workings.find_run(name)
    if run is not None:
        way, run_working = run
        time = figure_wording.format_duration((way.delay or 0) * analysis.system.tick)
        yield ReasonLine(
            depth - 1,
            f"{name}: at most {time} from the event on that enters the core, for the run {' > '.join(way.steps)}",
        )
        if run_working.window != (working.window if working else None) or run_working.terms != (
            working.terms if working else ()
        ):
            yield from lines.explain_response(run_working, depth)
        else:
            yield ReasonLine(depth, "the same work as above, and nothing is taken off")


def list_storing_lines(analysis: Analysis, workings: ResponseTerms, name: str, depth: int) -> Iterator[ReasonLine]:
    """Explain how long a message that an activity only reads may wait to be stored."""
    wait = analysis.storing_waits.get(name)
    if wait is None or not wait.value:
        return
    time = figure_wording.format_duration(wait.value)
    yield ReasonLine(
        depth,
        f"{name}: what it only reads may wait {time} to be stored, and is missed by an activation until then",
    )
    working = workings.find_storing_wait(name)
    if working is not None:
        yield from WorkingLines(analysis.system.tick).explain_response(working, depth + 1)
    else:
        yield ReasonLine(depth + 1, "as long as its thread or its cores may be busy with other work")
