"""Merge the timing of a node with that of its components: one timing for each activity (a component in a node)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from dataclasses import fields, replace

from archgen.diagnostic import Diagnostic, Label
from archgen.frozen import dataclass
from archgen.link import sense
from archgen.model.component import Component
from archgen.model.timing import Timing

# All keys of `timing` that people write; the other two fields of Timing are positions.
_KEYS = tuple(f.name for f in fields(Timing) if f.name not in {"places", "at"})


@dataclass(frozen=True, slots=True)
class Activities:
    """Merges the timing of nodes with that of their components, and appends findings to `diagnostics`.

    Components in `shared_components` have several nodes: their timing is a claim about all nodes together, and no node
    inherits it.
    """

    components: Mapping[str, Component]
    shared: Collection[str]
    found: list[Diagnostic]

    def of(self, node: str, written: Timing | None, implements: Collection[str]) -> dict[str, Timing]:
        """Return a node's timing by component; the key is "" for a node that implements nothing."""
        if not implements:
            return {"": written} if written else {}
        made: dict[str, Timing] = {}
        for component in implements:
            # 10 Hz of a component with two nodes is not 10 Hz of each of them.
            claimed = None if component in self.shared else self.components[component].timing
            # With one component every port belongs to it, and ports that could not be resolved stay as well.
            own = _restricted(written, component) if written and len(implements) > 1 else written
            timing = _both(node, own, claimed, self.found) if own and claimed else own or claimed
            if timing:
                made[component] = timing
        return made


def shared_components(implements: Iterable[Iterable[str]]) -> frozenset[str]:
    """Return the components that several nodes implement, from the components of each node."""
    counts = Counter(component for components in implements for component in components)
    return frozenset(component for component, count in counts.items() if count > 1)


def _restricted(timing: Timing, component: str) -> Timing:
    """Return a node's timing with only those triggers, outputs and calls that are ports of one of its components."""
    start = f"{component}."
    trigger = timing.trigger
    if trigger and trigger.inputs is not None:
        inputs = tuple(port for port in trigger.inputs if port.startswith(start))
        trigger = replace(trigger, inputs=inputs) if inputs else None
    return replace(
        timing,
        trigger=trigger,
        outputs={port: value for port, value in timing.outputs.items() if port.startswith(start)},
        calls={port: value for port, value in timing.calls.items() if port.startswith(start)},
    )


def _both(node: str, own: Timing, claimed: Timing, found: list[Diagnostic]) -> Timing:
    """Merge a component's timing with that of its only node; a key that both write is reported, the node's counts."""
    twice = [key for key in _KEYS if key in own.places and key in claimed.places]
    found += (_twice(node, key, own, claimed) for key in twice)
    # `places` holds the keys that were written: a key that was written as `{}` must not be filled in.
    missing = {key: getattr(claimed, key) for key in _KEYS if key not in own.places}
    merged = replace(own, **missing, places={**claimed.places, **own.places})
    # Each of the two made sense alone; together they may not: a rate here and a period there, for instance.
    return sense.sound(merged, node, found)


def _twice(node: str, key: str, own: Timing, claimed: Timing) -> Diagnostic:
    return Diagnostic(
        "conflicting-values",
        f"`{key}` is written at the node `{node}` and at the component that it implements",
        own.places[key],
        labels=(Label(claimed.places[key], "written here"),),
        help="keep one of them: a component with one node has one timing",
        element=node,
    )
