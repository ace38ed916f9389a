"""What each refinement of the bounds of timing earns: all bounds with it and without it, as a table.

Usage: python benchmarks/refinements.py [LAST], systems 0 to 104 of each kind where nothing is said, and the projects that
ship. A refinement is switched off by changing a line of the code that computes with it, in this process alone.
"""

from __future__ import annotations

import inspect
import statistics
import sys
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from importlib import import_module
from pathlib import Path
from types import CodeType, FrameType, FunctionType
from typing import NamedTuple

_ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(_ROOT))

from archgen import pipeline  # noqa: E402 - the checkout is what is measured
from archgen.model.architecture import Architecture  # noqa: E402
from archgen.timing.analysis import Analysis  # noqa: E402
from archgen.timing.chains.chain_bounds import bound_all_chains  # noqa: E402
from archgen.timing.run_analysis import analyse_architecture, analyse_system  # noqa: E402
from archgen.timing.system.system_builder import build_system  # noqa: E402
from tests.timing.exceeded import bounded  # noqa: E402
from tests.timing.random_pairs import list_pairs, random_pair_text  # noqa: E402
from tests.timing.random_styles import random_style_text  # noqa: E402
from tests.timing.random_systems import architecture, random_text  # noqa: E402
from tests.timing.random_threads import random_threads_text  # noqa: E402
from tests.timing.random_uses import random_use_system  # noqa: E402

Bounds = dict[tuple[str, str], float]
"""Bounds in ns, by system and what they are of."""


class Refinement(NamedTuple):
    """What makes some bounds smaller: `line`, once in a function of a module below timing/, and what stands there without it."""

    title: str
    place: str
    line: str
    without: str


