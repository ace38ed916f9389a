"""Outputs that partners read and that were removed, or have another id than the one that their files name; steps of use cases
that ran along a connection, and run along none any more.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_sorted_names
from archgen.compare.version_pair import ElementKey
from archgen.diagnostics import join_words
from archgen.frozen import NamedTuple, replace
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture, UseCase
from archgen.model.graph_search import find_reachable
from archgen.model.step_connections import ConnectedStep, StepConnection, StepConnections, UseCaseSteps
from archgen.model.use_case_steps import Step, StepEnd

_UNMADE_NOTE = "; `autoconnect` joined them, and does no more"
_MAX_RENAMES = 2
"""Maximal number of ids in one sentence; the rest is counted."""


def find_lost_connections(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find outputs that were removed while a partner read them, whatever became of the reader.

    A reader that turns away loses nothing as long as its source stays as it is.
    """
    for output, readers in sorted(context.versions.connections_before.readers_by_output.items()):
        if not context.versions.is_removed("output", output) or output in context.output_heirs:
            continue
        indices = find_output_causes(context, output)
        new_readers = context.versions.connections_after.readers_by_output.get(output, frozenset())
        inputs_by_note: dict[str, dict[str, list[str]]] = defaultdict(dict)
        for partner, inputs in context.foreign_readers(output, readers - new_readers).items():
            inputs_by_note[_describe_aftermath(context, inputs)][partner] = inputs
        lead = f"takes `{context.old_id('output', output)}` from"
        for note, inputs_by_partner in inputs_by_note.items():
            yield from context.losses_of_readers(indices, inputs_by_partner, lead, note)


