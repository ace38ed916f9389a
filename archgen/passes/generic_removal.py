"""The pass that takes generic types away: a type of its own for each combination of types that they stand for."""

from __future__ import annotations

from archgen.passes.generic_components import specialise_components
from archgen.passes.generic_data_types import list_data_type_sections, specialise_data_types
from archgen.passes.pass_shape import Pass, PassWork
from archgen.passes.selector_rewriting import rename_by_key, rename_in_selectors
from archgen.passes.written_places import list_type_sections


def _remove_generics(work: PassWork) -> None:
    component_names = specialise_components(work)
    data_names = specialise_data_types(work)
    for key, new_names, sections in (
        ("is", component_names, list_type_sections(work.tree)),
        ("type", data_names, list_data_type_sections(work.tree)),
    ):
        known_names = [
            f"{section[1]}.{name}" if key == "is" and len(section) > 1 else name
            for section in sections
            for name in work.tree.get_mapping(section)
        ]
        if new_names:
            rename_in_selectors(work.tree, rename_by_key(key, new_names, known_names))


REMOVE_GENERICS = Pass(
    "remove_generics",
    "Writes `filter<Pose>` as `filter_of_pose` and `Envelope<Pose>` as `Envelope of Pose`; no generic type is left.",
    _remove_generics,
    leaves=("no_generics",),
)