REFINEMENTS = (
    # One core.
    Refinement(
        "each activation of a busy time by itself (one core)",
        "load.response_times:_bound_by_priority",
        "if len(thread.works) == 1 and thread.in_order:",
        "if False:",
    ),
    Refinement(
        "the same where activities fire one another",
        "load.core_responses:CoreSolver._response_by_activation",
        "if not all(step in level_ids for way in ways for step in way.steps):",
        "if True:",
    ),
    Refinement(
        "the only way to an activity, activation by activation",
        "load.core_responses:CoreSolver._delay_of_only_way",
        "if len(ways) != 1 or",
        "if True or len(ways) != 1 or",
    ),
    Refinement(
        "a response is no longer than its longest way",
        "load.core_responses:CoreSolver.solve",
        "if response.value is not None and longest < response.value:",
        "if False:",
    ),
    Refinement(
        "strictly periodic work that fills a core",
        "load.event_streams:settles_at_full_load",
        "if any(stream.jitter",
        "if True or any(stream.jitter",
    ),
    # Several cores.
    Refinement("a host as a whole", "load.whole_hosts:find_whole_hosts", "return whole_hosts", "return {}"),
    Refinement(
        "what leaves a host, or a way over hosts, as a whole",
        "load.event_models:leaving_model",
        "for each in bounded_ways if each]",
        "for each in () if each]",
    ),
    Refinement(
        "each of several cores that others are pinned to",
        "load.single_cores:find_single_cores",
        "if resources[step].foreign_units",
        "if False",
    ),
    Refinement(
        "what may be pending when a core is idle",
        "load.idle_backlogs:find_idle_backlog",
        "return backlog",
        "return None",
    ),
    Refinement(
        "of it: no work of what follows",
        "load.idle_backlogs:IdleBacklog.count_unfinished",
        "return way_work.behind",
        "return 0 if True else way_work.behind",
    ),
    Refinement(
        "of it: no more than all that the events lead to",
        "load.idle_backlogs:IdleBacklog._find_pending",
        "return min((*crowd_shares, *lane_shares), tuple(whole_shares.values()), key=_sum_works)",
        "return (*crowd_shares, *lane_shares)",
    ),
    Refinement(
        "of it: no more of an origin than there is",
        "load.idle_backlogs:choose_largest_lanes",
        "if any(len(lane) > 1 for lane in lanes):",
        "if True:",
    ),
    Refinement(
        "a run as a whole, not step by step",
        "load.shared_core_responses:SharedCoreSolver._find_way_delays",
        "delay = self.find_worst(self.paths.look_up(way.steps), spend, delay).response",
        "pass",
    ),
    Refinement(
        "a run step by step, not as a whole",
        "load.shared_core_responses:SharedCoreSolver._find_way_delays",
        "delay += delays[self.way_before[name, number]]",
        "delay += 1 << 80",
    ),
    Refinement(
        "a step has ended before the ones that it fires",
        "load.shared_core_responses:SharedCoreSolver._repeat_sweeps",
        "if key in delays and delays[key] < delays[way_before]:",
        "if False:",
    ),
    Refinement(
        "a response is no longer than its longest way (several cores)",
        "load.shared_core_responses:SharedCoreSolver._build_response",
        "min(self.step_responses[name], max((way.delay or 0) - way.best_before for way in ways))",
        "self.step_responses[name]",
    ),
    Refinement(
        "each activation of a path's last step by itself",
        "load.core_paths:CorePaths._find_last_step",
        "not cost\n",
        "True\n",
    ),
    Refinement(
        "nothing pending in the path's own threads",
        "load.path_work:PathWork._path_work",
        "self.delays.get(way_before, 0) if way_before else 0",
        "self.delays.get(jobs[number].key, 0)",
    ),
    Refinement(
        "at most m - 1 threads had work before",
        "load.path_work:PathWork._find_most_waiting",
        "sum(waiting_works[: self.cores.core_count - 1])",
        "sum(waiting_works)",
    ),
    Refinement(
        "no thread works longer than B, pending work included",
        "load.path_work:PathWork._find_block",
        "if time < block.time else block",
        "if False else block",
    ),
    # Hosts that fire one another.
    Refinement(
        "ways over hosts as wholes",
        "load.transactions:find_transactions",
        "if len(group) > 1 else None",
        "if False else None",
    ),
    # Orders.
    *(
        Refinement(
            f"the order `{order}` of a queue",
            "load.queue_responses:find_core_queue",
            "order = _QUEUE_ORDERS.get(written_order)",
            f"order = None if written_order == {order!r} else _QUEUE_ORDERS.get(written_order)",
        )
        for order in ("non_preemptive", "fifo", "edf", "ros2_executor")
    ),
    # What is stored.
    Refinement(
        "own jobs before an activation that comes too soon (storing, one core)",
        "load.storing_waits:hold_before_activation",
        "return longest_busy_window(",
        "return busy_period or longest_busy_window(",
    ),
    Refinement(
        "the same on several cores",
        "load.storing_waits:hold_beside_others",
        "return longest_busy_window(",
        "return window or longest_busy_window(",
    ),
    # Resources.
    Refinement(
        "cores and resources joined",
        "load.joined_resources:find_joined_resources",
        "yield from _list_groups(system, triggers, parts, neighbours, _list_uses(system))",
        "pass",
    ),
    Refinement(
        "cores alone, where resources come in turn",
        "load.joined_resources:find_joined_resources",
        "if use_times := {name: time for name, time in find_turn_times(system).items() if time is not None}:",
        "if False and (use_times := {}):",
    ),
    Refinement(
        "waits for resources use by use",
        "load.waiting_threads:list_waiting_windows",
        "for waits in (_waits_by_use(state, own_ids, budget), _waits_together(state, own_ids))",
        "for waits in (_waits_together(state, own_ids),)",
    ),
    Refinement(
        "waits for resources all at once",
        "load.waiting_threads:list_waiting_windows",
        "for waits in (_waits_by_use(state, own_ids, budget), _waits_together(state, own_ids))",
        "for waits in (_waits_by_use(state, own_ids, budget),)",
    ),
    Refinement(
        "uses in turn",
        "load.resource_waits:find_use_time",
        'if order == "fifo" else None',
        "if False else None",
    ),
    # Event models.
    Refinement(
        "what leaves by the ways that lead there",
        "load.event_models:leaving_model",
        "if (len(ways) == 1 and len(ways[0].steps) == 1) or",
        "if True or",
    ),
    Refinement(
        "ends of one activity are apart",
        "load.event_models:_keep_completions_apart",
        "if source.response is not None",
        "if True",
    ),
    Refinement(
        "inputs of one period",
        "load.event_streams:combine_all_of",
        "complete\n        and len({(stream.period",
        "False\n        and len({(stream.period",
    ),
    Refinement(
        "what is due too soon under a throttle",
        "load.event_streams:throttle_streams",
        "is_regular = ",
        "is_regular = False and ",
    ),
    Refinement(
        "matches by how old messages are",
        "load.event_models:combine_matched",
        "min(waits.get(key, queue_wait), queue_wait)",
        "queue_wait",
    ),
    Refinement(
        "matches by the queue",
        "load.event_models:combine_matched",
        "min(waits.get(key, queue_wait), queue_wait)",
        "waits.get(key, queue_wait)",
    ),
    Refinement(
        "messages of one job",
        "load.event_models:find_match_windows",
        "if same_source or",
        "if",
    ),
    Refinement(
        "a core for each thread where there are enough",
        "system.core_placement:divide_resource",
        "if resource.cores == 1 or",
        "if True or",
    ),
)


