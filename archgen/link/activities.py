"""One timing for each activity of a node: what the node says and what its component says, laid together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from dataclasses import fields, replace

from archgen.diagnostic import Diagnostic, Label
from archgen.frozen import dataclass
from archgen.link import sense
from archgen.model.component import Component
from archgen.model.timing import Timing

_KEYS = tuple(f.name for f in fields(Timing) if f.name not in {"places", "at"})


@dataclass(frozen=True, slots=True)
class Activities:
    """Components that nodes implement. Those in `shared` have several nodes: what they say is a claim about the whole."""

    components: Mapping[str, Component]
    shared: Collection[str]
    found: list[Diagnostic]

    def of(self, node: str, written: Timing | None, implements: Collection[str]) -> dict[str, Timing]:
        """Give a node's timing by component."""
        if not implements:
            return {"": written} if written else {}
        made: dict[str, Timing] = {}
        for component in implements:
            claimed = None if component in self.shared else self.components[component].timing
            own = _restricted(written, component) if written and len(implements) > 1 else written
            timing = _both(node, own, claimed, self.found) if own and claimed else own or claimed
            if timing:
                made[component] = timing
        return made


def shared_components(implements: Iterable[Iterable[str]]) -> frozenset[str]:
    """Give the components that several nodes implement, from what each node implements."""
    counts = Counter(component for components in implements for component in components)
    return frozenset(component for component, count in counts.items() if count > 1)


def _restricted(timing: Timing, component: str) -> Timing:
    """Keep what concerns one component of a node that implements several."""
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
    """Lay a component's timing below its only node's; a key stands in one of them."""
    twice = [key for key in _KEYS if key in own.places and key in claimed.places]
    found += (_twice(node, key, own, claimed) for key in twice)
    missing = {key: getattr(claimed, key) for key in _KEYS if key not in own.places}
    merged = replace(own, **missing, places={**claimed.places, **own.places})
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
