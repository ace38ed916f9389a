"""What is recorded of a late run: it is the run of the witness, nothing overlaps, and the way adds up."""

from __future__ import annotations

import re
from collections import defaultdict
from itertools import pairwise

import pytest

from archgen.simulation.chain_witnesses import find_publish_pauses
from archgen.simulation.schedule_log import LateSchedule, record_schedule
from archgen.timing.run_analysis import analyse_architecture
from tests.property_sizes import list_seeds
from tests.running import ROOT
from tests.simulation.late_robot import analyse, record_witnesses
from tests.timing.random_styles import random_style_text
from tests.timing.random_systems import architecture

_NEVER_SEEN_LATE = {24}
"""No run of this project takes half of a bound."""


def _check_schedule(schedule: LateSchedule) -> None:
    """Check that steps follow one another without a gap, and that no thread and no resource does two things at once."""
    assert all(earlier.end == later.start for earlier, later in pairwise(schedule.way))
    assert all(step.end > step.start for step in schedule.way)
    assert all(
        time <= step.end - step.start for step in schedule.way for _, time in step.holders if step.kind == "queues"
    )
    uses = defaultdict(list)
    for track in schedule.tracks:
        assert all(earlier.end <= later.start for earlier, later in pairwise(track.spans))
        for span in track.spans:
            assert span.end > span.start
            assert (span.state in {"uses", "awaits"}) == bool(span.resource)
            if span.state == "uses":
                uses[span.resource].append((span.start, span.end))
    for times in uses.values():
        assert all(earlier[1] <= later[0] for earlier, later in pairwise(sorted(times)))


def test_the_recorded_run_is_that_of_the_witness_and_names_who_held_the_thread() -> None:
    witness, schedule = record_witnesses()["stop"]
    assert schedule.longest == witness.longest > 250 * 10**6
    assert schedule.orders == witness.orders
    _check_schedule(schedule)
    longest = max(schedule.way, key=lambda step: step.end - step.start)
    assert longest.words == "until costmap looks for the last time"
    assert longest.holders[0][0] == "planner"
    assert {track.name for track in schedule.tracks} == {"lidar", "box", "detector", "other"}
    assert {step.activity for step in schedule.way} == {"lidar", "costmap", "detector"}


AGED = """groups: {g: {components: {
  eye: {outputs: {o: T}}, map: {outputs: {o: T}}, drive: {inputs: {i: g.eye.o}, outputs: {o: {type: T, external: world}}}}}}
hosts: {pc: {cores: 2}}
containers: {box: {host: pc, threads: 1}}
nodes:
  eye: {implements: g.eye, host: pc, timing: {period: 50 ms, wcet: 1 ms, bcet: 1 ms}}
  map: {implements: g.map, container: box, timing: {period: 1 s, wcet: 300 ms, bcet: 300 ms}}
  drive: {implements: g.drive, container: box, timing: {period: 10 ms, wcet: 1 ms, bcet: 1 ms}}
chains: {stop: {through: [g.eye, g.drive], deadline: 200 ms}}
"""


def test_what_is_read_again_since_the_newer_is_not_stored_is_laid_at_who_keeps_the_reader_busy() -> None:
    _, schedule = record_witnesses(AGED)["stop"]
    (step,) = [step for step in schedule.way if step.kind == "rereads"]
    assert (step.words, step.holders[0][0]) == ("until drive looks for the last time", "map")


def test_what_is_read_again_since_nothing_newer_is_sent_is_laid_at_who_keeps_the_sender_busy() -> None:
    page = (ROOT / "docs/timing_examples.md").read_text(encoding="utf-8")
    _, schedule = record_witnesses(page.partition("# courier.yaml\n")[2].partition("```")[0])["see_to_stop"]
    step = next(step for step in schedule.way if step.activity == "guard")
    assert (step.words, step.holders[0][0]) == ("until guard looks for the last time", "route")


def test_what_is_recorded_is_the_same_each_time() -> None:
    assert record_witnesses() == record_witnesses()


@pytest.mark.parametrize("number", list_seeds(20))
def test_each_late_run_adds_up(number: int) -> None:
    """Of random projects of all styles, with deadlines half of their bounds."""
    seed = 3 * number
    text = random_style_text(seed)
    _, analysis, results = analyse(text)
    pauses = find_publish_pauses(analysis)
    for result in results.values():
        schedule = record_schedule(analysis.system, result.through, seed % 8, 1, pauses)
        if schedule is not None:
            _check_schedule(schedule)
    bounded = [each for each in results.values() if each.bound.complete and each.bound.value]
    for each in bounded:
        deadline = f"{each.id}: {{deadline: {int(each.bound.value or 0) // 2000 or 1} us, "
        text = re.sub(rf"\b{each.id}: \{{(?=through)", deadline, text)
    witnesses = record_witnesses(text)
    assert all(schedule.longest == witness.longest for witness, schedule in witnesses.values())
    assert witnesses or not bounded or seed in _NEVER_SEEN_LATE


DECLARED = """groups: {g: {components: {
  a: {outputs: {o: T}}, b: {inputs: {i: g.a.o}, outputs: {o: {type: T, external: world}}}}}}
hosts: {pc: {cores: 1}}
containers: {box: {host: pc, threads: 1}}
nodes:
  a: {implements: g.a, container: box, timing: {period: 50 ms, wcet: 20 ms, bcet: 0 ms, response: 20 ms}}
  b: {implements: g.b, container: box, timing: {wcet: 3 ms, bcet: 3 ms}}
types: {T: {message: std_msgs/msg/Empty}}
"""


def test_work_that_only_loads_the_host_is_not_on_the_way() -> None:
    """The job of `a` ends by its declared response; what is done in its thread then had the number of the last job of `b`."""
    system = analyse_architecture(architecture(DECLARED)).system
    for seed in range(8):
        schedule = record_schedule(system, ("a", "b"), seed, 2, {})
        assert schedule is not None
        spans = [span for track in schedule.tracks for span in track.spans]
        assert {span.activity for span in spans} == {"a", "b"}
        assert {span.activity for span in spans if span.is_on_way} == {"b"}
