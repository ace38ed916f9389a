"""The pass that takes generic types away: a type of its own for each combination of types that they stand for."""

from __future__ import annotations

from archgen.passes.generic_components import specialise_components
from archgen.passes.generic_data_types import specialise_data_types
from archgen.passes.pass_shape import Pass, PassWork


def _remove_generics(work: PassWork) -> None:
    specialise_components(work)
    specialise_data_types(work)


REMOVE_GENERICS = Pass(
    "remove_generics",
    "Writes `filter<Pose>` as `filter_of_pose` and `Envelope<Pose>` as `Envelope of Pose`; no generic type is left.",
    _remove_generics,
    leaves=("no_generics",),
)
