"""Who relies on an element: who reads from it, at once and in the end, who waits for its start, and which milestone needs it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture, Milestone
from archgen.model.component import Component
from archgen.model.latest_result import remember_latest
from archgen.model.node import Node
from archgen.model.selector_evaluation import list_needs
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Inlines, Text


def list_reliance(lookup: Lookup, element: Node | Component, max_names: int = 8) -> Iterator[Inlines]:
    """Yield who reads from an element, and who reads from those; who can do without it, and who waits for its start."""
    architecture = lookup.architecture
    components = architecture.components
    own, nodes = (
        (element.implements, ())
        if isinstance(element, Node)
        else (architecture.leaves_of(element.id), lookup.nodes_inside(element.id))
    )
    started = {element.id, *own, *(node.id for node in nodes)}
    direct = list(lookup.reach.find_fed(own, 1))
    # Of all the others only those that are named are looked for.
    fed = lookup.reach.find_fed(own, len(direct) + max_names)
    inputs = [
        architecture.inputs[connection.input]
        for name in own
        for output in components[name].outputs.values()
        for connection in lookup.readers_of.get(output.id, ())
    ]
    needing = {port.component for port in inputs if not port.optional}
    free = dict.fromkeys(port.component for port in inputs if port.component in fed)
    waiting = {node.id for each in started for node in lookup.awaiting.get(each, ())}
    groups = (
        ("Read from it", direct, 0),
        (
            "Read from those",
            [name for name, steps in fed.items() if steps > 1],
            lookup.reach.count_fed(own) - len(fed),
        ),
        ("Can do without it", [name for name in free if name not in needing], 0),
        ("Wait for it at the start", [name for name in architecture.nodes if name in waiting] if waiting else [], 0),
    )
    for words, names, unlisted in groups:
        count = len(names) + unlisted
        # Of a thousand only those that are named need a link.
        links = [
            (
                inline_text.component_link(components[each])
                if each in components
                else Text(each, f"node:{each}", code=True),
            )
            for each in names[:max_names]
        ]
        more = f" and {count - max_names} more" if count > max_names else ""
        if names:
            yield inline_text.to_inlines(f"{words} ({count}): ", *inline_text.join_inlines(links), more)
    milestones_by_component = _index_milestones(architecture)
    needing_milestones = {each.id: each for name in own for each in milestones_by_component.get(name, ())}
    for milestone in needing_milestones.values():
        day = f" on {milestone.date}" if milestone.date else ""
        yield (Text("Needed for "), Text(milestone.title, f"milestone:{milestone.id}"), Text(day))
    if fed:
        command = " ".join(("archgen impact", *(f"--component {name}" for name in own)))
        yield (Text(command, code=True), Text(" says which deadlines, use cases and requirements rest on it"))


@remember_latest
def _index_milestones(architecture: Architecture) -> Mapping[str, Sequence[Milestone]]:
    """Return the milestones that need each component, by their days."""
    return group_pairs((name, needs.milestone) for needs in list_needs(architecture) for name in needs.components)
