"""Figures are recomputed from the printed reasons alone: whoever has a pocket calculator gets them too."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.chains.figure_explanations import explain_word
from archgen.timing.load.queue_responses import QUEUE_TIERS
from archgen.timing.load.response_terms import ResponseTerms
from archgen.timing.run_analysis import analyse_architecture
from tests.property_sizes import list_seeds, try_some
from tests.running import RAMCIP
from tests.timing.hand_reader import read_equations
from tests.timing.random_robots import random_robot_text
from tests.timing.random_styles import random_style_text
from tests.timing.random_systems import architecture, random_text
from tests.timing.random_threads import random_threads_text
from tests.timing.test_unpinned_case_study import copy_without_cores


@dataclass(frozen=True, eq=False)
class Results:
    """What was found about a project; one is like no other, so that what is printed of it can be kept."""

    analysis: Analysis
    chains: dict[str, ChainResult]


def analyse(project: Path) -> Results:
    """Analyse a project, with its chains."""
    checked = pipeline.check_project(project).architecture
    analysis = analyse_architecture(checked)
    return Results(analysis, bound_all_chains(analysis, checked))


@pytest.fixture(scope="module")
def case_study() -> Results:
    return analyse(RAMCIP)


@pytest.fixture(scope="module")
def unpinned_case_study(tmp_path_factory: pytest.TempPathFactory) -> Results:
    return analyse(copy_without_cores(tmp_path_factory.mktemp("unpinned")))


@cache
def print_reasons(results: Results, word: str) -> Sequence[str]:
    """Return the lines of `--why`."""
    return [line.text for line in explain_word(results.analysis, results.chains, word)]


def recompute_response(lines: Sequence[str], name: str) -> Fraction | None:
    """Add up the work below a response, and take off what does not count; None where no work is listed."""
    start = next(at for at, line in enumerate(lines) if line.startswith(f"{name}: response"))
    total = own = Fraction(0)
    for line in lines[start + 1 :]:
        if re.match(r"\S+: ", line):
            break
        equation = next(read_equations(line), None)
        if equation and re.match(r"\d+ x ", line):
            total += equation.computed
        elif line.startswith("A = "):
            own = total
        elif equation and line.startswith("F = "):
            total = own + equation.computed
        elif equation and ("comes" in line or "begins" in line):
            total = equation.computed
    return total or None


def recompute_storing_wait(lines: Sequence[str], name: str) -> Fraction | None:
    """Add up the work that may hold up what is only to be stored; None where nothing waits, 0 where no work is listed."""
    start = next((at for at, line in enumerate(lines) if line.startswith(f"{name}: what it only reads may wait")), None)
    if start is None:
        return None
    below = lines[start + 1 :]
    end = next((at for at, line in enumerate(below) if re.match(r"\S+: ", line)), len(below))
    blocked = [next(read_equations(line)).computed for line in below[:end] if line.startswith(("B = (", "F = "))]
    own_end = next((at for at, line in enumerate(below) if line.startswith("A = ")), end)
    own = [next(read_equations(line)).computed for line in below[:own_end] if re.match(r"\d+ x ", line)]
    return sum((*own, *blocked), Fraction(0))


def is_close(computed: Fraction, exact: Fraction) -> bool:
    """Whether a figure is right, as far as it can be from figures with three decimals."""
    return abs(computed - exact) <= max(exact / 2000, Fraction(1, 2000))


def test_every_equation_that_is_printed_about_the_case_study_holds(case_study: Results) -> None:
    analysis, chains = case_study.analysis, case_study.chains
    words = [*analysis.system.activities, *analysis.hosts, *analysis.links, *analysis.topics, *chains]
    wrong = [
        (line, equation)
        for word in words
        for line in print_reasons(case_study, word)
        for equation in read_equations(line)
        if not equation.holds
    ]
    assert wrong == []
    assert sum(" = " in line for word in words for line in print_reasons(case_study, word)) > 500


def test_the_responses_of_all_tiers_follow_from_the_work_that_is_listed(case_study: Results) -> None:
    analysis = case_study.analysis
    tiers: set[str] = set()
    count = 0
    for name, response in analysis.responses.items():
        computed = recompute_response(print_reasons(case_study, name), name)
        assert (computed is None) == (response.tier in {"declared", "unknown"}), name
        if computed is not None:
            assert is_close(computed, response.worst.value or Fraction(0)), (name, computed)
            tiers.add(response.tier)
            count += 1
    assert count > 55
    assert tiers == {"host", "priorities", "executor", "cores", "fair"}


def test_the_largest_gaps_follow_from_the_last_formula_that_is_printed(case_study: Results) -> None:
    analysis = case_study.analysis
    count = 0
    for name, pace in analysis.paces.items():
        lines = print_reasons(case_study, name)
        above = lines[: next(at for at, line in enumerate(lines) if ": response" in line)]
        gaps = [equation for line in above if line.startswith("gap ") for equation in read_equations(line)]
        if gaps and pace.gap.value is not None:
            assert is_close(gaps[-1].computed, pace.gap.value), name
            count += 1
    assert count > 20


def test_loads_of_hosts_are_the_sums_of_rate_times_execution_time(case_study: Results) -> None:
    analysis = case_study.analysis
    for name in ("onboard_pc", "vision_pc", "arm_pc", "interaction_pc"):
        added = [line for line in print_reasons(case_study, name) if " adds " in line]
        total = sum((next(read_equations(line)).computed for line in added), Fraction(0))
        assert is_close(total, analysis.hosts[name].utilisation.value or Fraction(0)), name
        assert len(added) > 5


def test_the_traffic_the_queueing_and_the_burst_of_a_link_follow_from_its_messages(case_study: Results) -> None:
    analysis = case_study.analysis
    lines, load = print_reasons(case_study, "robot_lan"), analysis.links["robot_lan"]
    traffic = sum((next(read_equations(line)).computed for line in lines if " adds " in line), Fraction(0))
    assert is_close(traffic * 10**9, load.traffic.value or Fraction(0))
    burst_at = next(at for at, line in enumerate(lines) if "largest burst" in line)
    sent, waiting = (
        [next(read_equations(line)).computed for line in part if re.match(r"\d+ x ", line)]
        for part in (lines[:burst_at], lines[burst_at:])
    )
    assert is_close(sum(sent, Fraction(0)), load.queueing.value or Fraction(0))
    assert is_close(sum(waiting, Fraction(0)), load.burst.value or Fraction(0))
    assert min(len(sent), len(waiting)) > 5


def test_chains_are_the_sums_of_their_terms(case_study: Results) -> None:
    chains = case_study.chains
    for name, chain in chains.items():
        total = next(line for line in print_reasons(case_study, name) if re.match(r"~?\d\S* m?s \+ ", line))
        assert is_close(next(read_equations(total)).computed, chain.bound.value or Fraction(0)), name
    assert len(chains) == 8


# The analysis of the case study without `core:` keys takes seconds: of it are the slow tests.
@pytest.mark.slow
@pytest.mark.parametrize("share", range(4))
def test_on_several_cores_the_own_threads_and_the_time_in_which_all_cores_are_busy_add_up(
    unpinned_case_study: Results, share: int
) -> None:
    """Of a quarter of all elements at a time: each is worked out anew."""
    analysis = unpinned_case_study.analysis
    blocked = added = 0
    for name, response in list(analysis.responses.items())[share::4]:
        lines = print_reasons(unpinned_case_study, name)
        assert [(line, each) for line in lines for each in read_equations(line) if not each.holds] == []
        sums = [line for line in lines if line.endswith(", A + B") and " = " in line]
        if sums and response.tier == "cores":
            after = [*lines, ""][lines.index(sums[0]) + 1]
            is_less = "comes" in after or "begins" in after
            computed = next(read_equations(after if is_less else sums[0])).computed
            assert is_close(computed, response.worst.value or Fraction(0)), name
            added += 1
        blocked += any(line.startswith("B = (") for line in lines)
    assert min(blocked, added) > 1


@pytest.mark.parametrize("study", try_some(["case_study", "unpinned_case_study"]))
def test_how_long_messages_wait_to_be_stored_follows_from_the_work_that_is_listed(
    study: str, request: pytest.FixtureRequest
) -> None:
    results: Results = request.getfixturevalue(study)
    waits = {name: wait.value or Fraction(0) for name, wait in results.analysis.storing_waits.items()}
    for name in results.analysis.system.activities:
        computed = recompute_storing_wait(print_reasons(results, name), name)
        assert (computed is None) == (not waits.get(name)), name
        assert computed is None or is_close(computed, waits[name]), (name, computed, waits[name])
    assert sum(1 for wait in waits.values() if wait) > 5


@pytest.mark.parametrize(
    ("text", "is_fair"),
    [(random_text(seed), False) for seed in range(10)]
    + [(random_style_text(seed), False) for seed in range(14)]
    + [(random_threads_text(24), False)]  # where what is only read waits for rounds of its executor
    # Of cores, and of a thread and its GPU taken as one, that were given up, nothing is left of the last sweep.
    + [(random_robot_text(seed), False) for seed in (16, 17)]
    # Threads that wait for GPUs: by priority, fairly served, and with their cores and GPUs taken as one.
    + [(random_robot_text(seed), is_fair) for seed in (5, 8, 14, 20) for is_fair in (False, True)],
)
def test_each_response_that_has_a_bound_has_terms_that_give_it(text: str, *, is_fair: bool) -> None:
    analysis = analyse_architecture(architecture(text, is_fair=is_fair))
    assert analysis.state is not None
    workings = ResponseTerms(analysis.state)
    for name, response in analysis.state.responses.items():
        working = workings.find_response(name)
        if response.value is None or response.tier in {"declared", "unknown"}:
            assert working is None
        else:
            assert working is not None, name
            assert (working.value, working.is_consistent) == (response.value, True)
        wait = analysis.state.storing_waits.get(name)
        storing_working = workings.find_storing_wait(name)
        if wait is None or not wait.value:
            assert storing_working is None
        else:
            assert storing_working is not None, name
            assert (storing_working.value, storing_working.is_consistent) == (wait.value, True)


@pytest.mark.parametrize("seed", [5, 8, 14, 20])
def test_loads_of_resources_are_what_their_users_add(seed: int) -> None:
    results = Results(analyse_architecture(architecture(random_robot_text(seed))), {})
    used = {name: load for name, load in results.analysis.resources.items() if load.shares}
    for name, load in used.items():
        equations = [each for line in print_reasons(results, name) for each in read_equations(line)]
        assert len(equations) == len(load.shares)
        assert all(each.holds for each in equations)
        assert any("from asking until done" in line for line in print_reasons(results, name))
    assert used


@pytest.mark.parametrize("seed", [5, 8, 14, 20])
@pytest.mark.parametrize("is_fair", [False, True])
def test_responses_of_threads_that_wait_follow_from_the_work_and_the_waits_that_are_listed(
    seed: int, *, is_fair: bool
) -> None:
    results = Results(analyse_architecture(architecture(random_robot_text(seed), is_fair=is_fair)), {})
    waiting = [activity.id for activity in results.analysis.system.activities.values() if activity.suspends]
    for name in waiting:
        lines, worst = print_reasons(results, name), results.analysis.responses[name].worst.value
        assert [(line, each) for line in lines for each in read_equations(line) if not each.holds] == [], name
        if worst and not any(line.startswith("A = ") for line in lines):
            assert is_close(recompute_response(lines, name) or Fraction(0), worst), name
    assert waiting


@pytest.mark.parametrize("seed", list_seeds(24))
def test_responses_of_threads_and_queues_follow_from_the_work_that_is_listed(seed: int) -> None:
    model = architecture(random_threads_text(seed))
    results = Results(analyse_architecture(model), {})
    for name, response in results.analysis.responses.items():
        lines = print_reasons(results, name)
        assert [(line, each) for line in lines for each in read_equations(line) if not each.holds] == [], name
        if response.tier in QUEUE_TIERS | {"host", "priorities"} and response.worst.value:
            assert is_close(recompute_response(lines, name) or Fraction(0), response.worst.value), (name, response.tier)
