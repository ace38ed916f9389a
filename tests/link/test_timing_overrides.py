"""Figures laid over an architecture: what can be said, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.link.process_overrides import OverrideError
from archgen.link.timing_overrides import TimingOverride, apply_overrides, read_override
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import Trigger
from archgen.model.quantity import parse_quantity
from archgen.pipeline import check_project
from archgen.schema import normalise_document
from archgen.syntax import yaml_parser
from tests.linking import link_table

PROJECT = """
groups:
  see:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}, timing: {rate: 10 Hz, wcet: 5 ms}}
      finder: {inputs: {image: camera.image}, timing: {bcet: 2 ms}}
      twice: {outputs: {x: std_msgs/msg/String}}
nodes:
  cam: {implements: camera}
  find: {implements: finder}
  one: {implements: twice}
  two: {implements: twice}
  both: {implements: [see.camera, see.finder]}
"""


@pytest.fixture
def architecture(tmp_path: Path) -> Architecture:
    file = tmp_path / "project.yaml"
    file.write_text(PROJECT.replace("  both: {implements: [see.camera, see.finder]}\n", ""))
    return check_project(file).architecture


def test_a_figure_is_laid_over_a_node_or_its_component(architecture: Architecture) -> None:
    for element in ("find", "finder", "see.finder", "find.finder"):
        changed = apply_overrides(architecture, [f"{element}.timing.wcet=120ms", f"{element}.timing.priority=7"])
        timing = changed.nodes["find"].timing["see.finder"]
        assert (str(timing.wcet), str(timing.bcet), timing.priority) == ("120 ms", "2 ms", 7)
    assert architecture.nodes["find"].timing["see.finder"].wcet is None


def test_a_period_replaces_a_rate(architecture: Architecture) -> None:
    timing = apply_overrides(architecture, ["cam.timing.period=50 ms"]).nodes["cam"].timing["see.camera"]
    assert (timing.rate, str(timing.period)) == (None, "50 ms")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("cam.timing.wcet", "`cam.timing.wcet` is not ELEMENT.timing.KEY=VALUE, for instance"),
        ("cam.wcet=3 ms", "`cam.wcet=3 ms` is not ELEMENT.timing.KEY=VALUE"),
        ("camm.timing.wcet=3 ms", "nothing is called `camm`; did you mean `cam`?"),
        ("cam.timing.wect=3 ms", "`timing` has no key `wect` that can be set; did you mean `wcet`?"),
        ("cam.timing.wcet=3", "`wcet` takes a duration such as 120 ms"),
        ("cam.timing.rate=3 ms", "`rate` takes a frequency such as 10 Hz"),
        ("cam.timing.every=x", "`every` takes a whole number, not `x`"),
        ("cam.timing.behaviour=often", "`behaviour` takes periodic, event, on_demand, once, not `often`"),
        ("cam.timing.period=0 ms", "cam: a period cannot be zero"),
        (
            "find.timing.wcet=1 ms",
            "find: the best case execution time (`bcet`, 2 ms) is above the worst (`wcet`, 1 ms)",
        ),
        ("twice.timing.wcet=1 ms", "2 nodes implement `see.twice`: name one of them (one, two)"),
    ],
)
def test_what_makes_no_sense_is_refused(architecture: Architecture, text: str, said: str) -> None:
    with pytest.raises(OverrideError) as caught:
        apply_overrides(architecture, [text])
    assert str(caught.value).startswith(said)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "timing.wcet=3 ms",
            "`timing.wcet=3 ms` is not ELEMENT.timing.KEY=VALUE, for instance object_recognizer.timing.wcet=120ms, nor ELEMENT.KEY=VALUE, for instance sensor_box.threads=2",
        ),
        (
            ".timing.wcet=3 ms",
            "`.timing.wcet=3 ms` is not ELEMENT.timing.KEY=VALUE, for instance object_recognizer.timing.wcet=120ms, nor ELEMENT.KEY=VALUE, for instance sensor_box.threads=2",
        ),
        (
            "cam.timing.xyzzy=3 ms",
            (
                "`timing` has no key `xyzzy` that can be set: use period, rate, jitter, wcet, bcet, throttle, response,"
                " deadline, every, priority, core, cores, behaviour, trigger, dropped, inputs.INPUT.wcet, uses.RESOURCE"
            ),
        ),
        ("cam.timing.wcet=3", "`wcet` takes a duration such as 120 ms (units: ns us ms s min h), not `3`"),
        ("cam.timing.rate=3 ms", "`rate` takes a frequency such as 10 Hz (units: Hz kHz), not `3 ms`"),
        ("cam.timing.trigger=some", "`trigger` takes any, all, or inputs, such as [scan], not `some`"),
        ("cam.timing.every=-1", "`every` takes a whole number, not `-1`"),
        ("cam.timing.every=\u0663", "`every` takes a whole number, not `\u0663`"),
        ("cam.timing.every=1234567890", "`every` takes a whole number, not `1234567890`; that has too many digits"),
        ("cam.timing.behaviour=123456789", "`behaviour` takes periodic, event, on_demand, once, not `123456789`"),
        ("xyzzy.timing.wcet=3 ms", "nothing is called `xyzzy`; `archgen list` gives the names of all elements"),
        ("findr.timing.wcet=3 ms", "nothing is called `findr`; did you mean `find`?"),
        ("cam.finder.timing.wcet=3 ms", "nothing is called `cam.finder`; did you mean `hear.finder`?"),
        ("unmapped.timing.wcet=3 ms", "no node implements `see.unmapped`: its timing counts nowhere"),
        ("same.timing.wcet=3 ms", "`same` may mean see.same, hear.same"),
        ("find.timing.every=0", "find: `every` is 1 or more; `every: 3` fires at each third input"),
        (
            "cam.timing.bcet=6 ms",
            "cam: the best case execution time (`bcet`, 6 ms) is above the worst (`wcet`, 5 ms); exchange them, or leave `bcet` out",
        ),
    ],
)
def test_a_refusal_says_what_would_do(text: str, message: str) -> None:
    with pytest.raises(OverrideError) as caught:
        apply_overrides(judged(NAMES), [text])
    assert str(caught.value) == message


NAMES = """
groups:
  see:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}, timing: {rate: 10 Hz, wcet: 5 ms}}
      finder: {inputs: {image: camera.image}, timing: {bcet: 2 ms}}
      unmapped: {title: Unmapped}
      same: {title: Same}
  hear: {components: {same: {title: Same}, finder: {title: Finder}}}
