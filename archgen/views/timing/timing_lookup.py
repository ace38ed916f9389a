"""Results of the timing analysis, with the look-ups that views need."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from archgen.frozen import dataclass, field, replace
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.system.timing_system import Activity
from archgen.views.timing import chain_status, value_format

if TYPE_CHECKING:
    from archgen.simulation.schedule_log import LateSchedule
    from archgen.timing.chains.element_flows import FlowFinder
    from archgen.timing.chains.fused_inputs import FusedInputs
    from archgen.timing.chains.use_case_times import UseCaseTimes, WholeBound
    from archgen.timing.load.response_terms import ResponseTerms


@dataclass(frozen=True, slots=True)
class TimingLookup:
    """A timing analysis with its chains."""

    analysis: Analysis
    chains: tuple[ChainResult, ...] = ()
    """The judged chains, the worst first."""
    rate_origins: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Activities that an inferred rate comes from, by activity id; rates that were written have no entry."""
    activities_of_node: Mapping[str, tuple[Activity, ...]] = field(default_factory=dict)
    """Activities of a node, by node id."""
    fused_inputs: tuple[FusedInputs, ...] = ()
    """What uses messages of several inputs together."""
    whole_bounds: Mapping[str, WholeBound] = field(default_factory=dict)
    """The worst ways through composed components that say how long they take, by id."""
    use_cases: Mapping[str, UseCaseTimes] = field(default_factory=dict)
    """How long the steps of use cases take, by id."""
    flows: FlowFinder | None = None
    """What elements take in and give out; None in a lookup of a test."""
    response_terms: ResponseTerms | None = field(default=None, compare=False, repr=False)
    """What responses are made of; None where the analysis keeps no state."""
    late_runs: Mapping[str, LateSchedule] = field(default_factory=dict)
    """The runs in which chains were late, by chain."""
    remembered: dict[tuple[str, tuple[str, ...]], Any] = field(default_factory=dict, compare=False, repr=False)
    """What was made of activities, by the name of the function that made it and their ids: the page of a component shows it, and that of its node."""


def make_timing_lookup(analysis: Analysis, chains: Iterable[ChainResult] = ()) -> TimingLookup:
    """Build the look-ups of a timing analysis."""
    activities_by_node: dict[str, tuple[Activity, ...]] = {}
    for activity in analysis.system.activities.values():
        activities_by_node[activity.node] = (*activities_by_node.get(activity.node, ()), activity)
    # Imported here because the engine takes time to load, and most commands show no timing.
    from archgen.timing.chains.fused_inputs import find_fused_inputs
    from archgen.timing.load.response_terms import ResponseTerms

    return TimingLookup(
        analysis,
        chain_status.rank_chains(chains),
        value_format.find_rate_origins(analysis),
        activities_by_node,
        find_fused_inputs(analysis),
        response_terms=ResponseTerms(analysis.state) if analysis.state else None,
    )


def analyse_with_chains(architecture: Architecture) -> TimingLookup:
    """Analyse the timing of an architecture, with its chains."""
    # Imported here because the engine takes time to load, and most commands show no timing.
    from archgen.timing.run_analysis import analyse_architecture

    return bound_chains(analyse_architecture(architecture), architecture)


def complete_with_chains(analysis: Analysis | None, architecture: Architecture) -> TimingLookup:
    """Return the look-ups of an analysis that rules have judged, with all that they did not ask for; None is a project
    without `timing`, where they asked for nothing.
    """
    if analysis is None:
        return analyse_with_chains(architecture)
    from archgen.timing.run_analysis import complete_analysis

    return bound_chains(complete_analysis(analysis), architecture)


def bound_chains(analysis: Analysis, architecture: Architecture) -> TimingLookup:
    """Build the look-ups of a timing analysis, with the bounds of all chains, and of the composed components that have limits."""
    from archgen.simulation.chain_witnesses import judge_chains
    from archgen.timing.chains.element_flows import FlowFinder
    from archgen.timing.chains.use_case_times import bound_use_cases, bound_wholes

    lookup = make_timing_lookup(analysis, judge_chains(analysis, architecture).values())
    return replace(
        lookup,
        whole_bounds=bound_wholes(analysis, architecture),
        use_cases=bound_use_cases(analysis, architecture),
        flows=FlowFinder(analysis, architecture, lookup.chains),
    )


def add_late_runs(lookup: TimingLookup) -> TimingLookup:
    """Record what happened in the runs that show chains late."""
    late_runs = [(result.id, result.through, result.late_run) for result in lookup.chains if result.late_run]
    if not late_runs:
        return lookup
    from archgen.simulation.chain_witnesses import find_publish_pauses
    from archgen.simulation.schedule_log import record_schedule

    analysis = lookup.analysis
    pauses = find_publish_pauses(analysis)
    schedules = {
        key: record_schedule(analysis.system, through, run.seed, run.seconds, pauses) for key, through, run in late_runs
    }
    return replace(lookup, late_runs={key: schedule for key, schedule in schedules.items() if schedule})
