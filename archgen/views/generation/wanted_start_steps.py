"""The steps of a start-up that belong to the part of the architecture that is generated for."""

from __future__ import annotations

from archgen.bringup.plan_shapes import StartPlan
from archgen.views.generation.generation_context import GenerationContext


def find_wanted_steps(plan: StartPlan, context: GenerationContext) -> frozenset[str]:
    """Return the steps of the wanted nodes, and those of the containers that load them."""
    nodes = context.wanted_nodes
    loading_containers = {node.container for node in nodes.values()}
    return frozenset(
        step.id
        for step in plan.steps
        if (
            step.container in loading_containers or (context.components is None and context.host in {None, step.host})
            if step.kind == "container"
            else step.id in nodes
        )
    )
