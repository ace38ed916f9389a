"""What readers of an output should know before they count on it: it is going away, or its promise is not kept."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.model.component import Output
from archgen.views.lookup import Lookup


def warn_of_outputs(lookup: Lookup, outputs: Iterable[Output]) -> str:
    """Return a few words beside what outputs send: `deprecated, promise not kept`; empty where all is well."""
    kept_outputs = tuple(outputs)
    words = []
    if any(output.deprecated for output in kept_outputs):
        words.append("deprecated")
    if any(_breaks_promise(lookup, output) for output in kept_outputs):
        words.append("promise not kept")
    return ", ".join(words)


def _breaks_promise(lookup: Lookup, output: Output) -> bool:
    if output.promise is None:
        return False
    # The finding stands at what is promised: its element is the component, which may promise other things, too.
    places = {output.promise.at, *output.promise.places.values()}
    findings = lookup.findings_of.get(output.component, ())
    return any(finding.rule == "broken-promise" and finding.span in places for finding in findings)
