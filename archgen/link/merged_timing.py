"""Merge the timing of a node with that of its components: one timing for each activity (a component in a node)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping

from archgen.diagnostics import Diagnostic, Label
from archgen.frozen import dataclass, fields, replace
from archgen.link import sanity_checks
from archgen.model.component import Component
from archgen.model.declared_timing import Timing

# All keys of `timing` that people write, with the fields of Timing that hold their values; two fields are positions.
_FIELDS_OF_KEY = {
    **{f.name: (f.name,) for f in fields(Timing) if f.name not in {"places", "at", "measured_times"}},
    "wcet": ("wcet", "measured_times"),
}


@dataclass(frozen=True, slots=True)
class TimingMerger:
    """Merges the timing of nodes with that of their components, and appends findings to `diagnostics`.

    Components in `shared_components` have several nodes: their timing is a claim about all nodes together, and no node
    inherits it.
    """

    components: Mapping[str, Component]
    shared_components: Collection[str]
    diagnostics: list[Diagnostic]

    def merge_timing(
        self, node_id: str, written_timing: Timing | None, implements: Collection[str]
    ) -> dict[str, Timing]:
        """Return a node's timing by component; the key is "" for a node that implements nothing."""
        if not implements:
            return {"": written_timing} if written_timing else {}
        timings: dict[str, Timing] = {}
        for component in implements:
            # 10 Hz of a component with two nodes is not 10 Hz of each of them.
            component_timing = None if component in self.shared_components else self.components[component].timing
            # With one component every port belongs to it, and ports that could not be resolved stay as well.
            node_timing = (
                _restrict_timing(written_timing, component)
                if written_timing and len(implements) > 1
                else written_timing
            )
            timing = (
                _merge_over_component(node_id, node_timing, component_timing, self.diagnostics)
                if node_timing and component_timing
                else node_timing or component_timing
            )
            if timing:
                timings[component] = timing
        return timings


def find_shared_components(implements: Iterable[Iterable[str]]) -> frozenset[str]:
    """Return the components that several nodes implement, from the components of each node."""
    counts = Counter(component for components in implements for component in components)
    return frozenset(component for component, count in counts.items() if count > 1)


def _restrict_timing(timing: Timing, component: str) -> Timing:
    """Return a node's timing with only those triggers, inputs, outputs and calls that are ports of one of its components."""
    prefix = f"{component}."
    trigger = timing.trigger
    if trigger and trigger.inputs is not None:
        inputs = tuple(port for port in trigger.inputs if port.startswith(prefix))
        trigger = replace(trigger, inputs=inputs) if inputs else None
    return replace(
        timing,
        trigger=trigger,
        inputs={port: value for port, value in timing.inputs.items() if port.startswith(prefix)},
        outputs={port: value for port, value in timing.outputs.items() if port.startswith(prefix)},
        calls={port: value for port, value in timing.calls.items() if port.startswith(prefix)},
    )


def _merge_over_component(
    node_id: str, node_timing: Timing, component_timing: Timing, diagnostics: list[Diagnostic]
) -> Timing:
    """Merge a component's timing with that of its only node; a key that both write is reported, the node's counts."""
    doubled_keys = [key for key in _FIELDS_OF_KEY if key in node_timing.places and key in component_timing.places]
    diagnostics += (_diagnose_doubled_key(node_id, key, node_timing, component_timing) for key in doubled_keys)
    # `places` holds the keys that were written: a key that was written as `{}` must not be filled in.
    missing_values = {
        name: getattr(component_timing, name)
        for key, names in _FIELDS_OF_KEY.items()
        if key not in node_timing.places
        for name in names
    }
    merged = replace(node_timing, **missing_values, places={**component_timing.places, **node_timing.places})
    # Each of the two made sense alone; together they may not: a rate here and a period there, for instance.
    return sanity_checks.drop_senseless(merged, node_id, diagnostics)


def _diagnose_doubled_key(node_id: str, key: str, node_timing: Timing, component_timing: Timing) -> Diagnostic:
    return Diagnostic(
        "conflicting-values",
        f"`{key}` is written at the node `{node_id}` and at the component that it implements",
        node_timing.places[key],
        labels=(Label(component_timing.places[key], "written here"),),
        help="keep one of them: a component with one node has one timing",
        element=node_id,
    )