def find_function(place: str) -> FunctionType:
    """Return the function that computes with a refinement."""
    module_name, _, name = place.partition(":")
    found: object = import_module(f"archgen.timing.{module_name}")
    for part in name.split("."):
        found = getattr(found, part)
    if not isinstance(found, FunctionType):
        raise TypeError(place)
    return found


@contextmanager
def without(refinement: Refinement) -> Iterator[None]:
    """Switch a refinement off for a while, wherever the function that computes with it has been imported."""
    function = find_function(refinement.place)
    source = textwrap.dedent(inspect.getsource(function))
    if source.count(refinement.line) != 1:
        raise ValueError(refinement)
    namespace: dict[str, object] = {}
    changed = compile(
        "from __future__ import annotations\n" + source.replace(refinement.line, refinement.without),
        refinement.place,
        "exec",
    )
    exec(changed, {**function.__globals__}, namespace)  # noqa: S102 - it is the checkout's own text, with one line changed
    code, replaced = function.__code__, namespace[function.__name__]
    function.__code__ = replaced.__code__  # type: ignore[attr-defined]  # a function of that name
    try:
        yield
    finally:
        function.__code__ = code


def list_systems(last: int) -> dict[str, Callable[[], Bounds]]:
    """Return how to bound each system: those that ship, and the random ones."""
    shipped = {path.name: path for path in (_ROOT / "example_ramcip", *sorted((_ROOT / "examples").iterdir()))}
    systems: dict[str, Callable[[], Bounds]] = {
        name: partial(_bound_model, name, checked)
        for name, path in shipped.items()
        if (path / "archgen.yaml").is_file() and (checked := pipeline.check_project(path).architecture) is not None
    }
    makers = (("style", random_style_text), ("kinds", random_text), ("threads", random_threads_text))
    for seed in range(last):
        for kind, make in makers:
            name = f"{kind} {seed}"
            systems[name] = partial(_bound_model, name, architecture(make(seed)))
        systems[f"loaded {seed}"] = partial(_bound_loaded, f"loaded {seed}", architecture(random_style_text(seed)))
        name = f"uses {seed}"
        systems[name] = partial(lambda key, of: _list_bounds(key, analyse_system(of)), name, random_use_system(seed))
        pair = list_pairs()[seed % len(list_pairs())]
        systems[f"pairs {seed}"] = partial(_bound_model, f"pairs {seed}", architecture(random_pair_text(pair, seed)))
    return systems


