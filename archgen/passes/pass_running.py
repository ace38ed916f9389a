"""Run passes one after the other, each with those before it that it needs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.diagnostics import Diagnostic, did_you_mean
from archgen.diagnostics.element_origins import Origin, TreePath
from archgen.frozen import dataclass
from archgen.model.known_interfaces import Interfaces
from archgen.passes.connection_passes import (
    COMPLETE_NAMES,
    CONNECT_COMPONENTS,
    CONNECT_PORTS,
    CONNECT_TYPES,
    NORMALISE_CONNECTIONS,
    RESOLVE_INSTANCES,
)
from archgen.passes.enveloping import ENVELOPE
from archgen.passes.flattening import FLATTEN
from archgen.passes.generic_removal import REMOVE_GENERICS
from archgen.passes.monitoring import MONITOR
from archgen.passes.pass_shape import Pass, PassWork
from archgen.passes.project_tree import ProjectTree
from archgen.project import LoadedProject
from archgen.syntax.yaml_tree import MappingNode

_ALL_PASSES = (
    *(COMPLETE_NAMES, NORMALISE_CONNECTIONS, CONNECT_COMPONENTS, CONNECT_PORTS, CONNECT_TYPES, RESOLVE_INSTANCES),
    *(ENVELOPE, REMOVE_GENERICS, FLATTEN, MONITOR),
)
PASSES: dict[str, Pass] = {each.name: each for each in _ALL_PASSES}
"""The passes by name."""


@dataclass(frozen=True, slots=True)
class TransformedProject:
    """What passes made of a project: its tree, what everything in it was made from, and what was found on the way."""

    root: MappingNode
    provenance: Mapping[TreePath, Origin]
    """The origins of what was made, by path; what is inside of it was made with it, unless it is named itself."""
    findings: tuple[Diagnostic, ...]
    passes: tuple[str, ...]
    """The passes that ran, in order, those included that others needed."""
    is_changed: bool = True
    """Whether the last run wrote or dropped anything."""


class UnknownPassError(Exception):
    """A pass is asked for that there is not."""

    def __init__(self, name: str, known_names: Sequence[str]) -> None:
        help_line = did_you_mean(name, known_names) or "`archgen transform --list` shows all"
        super().__init__(f"no pass named `{name}`: {help_line}")


def run_passes(  # noqa: PLR0913, PLR0917 - what passes work with
    loaded_project: LoadedProject,
    root: MappingNode,
    names: Sequence[str],
    interfaces: Interfaces,
    known_passes: Mapping[str, Pass] = PASSES,
    earlier: TransformedProject | None = None,
) -> TransformedProject:
    """Return what passes make of a merged project, which is not changed. `earlier` is what passes made before.

    Raise `UnknownPassError` for a name that is none of `known_passes`.
    """
    work = PassWork(loaded_project, ProjectTree(root, earlier.provenance if earlier else None), interfaces)
    ordered_passes = order_passes(names, known_passes)
    for each in ordered_passes:
        work.tree.maker = each.name
        each.run(work)
    return TransformedProject(
        work.tree.root,
        work.tree.provenance,
        tuple(dict.fromkeys(work.findings)),
        (*(earlier.passes if earlier else ()), *(each.name for each in ordered_passes)),
        is_changed=work.tree.edit_count > 0,
    )


def order_passes(names: Sequence[str], known_passes: Mapping[str, Pass] = PASSES) -> tuple[Pass, ...]:
    """Return the passes of these names, each behind those that it needs and that have not run yet."""
    held: set[str] = set()
    ordered: list[Pass] = []
    for name in names:
        if name not in known_passes:
            raise UnknownPassError(name, tuple(known_passes))
        for each in _list_needed(known_passes[name], known_passes, held):
            ordered.append(each)
            held.difference_update(each.ends)
            held.update(each.leaves)
    return tuple(ordered)


def _list_needed(wanted_pass: Pass, known_passes: Mapping[str, Pass], held_states: set[str]) -> Iterator[Pass]:
    """Yield a pass behind all that it needs and that does not hold."""
    held_states = set(held_states)
    for state in wanted_pass.needs:
        if state not in held_states:
            giver = next(each for each in known_passes.values() if state in each.leaves)
            for each in _list_needed(giver, known_passes, held_states):
                yield each
                held_states.difference_update(each.ends)
                held_states.update(each.leaves)
    yield wanted_pass
