"""What is declared of timing, in words."""

from __future__ import annotations

import pytest

from archgen import pipeline
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import Timing
from archgen.views import timing_words

ROBOT = """\
archgen: 1
project: {id: robot}
groups:
  g:
    components:
      clock: {outputs: {tick: Tick}, timing: {period: 10 ms, jitter: 1 ms, wcet: 2 ms, bcet: 1 ms, priority: 7, core: 1}}
      both: {inputs: {tick: clock.tick, more: clock.tick}, timing: {trigger: {all: [tick, more]}, every: 2, wcet: 3 ms, deadline: 9 ms}}
      fuse: {inputs: {tick: clock.tick, more: clock.tick}, timing: {trigger: {match: [tick, more], within: 5 ms}, uses: {gpu: {max: 4 ms, min: 1 ms}}}}
      asked: {functionality: Answers., timing: {behaviour: on_demand, response: 8 ms}}
      silent: {functionality: Is there.}
nodes: {hands: {implements: [both, fuse], callback_groups: {quick: [both], lazy: [fuse]}}}
hosts: {pc: {cores: 4, scheduling: {0: edf, 3: fifo}}}
resources: {gpu: {host: pc}}
"""


@pytest.fixture(scope="module")
def architecture(tmp_path_factory: pytest.TempPathFactory) -> Architecture:
    file = tmp_path_factory.mktemp("robot") / "robot.yaml"
    file.write_text(ROBOT, encoding="utf-8")
    return pipeline.check_project(file).architecture


@pytest.mark.parametrize(
    ("component", "sentence", "cell"),
    [
        ("clock", "period 10 ms; jitter 1 ms; execution 1 ms to 2 ms; priority 7; core 1", "10 ms, up to 2 ms"),
        (
            "both",
            "triggered by all of tick, more; fires at each 2nd; execution up to 3 ms; deadline 9 ms",
            "up to 3 ms",
        ),
        ("fuse", "triggered by matching messages of tick, more, at most 5 ms apart; uses gpu 1 ms to 4 ms", ""),
        ("asked", "on demand; declared response 8 ms", "on demand"),
        ("silent", "", ""),
    ],
)
def test_a_sentence_for_a_page_and_a_cell_for_a_table(
    architecture: Architecture, component: str, sentence: str, cell: str
) -> None:
    timing = architecture.components[f"g.{component}"].timing
    assert timing_words.format_timing_sentence(timing) == sentence
    assert timing_words.format_short_timing(timing) == cell


def test_callback_groups_and_orders_of_cores(architecture: Architecture) -> None:
    assert timing_words.format_callback_groups(architecture.nodes["hands"]) == "quick: both; lazy: fuse"
    assert timing_words.format_core_orders(architecture.hosts["pc"]) == "core 0 edf, core 3 fifo"


@pytest.mark.parametrize(
    ("every", "word"), [(3, "3rd"), (4, "4th"), (11, "11th"), (12, "12th"), (21, "21st"), (113, "113th")]
)
def test_which_trigger_fires(every: int, word: str) -> None:
    assert timing_words.format_timing_sentence(Timing(every=every)) == f"fires at each {word}"
