"""What an element takes in and gives out: from which sensor, how old, and what a chain would say of it."""

from __future__ import annotations

from archgen.model.architecture import Architecture
from archgen.simulation.chain_witnesses import judge_chains
from archgen.timing.chains.element_flows import ElementFlow, FlowFinder
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.printed import show_ms
from tests.timing.sketches import read_sketch

NODES = {
    "camera @h": "period: 30 ms, wcet: 2 ms",
    "map @h": "period: 1 s, wcet: 1 ms",
    "detect @h": "behaviour: event, trigger: [camera], wcet: 5 ms",
    "plan @k": "period: 100 ms, wcet: 10 ms",
    "drive @k": "period: 20 ms, wcet: 1 ms",
}
WIRES = "light>camera camera>detect map>detect detect>plan drive>plan plan>drive road>drive"
REST = (
    "hosts: {h: {cores: 1, scheduling: fixed_priority}, k: {cores: 1, scheduling: fixed_priority}}\n"
    "links: {lan: {connects: [h, k], latency: {best: 1 ms, worst: 3 ms}}}\n"
)
CHAIN = "chains: {see: {through: [camera, detect, plan], deadline: 1 s}}\n"


def _find(model: Architecture) -> FlowFinder:
    analysis = analyse_architecture(model)
    return FlowFinder(analysis, model, judge_chains(analysis, model).values())


def _write(flow: ElementFlow) -> str:
    chains = ",".join(chain.id for chain in flow.chains)
    way = ">".join(flow.way)
    figures = " ".join(map(show_ms, (flow.pace.gap, flow.age, flow.since_sensing, flow.wait)))
    return f"{flow.arc.input.rpartition('.')[2]}: {figures} {way}{' fires' if flow.triggers else ''} [{chains}]"


def test_each_flow_has_its_age_since_the_sensor_and_its_deadlines() -> None:
    finder = _find(read_sketch(NODES, WIRES, REST + CHAIN))
    assert list(map(_write, finder.list_taken(["plan"]))) == [
        # The map is read by what the camera fires: it is nothing that the detector works on. 8 = 1 + 2 + 5 on one core.
        "detect: 46 11 19 101 camera>detect>plan [see]",
        # What moves the robot knows where it stands: the way does not go on to what told it to.
        "drive: 31 11 11 101 drive>plan []",
    ]
    assert [_write(flow).partition(":")[0] for flow in finder.list_given(["plan"])] == ["plan"]
    (fired, _) = sorted(map(_write, finder.list_taken(["detect"])))
    assert fired.startswith("camera: ")
    assert fired.endswith(" fires [see]")


def test_what_is_inside_of_an_element_is_neither_taken_nor_given() -> None:
    finder = _find(read_sketch(NODES, WIRES, REST))
    assert [flow.arc.source for flow in finder.list_taken(["camera", "detect"])] == ["map"]
    assert [flow.arc.target for flow in finder.list_given(["plan", "drive"])] == []


def test_a_chain_says_what_was_said_without_it() -> None:
    finder = _find(read_sketch(NODES, WIRES, REST))
    ways = list(finder.list_unjudged(finder.list_taken(["plan"])))
    assert [way.through for way in ways] == [("camera", "detect", "plan"), ("drive", "plan")]
    for way in ways:
        chain = f"chains: {{c: {{through: [{', '.join(way.through)}]}}}}\n"
        model = read_sketch(NODES, WIRES, REST + chain)
        assert way.duration is not None
        assert judge_chains(analyse_architecture(model), model)["c"].bound.value == way.duration.value


def test_inputs_with_a_deadline_are_judged() -> None:
    finder = _find(read_sketch(NODES, WIRES, REST + CHAIN))
    assert [way.through for way in finder.list_unjudged(finder.list_taken(["plan"]))] == [("drive", "plan")]