def find_unmade_connections(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find inputs that lost what nobody had joined to them by its name: `autoconnect` had, or they read a whole group.

    It belongs to the change that unmade it, since whoever owns the input wrote nothing of that: another output that
    fits, another type, another group, or the word itself. What was removed is told as such.
    """
    connections_before, connections_after = context.versions.connections_before, context.versions.connections_after
    for input_id, sources in sorted(connections_before.sources_by_input.items()):
        partner = context.owner_before("input", input_id)
        sources_after = connections_after.sources_by_input.get(input_id, frozenset())
        lost_sources = [each for each in sorted(sources) if context.output_heirs.get(each, each) not in sources_after]
        is_made = not sources_after and connections_before.is_made(input_id, sources)
        is_of_group = bool(lost_sources) and all((each, input_id) in connections_before.group_pairs for each in sources)
        if (
            not (is_made or is_of_group)
            or partner is None
            or not context.needs_source(input_id)
            or _is_own_edit(context, input_id, lost_sources)
        ):
            continue
        old_names = tick_sorted_names(context.old_id("output", source) for source in lost_sources)
        lead = f"takes {old_names} from"
        note = "; it reads all of a group, in which that is no more" if is_of_group else _UNMADE_NOTE
        causes = _find_unmaking_changes(context, input_id, lost_sources)
        if causes:
            yield from context.losses_of_readers(causes, {partner: [input_id]}, lead, note)
        elif is_made and partner not in context.lasting_owners(*_find_holder(context, input_id)):
            reason = f"{lead} {context.name_partner(partner)} ({tick_sorted_names([input_id])}){note}"
            yield from (
                PartnerLoss(index, partner, reason) for index in context.change_indices("connection", input_id)[:1]
            )


def find_redirected_connections(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find inputs that read something else through a port of a composed component of which they name what they named."""
    for index, change in enumerate(context.changes):
        partner = context.owner_before("input", change.element_id)
        if (change.element_kind, change.kind) != ("connection", "changed") or partner is None:
            continue
        old_input = context.before.inputs.get(context.old_id("input", change.element_id))
        new_input = context.after.inputs.get(change.element_id)
        if old_input is None or new_input is None or not context.needs_source(change.element_id):
            continue
        new_ports = {each.shell_port: each for each in new_input.connections if each.shell_port}
        for old in old_input.connections:
            new = new_ports.get(_find_common_port(context, old.shell_port))
            sources = {context.matched_ids.common_id("output", each) for each in old.outputs}
            is_gone = any(context.versions.is_removed("output", each) for each in sources)
            if (
                new is None
                or is_gone
                or sources <= set(new.outputs)
                or partner in context.lasting_owners("composed", (new.shell_port or "").rpartition(".")[0])
            ):
                continue
            old_names, new_names = map(tick_sorted_names, (old.outputs, new.outputs))
            name = context.name_partner(partner)
            reason = f"gives {new_names} instead of {old_names} as `{new.shell_port}`, which {name} reads"
            yield PartnerLoss(index, partner, reason)


def _find_common_port(context: ChangeContext, shell_port: str | None) -> str:
    shell, _, name = (shell_port or "").rpartition(".")
    return f"{context.matched_ids.common_id('composed', shell)}.{name}"


def _is_own_edit(context: ChangeContext, input_id: str, sources: Iterable[str]) -> bool:
    """Whether the reader went, or says otherwise what it reads; what was removed is told as such."""
    before, after = context.versions.find_both("input", input_id)
    gone_sources = (each for each in sources if each not in context.output_heirs)
    if before is None or after is None or any(context.versions.is_removed("output", each) for each in gone_sources):
        return True
    return any(before.values.get(key) != after.values.get(key) for key in ("type", "external"))


def _find_holder(context: ChangeContext, port_id: str) -> ElementKey:
    """Return the group or the composed component in which a port's component stands."""
    holder = port_id.rpartition(".")[0].rpartition(".")[0]
    return ("composed" if ("composed", holder) in context.versions.elements_after else "group"), holder


def _find_unmaking_changes(context: ChangeContext, input_id: str, sources: Iterable[str]) -> list[int]:
    """Return the changes of outputs beside an input that left open which of them it is to read, or made them unfit."""
    changed_indices = [
        index
        for source in sorted(sources)
        for index in (*context.change_indices("output", source, "type"), *find_output_causes(context, source))
    ]
    holder = _find_holder(context, input_id)
    source_names = {source.rpartition(".")[2] for source in sources}
    source_types = {context.versions.elements_before["output", source].values.get("type") for source in sources}
    for key, element in sorted(context.versions.elements_after.items()):
        if key[0] != "output" or key in context.versions.elements_before or _find_holder(context, key[1]) != holder:
            continue
        if key[1].rpartition(".")[2] in source_names or element.values.get("type") in source_types:
            component_id = key[1].rpartition(".")[0]
            changed_indices += context.indices_by_change_kind("output", key[1], "added")
            changed_indices += context.indices_by_change_kind("component", component_id, "added")
    return list(dict.fromkeys(changed_indices))


class _RenamedSource(NamedTuple):
    """An output under another id."""

    old_id: str
    new_id: str


def find_renamed_sources(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find outputs that partners read and that have another id now: their files have to follow, their programs do not.

    What else became of the wire is told by the other losses.
    """
    sources: dict[tuple[int, str], dict[_RenamedSource, tuple[str, ...]]] = defaultdict(dict)
    for output, new_output, inputs_by_partner in context.lasting_outputs:
        old_id = context.old_id("output", output)
        for index in find_output_causes(context, output) if old_id != new_output else ():
            for partner, inputs in inputs_by_partner.items():
                # Who no longer asks for anything turned away by itself.
                present_inputs = tuple(
                    name
                    for name in inputs
                    if ("input", name) in context.versions.elements_after
                    and needs_other_id(context, name, output, new_output)
                )
                if present_inputs:
                    sources[index, partner][_RenamedSource(old_id, new_output)] = present_inputs
    partners_by_note: dict[tuple[int, str], list[str]] = defaultdict(list)
    for (index, partner), inputs_by_source in sources.items():
        partners_by_note[index, _describe_renames(context, inputs_by_source)].append(partner)
    for (index, note), partners in partners_by_note.items():
        for loss in context.losses_of_users([index], partners, "renames what {}", "reads", "source"):
            yield replace(loss, reason=f"{loss.reason}: {note}")


def _describe_renames(context: ChangeContext, inputs_by_source: Mapping[_RenamedSource, tuple[str, ...]]) -> str:
    """Return what is called how now, and which inputs have to follow."""
    connections: Mapping[str, frozenset[str]] = context.versions.connections_after.sources_by_input
    pairs = [f"`{source.old_id}` is `{source.new_id}` now" for source in [*inputs_by_source][:_MAX_RENAMES]]
    surplus = len(inputs_by_source) - _MAX_RENAMES
    surplus_note = f", and {surplus} more" if surplus > 0 else ""
    lagging_inputs = {
        name
        for source, inputs in inputs_by_source.items()
        for name in inputs
        if source.new_id not in connections.get(name, ())
    }
    verb = "has" if len(lagging_inputs) == 1 else "have"
    follow_note = (
        f"{tick_sorted_names(lagging_inputs)} {verb} to follow" if lagging_inputs else "files follow in this change"
    )
    return f"{', '.join(pairs)}{surplus_note}; {follow_note}"


def find_output_causes(context: ChangeContext, output_id: str) -> list[int]:
    """Return the indices of the changes that removed an output, or renamed it."""
    if ("output", output_id) not in context.versions.elements_after:
        return context.indices_by_change_kind("output", output_id, "removed")
    component_id = output_id.rpartition(".")[0]
    group_id = component_id.partition(".")[0]
    return [
        *context.indices_by_change_kind("output", output_id, "renamed", "moved"),
        *find_component_renames(context, component_id),
        *context.indices_by_change_kind("group", group_id, "renamed", "moved"),
    ][:1]


def _describe_aftermath(context: ChangeContext, input_ids: list[str]) -> str:
    """Return what becomes of the inputs that read a removed output: a note behind their names, which may be empty."""
    gone_ids = [name for name in input_ids if context.versions.is_removed("input", name)]
    if gone_ids:
        gone_names = "" if len(gone_ids) == len(input_ids) else f" {tick_sorted_names(gone_ids)}"
        return f"; the same change takes the reader{gone_names} away"
    current_sources = {
        source for name in input_ids for source in context.versions.connections_after.sources_by_input.get(name, ())
    }
    existing_sources = {source for source in current_sources if ("output", source) in context.versions.elements_after}
    gained_sources = existing_sources - {
        source for name in input_ids for source in context.versions.connections_before.sources_by_input.get(name, ())
    }
    return f"; it is to read {tick_sorted_names(gained_sources)} instead" if gained_sources else ""


def find_component_renames(context: ChangeContext, component_id: str) -> list[int]:
    """Return the indices of the change that gave a component its id: its own, else that of what it stands in."""
    indices = context.indices_by_change_kind("component", component_id, "renamed", "moved")
    shell_id = component_id.rpartition(".")[0]
    while not indices and "." in shell_id:
        indices = context.indices_by_change_kind("composed", shell_id, "renamed", "moved")
        shell_id = shell_id.rpartition(".")[0]
    return indices


def needs_other_id(context: ChangeContext, input_id: str, output_id: str, new_output: str) -> bool:
    """Whether the file that names an output for an input has to name it otherwise, since nothing passes it on under the
    name that stands there.
    """
    if not (context.before.shells or context.after.shells):
        return True
    old_input = context.before.inputs.get(context.old_id("input", input_id))
    old_output = context.old_id("output", output_id)
    names = [
        connection.shell_port or connection.target
        for connection in (old_input.connections if old_input else ())
        if old_output in connection.outputs
    ]
    return not names or any(new_output not in _list_named_outputs(context.after, name) for name in names)


def _list_named_outputs(architecture: Architecture, name: str) -> Iterator[str]:
    """Yield the outputs of leaves that the id of an output, or of a component, stands for."""
    component = architecture.find_component(name)
    names = [output.id for output in component.outputs.values()] if component else [name]
    for each in names:
        inner_outputs = architecture.shell_ports.get(f"output {each}", ())
        if inner_outputs:
            for inner_output in inner_outputs:
                yield from _list_named_outputs(architecture, inner_output)
        elif each in architecture.outputs:
            yield each


def find_cut_steps(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find the steps of the first version that the second one cuts.

    Broken are the other partners who take part in the use case. A step is not cut where the second version leads from
    the one end to the other over other steps of the use case: that is what a new component in between looks like.
    """
    steps_by_use_case = UseCaseSteps(context.before).by_use_case
    if not steps_by_use_case:
        return
    connections_after = StepConnections(context.after)
    steps_after = UseCaseSteps(context.after).by_use_case
    for use_case_id, steps in steps_by_use_case.items():
        new_id = context.matched_ids.common_id("use_case", use_case_id)
        ways = _list_ways(steps_after.get(new_id, ()))
        numbers_by_cause: dict[int, list[int]] = defaultdict(list)
        for each in steps:
            step = _take_over(context, each.step) if each.connections else None
            if step is None or connections_after.find_connections(step):
                continue
            if step.target.participant in find_reachable(ways, [step.source.participant]):
                continue
            for index in _find_causes(context, each):
                numbers_by_cause[index].append(each.number)
        parts = _list_parts(context, context.before.use_cases[use_case_id])
        for index, numbers in numbers_by_cause.items():
            noun = "step" if len(numbers) == 1 else "steps"
            lead = f"cuts {noun} {join_words([*map(str, numbers)])} of the use case `{use_case_id}`"
            yield from context.shared_losses([index], parts, f"{lead}; {{}} part of it", "is")


def _take_over(context: ChangeContext, step: Step) -> Step:
    """Return a step of the first version with the ids of the second one."""
    return replace(step, source=_take_over_end(context, step.source), target=_take_over_end(context, step.target))


def _take_over_end(context: ChangeContext, end: StepEnd) -> StepEnd:
    if end.kind not in {"component", "output"}:
        return end
    common_id = context.matched_ids.common_id(end.kind, end.id)
    return replace(end, id=context.output_heirs.get(common_id, common_id) if end.kind == "output" else common_id)


def _list_ways(steps: Iterable[ConnectedStep]) -> Mapping[str, list[str]]:
    """Return where the steps lead from each participant, without those that run along nothing."""
    return group_pairs(
        (each.step.source.participant, each.step.target.participant) for each in steps if not each.is_broken
    )


def _list_parts(context: ChangeContext, use_case: UseCase) -> Mapping[str, list[str]]:
    """Return the components that take part in a use case, by the partner who owned them."""
    parts: dict[str, dict[str, None]] = defaultdict(dict)
    for step in use_case.steps:
        for end in (step.source, step.target):
            if end.kind in {"component", "output"}:
                common_id = context.matched_ids.common_id("component", end.participant)
                owner = context.owner_before("component", common_id) or context.owner_before("composed", common_id)
                if owner:
                    parts[owner][end.participant] = None
    return {owner: [*names] for owner, names in parts.items()}


def _find_causes(context: ChangeContext, connected: ConnectedStep) -> list[int]:
    """Return the indices of the changes that took away what a step ran along."""
    indices = (index for each in connected.connections for index in _find_connection_causes(context, each))
    return list(dict.fromkeys(indices))


def _find_connection_causes(context: ChangeContext, connection: StepConnection) -> Iterator[int]:
    matched_ids = context.matched_ids
    if connection.output is not None:
        output = matched_ids.common_id("output", connection.output)
        if context.versions.is_removed("output", output):
            yield from find_output_causes(context, output)
        yield from context.change_indices("output", output, "type", "medium", "external")
    if connection.input is not None:
        input_id = matched_ids.common_id("input", connection.input)
        yield from context.indices_by_change_kind("input", input_id, "removed")
        yield from context.change_indices("input", input_id, "external", "medium")
        yield from context.change_indices("connection", input_id)
    for port_id in filter(None, (connection.output, connection.input)):
        component = matched_ids.common_id("component", port_id.rpartition(".")[0])
        yield from context.indices_by_change_kind("component", component, "removed")
