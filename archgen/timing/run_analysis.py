"""The whole analysis: of an architecture, or of a system in which some figures were changed."""

from __future__ import annotations

from operator import attrgetter

from archgen.frozen import replace
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, Reason
from archgen.timing.load.host_loads import (
    build_response_times,
    build_run_responses,
    build_storing_waits,
    explain_waits,
    find_host_loads,
    find_resource_loads,
)
from archgen.timing.load.link_queueing import settle_links
from archgen.timing.rates.edge_fit import EdgeContext, find_edge_fits
from archgen.timing.rates.link_traffic import find_link_loads, find_topic_loads
from archgen.timing.rates.output_rates import find_rates
from archgen.timing.rates.service_waiting import find_service_loads
from archgen.timing.system.activity_builder import BuiltParts
from archgen.timing.system.core_placement import find_resources, split_resources
from archgen.timing.system.system_builder import build_system as build
from archgen.timing.system.timing_system import TimingSystem


def analyse_architecture(architecture: Architecture, *, judging: bool = False) -> Analysis:
    """Analyse an architecture, chains aside.

    With `judging`, what no rule looks at is left out: the topics, and the edges that cannot be at fault.
    """
    system, notes = build(architecture)
    return analyse_system(system, notes, judging=judging)


_MAX_ANALYSES = 4


class AnalysisMemory:
    """Remembers the last analyses of one who judges many versions of a project, which mostly leave timing as it was."""

    def __init__(self) -> None:
        """Start without any analysis."""
        self._analyses: list[Analysis] = []
        """The one that was asked for last comes first."""
        self._room = _MAX_ANALYSES
        self._parts: BuiltParts | None = None

    def make_room(self, version_count: int) -> None:
        """Remember at least so many analyses: whoever judges so many versions holds all of them anyway.

        They are versions of one project: what they are built from is the same, as far as they share it.
        """
        self._room = max(self._room, version_count)
        self._parts = self._parts or BuiltParts()

    def judge_architecture(self, architecture: Architecture) -> Analysis:
        """Analyse an architecture for judging; an earlier analysis, where every figure and every place is the same."""
        system, notes = build(architecture, self._parts)
        known = next((each for each in self._analyses if _is_same_system(each, system, notes)), None)
        analysis = known or analyse_system(system, notes, judging=True)
        others = [each for each in self._analyses if each is not analysis]
        # Only a few are kept: a variant may have the figures of the project itself, or of another one; of versions in
        # their order, one that returns to older figures is rare.
        self._analyses = [analysis, *others[: self._room - 1]]
        return analysis


def complete_analysis(analysis: Analysis) -> Analysis:
    """Return an analysis that was made for judging with what that left out: the same as one that left nothing out."""
    if analysis.state is None:
        return analyse_system(analysis.system, analysis.notes)
    edge_context = EdgeContext(analysis.state, analysis.paces, analysis.outputs, analysis.responses)
    return replace(
        analysis,
        topics=find_topic_loads(analysis.system, analysis.outputs),
        edges=find_edge_fits(edge_context, judging=False),
    )


def analyse_for_chains(architecture: Architecture) -> Analysis:
    """Analyse what chains rest on and no more, for callers that ask the same of many versions of one project."""
    system, notes = build(architecture)
    return analyse_system(system, notes, judging=True)


def _is_same_system(analysis: Analysis, system: TimingSystem, notes: tuple[Reason, ...]) -> bool:
    """Whether an analysis is that of this system: every figure is equal, and written at the same place."""
    # Spans take no part in the equality of systems (`compare=False`), but findings point to them. So this asks more than
    # whether the architecture changed (the comparison's normal form), which leaves places out.
    return (
        analysis.system == system
        and list(map(_activity_spans, analysis.system.activities.values()))
        == list(map(_activity_spans, system.activities.values()))
        and list(map(_arc_spans, analysis.system.arcs)) == list(map(_arc_spans, system.arcs))
        and [(note, note.at) for note in analysis.notes] == [(note, note.at) for note in notes]
    )


_activity_spans = attrgetter("at", "places")
_arc_spans = attrgetter("at", "queue_at")


def analyse_system(system: TimingSystem, notes: tuple[Reason, ...] = (), *, judging: bool = False) -> Analysis:
    """Analyse a system, chains aside."""
    # The order of the stages: links and event models in ticks, responses in ns, rates, and then what rests on all of
    # them.
    system, trigger_graph, state = settle_links(system)
    resource_list = find_resources(system)
    responses = build_response_times(state, split_resources(system, resource_list))
    rates = find_rates(state, responses)
    resource_loads = find_resource_loads(state, rates.paces)
    responses = {
        name: replace(
            response,
            reasons=(*response.reasons, *explain_waits(resource_loads, system.activities[name], system.tick)),
        )
        if system.activities[name].suspends
        else response
        for name, response in responses.items()
    }
    edge_context = EdgeContext(state, rates.paces, rates.outputs, responses)
    return Analysis(
        system=system,
        paces={name: rates.paces[name] for name in system.activities},
        outputs={
            (activity.id, key): rates.outputs[activity.id, key]
            for activity in system.activities.values()
            for key in activity.outputs
        },
        responses=responses,
        runs=build_run_responses(state, responses, state.ways_to, state.run_arcs),
        host_runs=build_run_responses(state, responses, state.transaction_ways, state.transaction_arcs),
        hosts=find_host_loads(system, resource_list, rates.paces, rates.outputs, responses),
        links=find_link_loads(state, rates),
        topics={} if judging else find_topic_loads(system, rates.outputs),
        edges=find_edge_fits(edge_context, judging=judging),
        endless=trigger_graph.endless_rings,
        deadlocked=trigger_graph.deadlocked_rings,
        diverged=tuple(
            name
            for name in system.activities
            if name in state.diverged or "diverged" in responses[name].worst.assumptions
        ),
        derived=rates.derived,
        services=find_service_loads(state, rates.paces, responses),
        matches=rates.matches,
        resources=resource_loads,
        storing_waits=build_storing_waits(state),
        notes=notes,
        state=state,
        searched_terms=state.searched_terms,
    )
