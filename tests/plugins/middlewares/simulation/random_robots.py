"""Random architectures, and scenarios for them.

Messages that make a component active go from earlier components to later ones: none goes round.
"""

from __future__ import annotations

import json
import math
import random
import struct
from dataclasses import dataclass, field

TYPES = """\
  Words:
  Count: {fields: {n: int64}}
  Level: {fields: {x: float64, small: {type: float32, default: 0.1}}}
  Mode: {values: [IDLE, MOVING, STOPPED]}
  Batch: {fields: {levels: "Level[]", words: "string[<=3]", on: bool, mode: {type: Mode}, pair: "float64[2]", bytes: "uint8[]"}}
  Ask: {request: {n: int64}, response: {n: int64}}
  Go: {request: {to: int64}, response: {done: bool}, feedback: {share: float64}}
"""
MESSAGES = ("Words", "Count", "Level", "Batch")
CLOCKS = ("{period: 3 ms}", "{period: 7 ms}", "{rate: 300 Hz}", "{rate: 70 Hz}")
EVENTS = (
    "{behaviour: event}",
    "{trigger: [i0]}",
    "{trigger: {all: [i0, i1]}}",
    "{trigger: {match: [i0, i1], within: 2 ms}}",
    "{trigger: {match: [i0, i1], within: 0 ms}, every: 2}",
    "{trigger: [i1], every: 2}",
    "{behaviour: event, every: 3, dropped: forgotten}",
    "{behaviour: event, throttle: 2500 us}",
    "{trigger: {all: [i0, i1]}, throttle: 4 ms, dropped: forgotten}",
)


@dataclass
class Kind:
    """What one class of the program is: the types of its ports."""

    class_name: str
    inputs: list[str]
    outputs: list[str]
    timing: str
    calls: list[str] = field(default_factory=list)
    answers: bool = False


@dataclass
class Robot:
    """An architecture: `text` is its YAML, and `inputs` and `outputs` have the types of its ports by their ids."""

    name: str
    text: str
    kinds: list[Kind]
    inputs: dict[str, str]
    outputs: dict[str, str]


@dataclass
class _Place:
    """A component of a robot: of what kind, and where."""

    name: str
    group: str
    kind: Kind
    form: str

    @property
    def outputs(self) -> dict[str, str]:
        return {f"{self.group}.{self.name}.o{index}": each for index, each in enumerate(self.kind.outputs)}


def make_robot(seed: int) -> Robot:
    """Return the architecture of a seed."""
    pick = random.Random(seed)  # noqa: S311 - no secret
    types = [_make_kind(pick, f"Kind{number}", MESSAGES) for number in range(2)]
    # The first one sends all types, and answers: who reads finds somebody.
    places = [_Place("c0", "g0", Kind("C0", [], list(MESSAGES), CLOCKS[0], answers=True), "plain")]
    for number in range(1, pick.randint(8, 11)):
        form = pick.choice(("plain", "plain", "composed", "instance", "instance"))
        class_name = f"C{number}Inner" if form == "composed" else f"C{number}"
        kind = pick.choice(types) if form == "instance" else _make_kind(pick, class_name, (*MESSAGES, "any"))
        if form != "instance":
            kind.calls = pick.sample(("ask", "go"), pick.randint(0, 2))
        places.append(_Place(f"c{number}", f"g{number % 2}", kind, form))
    kinds = {each.kind.class_name: each.kind for each in places}
    robot = Robot(f"robot{seed}", "", list(kinds.values()), {}, {})
    lines: dict[str, list[str]] = {"g0": [], "g1": []}
    for number, place in enumerate(places):
        # Who is active by the clock may read what goes back; with others, messages would go round.
        others = places if place.kind.timing in CLOCKS else places[:number]
        sources = {name: each for other in others if other is not place for name, each in other.outputs.items()}
        wires = [_choose_sources(pick, each, sources) for each in place.kind.inputs]
        lines[place.group].append(_write_component(pick, place, wires))
        inner = f"{place.group}.{place.name}" + (".inner" if place.form == "composed" else "")
        robot.inputs.update(
            (f"{inner}.i{index}", each) for index, each in enumerate(place.kind.inputs) if each != "any"
        )
        robot.outputs.update((f"{inner}.o{index}", each) for index, each in enumerate(place.kind.outputs))
    robot.text = _write_project(robot.name, types, lines)
    return robot


def _make_kind(pick: random.Random, class_name: str, types: tuple[str, ...]) -> Kind:
    inputs = [pick.choice(types) for _ in range(pick.randint(2, 3))]
    timing = pick.choice(CLOCKS) if pick.random() < 0.3 else pick.choice((*EVENTS, "{behaviour: once}"))
    return Kind(class_name, inputs, [pick.choice(MESSAGES) for _ in range(pick.randint(1, 3))], timing)


def _choose_sources(pick: random.Random, value_type: str, sources: dict[str, str]) -> list[str]:
    if value_type == "any":
        # Two types at least, so that it is an input of any.
        kinds = pick.sample(sorted(set(sources.values())), 2)
        return [pick.choice([each for each in sources if sources[each] == kind]) for kind in kinds]
    fitting = [each for each in sources if sources[each] == value_type]
    return pick.sample(fitting, min(len(fitting), pick.randint(1, 2)))


