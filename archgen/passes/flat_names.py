"""Names for components that stand directly in their groups once the components around them are gone."""

from __future__ import annotations

from collections.abc import Collection

from archgen.model.derived_names import derive_node_ids
from archgen.model.element_ids import MAX_ID_LENGTH, make_id, make_unique_id

_PLAIN_DEPTH = 2


def name_flat_components(
    component_ids: Collection[str], all_ids: Collection[str], used_names: Collection[str]
) -> dict[str, str]:
    """Return the complete ids that components get, by their complete ids now.

    What stands directly in its group keeps its name, unless that of another group has it, too: then the group's id is
    put before it. What stands deeper gets the shortest end of its path that is unique, joined by `_`; names are unique
    in the whole project, and none of `used_names` is among those that are made.
    """
    plain_ids = [each for each in component_ids if len(each.split(".")) == _PLAIN_DEPTH]
    deep_ids = [each for each in component_ids if len(each.split(".")) > _PLAIN_DEPTH]
    names = derive_node_ids(plain_ids, all_ids, ())
    taken_names = {*names.values(), *used_names}
    for component_id, name in derive_node_ids(deep_ids, all_ids, taken_names).items():
        short_name = name if len(name) <= MAX_ID_LENGTH else make_unique_id(make_id(name, "part"), taken_names)
        taken_names.add(short_name)
        names[component_id] = short_name
    return {each: f"{each.partition('.')[0]}.{names[each]}" for each in component_ids}
