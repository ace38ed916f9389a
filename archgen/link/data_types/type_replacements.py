"""Find the types that replace deprecated ones."""

from __future__ import annotations

from dataclasses import replace

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.suggestions import find_closest
from archgen.link import mapping_values
from archgen.link.data_types.field_types import TypeSources
from archgen.link.data_types.generic_types import is_bound_name
from archgen.model.message_types import ConceptualType, full_message_name

_MAX_GUESSES = 200


def name_replacements(
    types: dict[str, ConceptualType], sources: TypeSources, diagnostics: list[Diagnostic]
) -> list[str]:
    """Give deprecated types the names of those that replace them, and return these; report names that nothing has."""
    found_names: list[str] = []
    guesses_left = _MAX_GUESSES
    for each in list(types.values()):
        deprecated = each.deprecated
        if deprecated is None or deprecated.use is None:
            continue
        name = mapping_values.normalise_type_name(deprecated.use)
        if _is_known(name, types, sources):
            types[each.name] = replace(each, deprecated=replace(deprecated, target=name))
            found_names.append(name)
        elif not sources.is_partial and name not in sources.lost_keys:
            guess = find_closest(name, (other for other in types if other != each.name)) if guesses_left > 0 else None
            guesses_left -= 1
            diagnostics.append(
                Diagnostic(
                    "unknown-reference",
                    f"no type named `{name}`",
                    deprecated.use_at,
                    help=f"did you mean `{guess}`?"
                    if guess
                    else f"declare it below `types`, as in `{name}: package/msg/Name`",
                    element=each.name,
                )
            )
    return found_names


def _is_known(name: str, types: dict[str, ConceptualType], sources: TypeSources) -> bool:
    return (
        name in types
        or name in sources.shipped_types
        or full_message_name(name) is not None
        or is_bound_name(name, types)
    )