def _write_component(pick: random.Random, place: _Place, wires: list[list[str]]) -> str:
    name, kind = place.name, place.kind
    gain = f"parameters: {{gain: {pick.choice((0.1, 1.5, -0.25, 3.0))}}}"
    inputs = {f"i{index}": f"{{from: [{', '.join(each)}]}}" for index, each in enumerate(wires)}
    if place.form == "instance":
        return f"{name}: {{is: {kind.class_name.lower()}, inputs: {_write_map(inputs)}, {gain}}}"
    calls = {each: f"g0.c0.{each}" for each in kind.calls}
    outputs = {f"o{index}": each for index, each in enumerate(kind.outputs)}
    if kind.answers:
        outputs |= {"ask": "Ask", "go": "Go"}
    if place.form == "plain":
        ports = f"inputs: {_write_map(inputs | calls)}, outputs: {_write_map(outputs)}"
        return f"{name}: {{functionality: F, {ports}, {gain}, timing: {kind.timing}}}"
    own_inputs = {each: f"self.{each}" for each in inputs} | calls
    inner = f"{{functionality: F, inputs: {_write_map(own_inputs)}, outputs: {_write_map(outputs)}, {gain}, timing: {kind.timing}}}"
    around = {each: f"{{from: inner.{each}}}" for each in outputs}
    ports = f"inputs: {_write_map(inputs)}, outputs: {_write_map(around)}"
    return f"{name}: {{functionality: F, {ports}, components: {{inner: {inner}}}}}"


def _write_map(entries: dict[str, str]) -> str:
    return "{" + ", ".join(f"{key}: {value}" for key, value in entries.items()) + "}"


def _write_project(name: str, types: list[Kind], lines: dict[str, list[str]]) -> str:
    text = f"archgen: 1\nproject: {{id: {name}}}\nrules: {{missing-detail: off}}\ntypes:\n{TYPES}component_types:\n"
    for kind in types:
        inputs = _write_map({f"i{index}": each for index, each in enumerate(kind.inputs)})
        outputs = _write_map({f"o{index}": each for index, each in enumerate(kind.outputs)})
        text += (
            f"  {kind.class_name.lower()}: {{functionality: F, inputs: {inputs}, outputs: {outputs}, "
            f"parameters: {{gain: 2.0}}, timing: {kind.timing}}}\n"
        )
    text += "groups:\n"
    for group, written in lines.items():
        text += f"  {group}:\n    components:\n" + "".join(f"      {each}\n" for each in written)
    return text


def make_scenario(robot: Robot, seed: int, *, line_count: int = 60) -> str:
    """Return values from outside at random times, among them odd ones."""
    pick = random.Random(seed)  # noqa: S311 - no secret
    lines = []
    for _ in range(line_count):
        mark, ports = pick.choice((("<", robot.inputs), (">", robot.outputs)))
        port = pick.choice(sorted(ports))
        time = pick.choice((f"{pick.randint(0, 40)}ms", f"{pick.randint(0, 40)}.5ms", str(pick.randint(0, 40_000_000))))
        lines.append(f"{time} {mark} {port} {_write_value(pick, ports[port])}\n")
    return "".join(lines)


def _write_value(pick: random.Random, value_type: str) -> str:
    if value_type == "Words":
        return json.dumps(_make_text(pick), ensure_ascii=pick.random() < 0.5)
    if value_type == "Count":
        return json.dumps(pick.choice(({"n": pick.randint(-(2**63), 2**63 - 1)}, {"n": 2**63 - 1}, {"n": -1}, {})))
    level = {"x": _make_number(pick), "small": _make_number(pick)}
    if value_type == "Level":
        return json.dumps(pick.choice((level, {"x": level["x"]}, {"small": 3})))
    batch = {
        "levels": [{"x": _make_number(pick)} for _ in range(pick.randint(0, 3))],
        "words": [_make_text(pick) for _ in range(pick.randint(0, 3))],
        "on": pick.random() < 0.5,
        "mode": {"value": pick.randint(0, 2)},
        "pair": [_make_number(pick), 7],
        "bytes": [pick.randint(0, 255) for _ in range(pick.randint(0, 3))],
    }
    return json.dumps({key: value for key, value in batch.items() if pick.random() < 0.7})


def _make_number(pick: random.Random) -> float:
    if pick.random() < 0.1:
        return pick.choice(
            (math.nan, math.inf, -math.inf, -0.0, 5e-324, 1.7976931348623157e308, 2.2250738585072014e-308)
        )
    if pick.random() < 0.5:
        return round(pick.uniform(-1000, 1000), pick.randint(0, 6))
    # Any bits.
    (number,) = struct.unpack("<d", pick.randbytes(8))
    return number if math.isfinite(number) else 0.5


def _make_text(pick: random.Random) -> str:
    letters = ["a", "B", " ", '"', "\\", "\n", "\t", "\x7f", "\xe9", "\u2028", "\u2603", "\U0001f916", "/", "<", "{"]
    return "".join(pick.choices(letters, k=pick.randint(0, 6)))
