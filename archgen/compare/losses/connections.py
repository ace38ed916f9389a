"""Connections that a partner loses because the output was removed or has another id than the one it reads."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from archgen.compare.losses.both import Both, Loss, several


def connections(both: Both) -> Iterator[Loss]:
    """Find outputs that were removed or renamed while a partner read them. A reader that turns away by itself loses
    nothing.
    """
    for output, readers in sorted(both.told.old.readers.items()):
        now = both.told.new.readers.get(output, frozenset())
        if readers <= now or ("output", output) not in both.told.before or both.told.unknown(("output", output)):
            continue
        places = because(both, output)
        if not places:
            continue
        lost: dict[str, list[str]] = defaultdict(list)
        for reader in readers - now:
            partner = both.owner("input", reader)
            if partner and partner not in both.keepers("output", output) and both.needs(reader):
                lost[partner].append(reader)
        for partner, inputs in sorted(lost.items()):
            yield from both.losses(places, partner, _why(both, output, inputs, partner))


def because(both: Both, output: str) -> list[int]:
    """Return the indices of the changes that removed an output, or renamed it."""
    if ("output", output) not in both.told.after:
        return both.of_kind("output", output, "removed")
    component = output.rpartition(".")[0]
    group = component.partition(".")[0]
    names = (("output", output), ("component", component), ("group", group))
    return [place for sort, name in names for place in both.of_kind(sort, name, "renamed", "moved")][:1]


def _why(both: Both, output: str, inputs: list[str], partner: str) -> str:
    as_what = several(inputs)
    was = f"`{both.own('output', output)}`"
    if ("output", output) in both.told.after:
        return f"takes {was} from {partner}, who still reads it under that name as {as_what}"
    there = {source for name in inputs for source in both.told.new.sources.get(name, ())}
    others = {source for source in there if ("output", source) in both.told.after}
    gained = others - {source for name in inputs for source in both.told.old.sources.get(name, ())}
    instead = f" (and is to read {several(gained)} instead)" if gained else ""
    return f"takes {was} from {partner}, who reads it as {as_what}{instead}"