nodes:
  cam: {implements: see.camera}
  find: {implements: see.finder}
  both: {implements: [see.same, hear.same]}
  listen: {implements: hear.finder}
  alone: {}
"""


def judged(text: str) -> Architecture:
    """Link a project of one file; its findings do not matter here."""
    document, _ = yaml_parser.parse_yaml("a.yaml", text)
    assert document is not None
    normalise_document(document)
    return link_table(document.root)[0]


@pytest.mark.parametrize(
    ("element", "activities"),
    [
        ("cam", {("cam", "see.camera")}),
        ("see.camera", {("cam", "see.camera")}),
        ("camera", {("cam", "see.camera")}),
        ("both", {("both", "see.same"), ("both", "hear.same")}),
        ("both.see.same", {("both", "see.same")}),
        ("find.finder", {("find", "see.finder")}),
        ("see.finder", {("find", "see.finder")}),
        ("alone", {("alone", "")}),
    ],
)
def test_an_override_concerns_the_activities_of_its_element(element: str, activities: set[tuple[str, str]]) -> None:
    overrides = read_override(judged(NAMES), f" {element}.timing.priority= 7 ")
    assert {(o.node, o.component) for o in overrides if isinstance(o, TimingOverride)} == activities
    assert {str(o) for o in overrides} == {f"{node}.timing.priority=7" for node, _ in activities}


def test_a_name_that_a_node_has_twice_is_none_of_its_activities() -> None:
    with pytest.raises(OverrideError) as caught:
        read_override(judged(NAMES), "both.same.timing.priority=7")
    assert str(caught.value).startswith("nothing is called `both.same`")


@pytest.mark.parametrize(
    ("text", "key", "value"),
    [
        ("every=999999999", "every", 999_999_999),
        ("core=0", "core", 0),
        ("behaviour=on_demand", "behaviour", "on_demand"),
        ("trigger=all", "trigger", Trigger("all")),
        ("jitter=1.5 ms", "jitter", parse_quantity("1.5 ms", "duration")),
    ],
)
def test_values_are_read_by_their_keys(text: str, key: str, value: object) -> None:
    timing = apply_overrides(judged(NAMES), [f"find.timing.{text}"]).nodes["find"].timing["see.finder"]
    assert getattr(timing, key) == value


def test_an_override_stands_where_the_figure_stood() -> None:
    architecture = judged(NAMES)
    before = architecture.nodes["cam"].timing["see.camera"]
    rated = apply_overrides(architecture, ["cam.timing.rate=20 Hz"]).nodes["cam"].timing["see.camera"]
    assert rated.places == before.places
    timed = apply_overrides(architecture, ["cam.timing.period=20 ms"]).nodes["cam"].timing["see.camera"]
    assert timed.places == {"wcet": before.places["wcet"], "period": before.at}
    assert (timed.rate, timed.wcet) == (None, before.wcet)
    back = apply_overrides(architecture, ["cam.timing.period=20 ms", "cam.timing.rate=5 Hz"])
    assert back.nodes["cam"].timing["see.camera"].period is None
    alone = apply_overrides(architecture, ["alone.timing.wcet=1 ms"]).nodes["alone"]
    assert (alone.timing[""].at, alone.timing[""].places) == (alone.at, {"wcet": alone.at})


def test_overrides_that_make_sense_together_may_be_given_one_by_one() -> None:
    timing = apply_overrides(judged(NAMES), ["cam.timing.bcet=6 ms", "cam.timing.wcet=7 ms"]).nodes["cam"].timing
    assert (str(timing["see.camera"].bcet), str(timing["see.camera"].wcet)) == ("6 ms", "7 ms")


def test_of_many_elements_that_may_be_meant_six_are_named() -> None:
    groups = "".join(f"  g{n}: {{components: {{same: {{title: Same}}}}}}\n" for n in range(8))
    nodes = "".join(f"  n{n}: {{implements: g0.same}}\n" for n in range(8))
    architecture = judged(f"groups:\n{groups}nodes:\n{nodes}")
    for element, message in (
        ("same", "`same` may mean g0.same, g1.same, g2.same, g3.same, g4.same, g5.same"),
        ("g0.same", "8 nodes implement `g0.same`: name one of them (n0, n1, n2, n3, n4, n5)"),
    ):
        with pytest.raises(OverrideError) as caught:
            read_override(architecture, f"{element}.timing.wcet=1 ms")
        assert str(caught.value) == message


TYPED = """
libraries: {lib: {component_types: {laser: {outputs: {scan: sensor_msgs/msg/LaserScan}, timing: {rate: 10 Hz, wcet: 5 ms}}}}}
component_types:
  wide: {is: lib.laser, timing: {wcet: 7 ms}}
  lonely: {outputs: {o: std_msgs/msg/Empty}}
  pair: {components: {left: {is: lib.laser}, log: {inputs: {scan: left.scan}}}}