def _bound_loaded(name: str, model: Architecture) -> Bounds:
    """Bound a system in which everything takes twice as long: some threads and hosts have too much to do."""
    system, _ = build_system(model)
    activities = {
        key: replace(activity, wcet=None if activity.wcet is None else 2 * activity.wcet)
        for key, activity in system.activities.items()
    }
    return _list_bounds(name, analyse_system(replace(system, activities=activities)))


def _bound_model(name: str, model: Architecture) -> Bounds:
    analysis = analyse_architecture(model)
    bounds = _list_bounds(name, analysis)
    for key, chain in bound_all_chains(analysis, model).items():
        if (bound := bounded(chain.bound)) is not None:
            bounds[name, f"chain {key}"] = float(bound)
    return bounds


def _list_bounds(name: str, analysis: Analysis) -> Bounds:
    kinds = {
        "response": {key: response.worst for key, response in analysis.responses.items()},
        "run": {key: run.worst for key, run in analysis.runs.items()},
        "stored": dict(analysis.storing_waits),
    }
    return {
        (name, f"{kind} {key}"): float(bound)
        for kind, values in kinds.items()
        for key, value in values.items()
        if (bound := bounded(value)) is not None
    }


def bound_systems(systems: dict[str, Callable[[], Bounds]]) -> tuple[Bounds, dict[str, set[CodeType]]]:
    """Return the bounds of all systems, and which functions that refine bounds each of them needs."""
    codes = {find_function(refinement.place).__code__ for refinement in REFINEMENTS}
    bounds: Bounds = {}
    needed: dict[str, set[CodeType]] = {}
    for name, bound_system in systems.items():
        called = needed[name] = set[CodeType]()

        def note_call(frame: FrameType, event: str, _: object, called: set[CodeType] = called) -> None:
            if event == "call" and frame.f_code in codes:
                called.add(frame.f_code)

            sys.setprofile(note_call)

        try:
            bounds |= bound_system()
        finally:
            sys.setprofile(None)
    return bounds, needed


def bound_without(refinement: Refinement, systems: dict[str, Callable[[], Bounds]], names: set[str]) -> Bounds:
    """Return the bounds of some systems without a refinement."""
    with without(refinement):
        return {key: bound for name in systems if name in names for key, bound in systems[name]().items()}


def describe_gains(with_it: Bounds, without_it: Bounds) -> str:
    """Return the cells of a row: how many bounds are only there with it, how many are less and by how much, how many more."""
    lost = sum(1 for key in with_it if key not in without_it)
    ratios = [without_it[key] / bound for key, bound in with_it.items() if bound and key in without_it]
    gains = sorted(ratio - 1 for ratio in ratios if ratio > 1)
    losses = sum(1 for ratio in ratios if ratio < 1) + sum(1 for key in without_it if key not in with_it)
    median, largest = (f"{statistics.median(gains):.1%}", f"{gains[-1]:.1%}") if gains else ("", "")
    return f"{lost} | {len(gains)} | {median} | {largest} | {losses}"


def main() -> None:
    """Print the table as Markdown."""
    systems = list_systems(int(sys.argv[1]) if len(sys.argv) > 1 else 105)
    whole, needed = bound_systems(systems)
    print(f"{len(systems)} systems, {len(whole)} bounds\n", flush=True)
    print("| refinement | module | none without | larger without | median | most | smaller without |")
    print("|---|---|---|---|---|---|---|")
    for refinement in REFINEMENTS:
        code = find_function(refinement.place).__code__
        names = {name for name, codes in needed.items() if code in codes}
        bounds = bound_without(refinement, systems, names)
        gains = describe_gains({key: bound for key, bound in whole.items() if key[0] in names}, bounds)
        print(f"| {refinement.title} | `{refinement.place.partition(':')[0]}` | {gains} |", flush=True)


if __name__ == "__main__":
    main()
