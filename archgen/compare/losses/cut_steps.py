"""Steps of use cases that ran along a connection, and run along none any more."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.losses.lost_connections import find_output_causes
from archgen.diagnostics.common_wording import join_words
from archgen.frozen import replace
from archgen.model.architecture import UseCase
from archgen.model.graph_search import find_reachable
from archgen.model.step_connections import ConnectedStep, StepConnection, StepConnections, UseCaseSteps
from archgen.model.use_case_steps import Step, StepEnd


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
    ways: dict[str, list[str]] = defaultdict(list)
    for each in steps:
        if not each.is_broken:
            ways[each.step.source.participant].append(each.step.target.participant)
    return ways


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
