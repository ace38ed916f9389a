"""Make the rows of composed components: what is around and directly inside of each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.model.component import Component
from archgen.model.component_nesting import list_surrounding
from archgen.views.explorer.column_layout import Place
from archgen.views.explorer.element_keys import Key, list_composed_keys
from archgen.views.explorer.map_places import Path
from archgen.views.explorer.map_shapes import Row, list_path, list_places, shorten_description
from archgen.views.graphs.element_boxes import type_lines, worst_severity
from archgen.views.lookup import Lookup


def make_composed_rows(
    lookup: Lookup,
    shells: Sequence[Component],
    component_numbers: Mapping[str, int],
    key_numbers: Mapping[Key, int],
    places: Mapping[Path, Place],
) -> tuple[Row, ...]:
    """Make the rows of composed components; the look-ups are the positions of components and keys in their tables."""
    architecture = lookup.architecture
    shell_numbers = {shell.id: number for number, shell in enumerate(shells)}
    group_numbers = {group: number for number, group in enumerate(lookup.shown_groups())}
    leaves: dict[str, list[int]] = {shell.id: [] for shell in shells}
    for component_id, number in component_numbers.items() if shells else ():
        around = list_path(architecture, architecture.components[component_id])[-2]
        if around in leaves:
            leaves[around].append(number)
    return tuple(
        (
            f"component:{shell.id}",
            shell.id,
            shell.title,
            group_numbers[shell.group],
            shell_numbers.get(shell.parent or "", -1),
            tuple(leaves[shell.id]),
            "".join(type_lines(lookup, shell)),
            shorten_description(shell.functionality, shell.description),
            tuple(key_numbers[key] for key in list_composed_keys(architecture, shell)),
            worst_severity(lookup, shell.id) or "",
            places[shell.group, *list_surrounding(architecture, shell.id), shell.id],
            list_places(lookup, shell.at),
        )
        for shell in shells
    )
