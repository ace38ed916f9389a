"""The steps of a start-up as rows of plain texts, for `archgen list`."""

from __future__ import annotations

import shlex
from collections.abc import Iterator

from archgen.bringup.start_plan import make_start_plan
from archgen.views import start_phrases
from archgen.views.lookup import Lookup
from archgen.views.tables.start_table import list_shown_steps

START_COLUMNS = ("number", "id", "kind", "phase", "host", "command", "waits_for", "up_when", "state", "place")


def list_start_rows(lookup: Lookup) -> Iterator[tuple[str, ...]]:
    """Yield the shown steps of the start-up, with their numbers in the whole plan."""
    architecture = lookup.architecture
    for number, step in list_shown_steps(lookup, make_start_plan(architecture)):
        node = None if step.kind == "container" else architecture.nodes[step.id]
        place = architecture.containers[step.container or ""].at if node is None else node.at
        yield (
            str(number),
            step.id,
            step.kind,
            step.phase,
            step.host or "",
            shlex.join(step.command),
            ", ".join(dict.fromkeys(wait.awaited for wait in step.waits)),
            start_phrases.describe_ready(step),
            start_phrases.describe_lifecycle(step),
            str(place) if place.file else "",
        )