groups:
  see:
    components:
      front: {same_as: lib.laser}
      rear: {is: wide}
      pair: {is: pair}
      screen: {inputs: {front: front.scan, rear: rear.scan}}
nodes: {n: front, rear: rear, left: pair.left, log: pair.log, screen: screen}
"""


def test_of_a_component_type_all_instances_are_meant(tmp_path: Path) -> None:
    file = tmp_path / "project.yaml"
    file.write_text(TYPED)
    architecture = check_project(file).architecture
    nodes = apply_overrides(architecture, ["lib.laser.timing.wcet=9ms"]).nodes
    set_nodes = {name for name, node in nodes.items() for each in node.timing.values() if str(each.wcet) == "9 ms"}
    assert set_nodes == {"n", "rear", "left"}
    for element, reason in (("lonely", "no instance"), ("pair", "no instance without components inside")):
        with pytest.raises(OverrideError, match=f"`{element}` is a component type, and .*{reason}"):
            apply_overrides(architecture, [f"{element}.timing.wcet=9ms"])
    with pytest.raises(OverrideError, match=r"nothing is called `lib.lazer`; did you mean `lib.laser`?"):
        apply_overrides(architecture, ["lib.lazer.timing.wcet=9ms"])
    with pytest.raises(
        OverrideError, match=r"`see.pair` is composed: name a component inside \(see.pair.left, see.pair.log\)"
    ):
        apply_overrides(architecture, ["see.pair.timing.wcet=9ms"])
