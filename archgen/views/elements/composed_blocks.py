"""Composed components in documents: what they are for, their ports, and what is inside."""

from __future__ import annotations

from collections.abc import Collection

from archgen.model.component import Component
from archgen.views.elements import functional_level, port_tables
from archgen.views.elements.annotation_facts import make_image_blocks
from archgen.views.elements.parameter_blocks import make_parameter_blocks
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Figure, Markdown, show_facts


def make_composed_blocks(lookup: Lookup, shell: Component, without: Collection[str] = ()) -> tuple[Block, ...]:
    """Describe a composed component: facts without those of some keys, what it does, its picture, its ports, and the
    components directly inside.
    """
    blocks: list[Block] = [
        show_facts(functional_level.list_component_facts(lookup, shell), without),
        functional_level.make_functionality_block(shell),
        *make_image_blocks(lookup, shell),
    ]
    blocks += [Markdown(shell.description)] if shell.description else []
    blocks.append(
        Figure(
            f"figure:composed/{shell.id}",
            f"composed/{shell.id}",
            f"{shell.title}: what is inside",
            f"{shell.title} as a frame with its ports at the rim and its components inside.",
        )
    )
    blocks += functional_level.make_requirement_blocks(lookup, shell) if shell.requirements else []
    blocks += functional_level.make_performance_blocks(shell) if shell.performance else []
    blocks += port_tables.make_port_blocks(lookup, shell)
    blocks += make_parameter_blocks(shell)
    children = lookup.shown_children(shell)
    if children:
        caption = f"Components of {shell.title}"
        blocks.append(functional_level.make_component_table(lookup, f"table:components/{shell.id}", caption, children))
    return tuple(blocks)
