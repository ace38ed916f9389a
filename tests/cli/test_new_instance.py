"""`archgen new type`, `new instance` and components inside of composed ones: text in the right place, and clear refusals."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.pipeline import CheckedProject, check_project
from tests.cli.conftest import Run
from tests.running import contents

ROBOT = """\
archgen: 1
component_types:
  motor:
    inputs: {target: Goal, current: {type: Current, external: The battery}, limit: {type: Goal, optional: true}}
    outputs: {state: Goal}
    node: {package: arms, executable: motor}
  filter: {generic: [T], inputs: {raw: T}, outputs: {clean: T}}
  tool: {abstract: true, outputs: {state: Goal}}
  gripper: {is: tool}
  arm:
    inputs: {target: Goal}
    components:
      elbow: {is: motor, inputs: {target: self.target}}
groups:
  body:
    components:
      left:
        is: arm
        inputs: {target: planner.goal}
      planner:
        outputs: {goal: Goal}
      head:
        components:
          eye:
            outputs: {image: Image}
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Give a project in one file."""
    file = tmp_path / "robot.yaml"
    file.write_text(ROBOT, encoding="utf-8")
    return file


def add(run: Run, file: Path, *words: str) -> str:
    """Return the lines that are added to ROBOT; all others stay."""
    ran = run("new", *words, "-C", file)
    assert ran.status == 0, ran.err
    lines, old = file.read_text(encoding="utf-8").splitlines(keepends=True), ROBOT.splitlines(keepends=True)
    start = next((n for n, line in enumerate(old) if lines[n] != line), len(old))
    count = len(lines) - len(old)
    assert lines[:start] + lines[start + count :] == old
    return "".join(lines[start : start + count])


def check_sound(file: Path) -> CheckedProject:
    """Return the project, which has no errors."""
    checked_project = check_project(file)
    assert [finding for finding in checked_project.findings if finding.severity is Severity.ERROR] == []
    return checked_project


def test_an_instance_lists_the_inputs_that_nothing_feeds(run: Run, robot: Path) -> None:
    assert add(run, robot, "instance", "body.wheel", "motor", "--title", "Left wheel") == (
        "      wheel:\n        is: motor\n        title: Left wheel\n"
        "        inputs:\n          target:  # component.output of type Goal\n"
    )
    component = check_sound(robot).architecture.components["body.wheel"]
    assert (component.component_type, component.inputs["target"].type) == ("motor", "Goal")


def test_the_inputs_to_feed_are_said_in_braces_too(run: Run, tmp_path: Path) -> None:
    text = (
        "archgen: 1\ncomponent_types: {motor: {inputs: {target: Goal}}}\n"
        "groups:\n  body:\n    components:\n      a: {title: A}\n"
    )
    (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
    ran = run("new", "instance", "body.b", "motor", "-C", tmp_path / "robot.yaml")
    assert (tmp_path / "robot.yaml").read_text(encoding="utf-8") == f"{text}      b: {{is: motor, title: B}}\n"
    assert "Say what feeds `target`, where nothing does yet." in ran.out


def test_an_instance_of_a_generic_type_has_the_types_that_it_names(run: Run, robot: Path) -> None:
    assert "raw:  # component.output of type Image\n" in add(run, robot, "instance", "body.smooth", "filter<Image>")
    assert check_sound(robot).architecture.outputs["body.smooth.clean"].type == "Image"


def test_a_second_instance_makes_ids_of_nodes_longer_and_says_so(run: Run, robot: Path) -> None:
    assert set(check_sound(robot).architecture.nodes) >= {"elbow"}
    ran = run("new", "instance", "body.right", "arm", "-C", robot)
    assert ran.status == 0
    assert ran.err == "the node `elbow` gets the id `left_elbow`, since its id follows from its component\n"
    assert set(check_sound(robot).architecture.nodes) >= {"left_elbow", "right_elbow"}


def test_what_leads_to_a_node_of_an_instance_is_not_lost(run: Run, robot: Path) -> None:
    text = ROBOT + "chains:\n  reach: {through: [planner, elbow]}\n"
    robot.write_text(text, encoding="utf-8")
    ran = run("new", "instance", "body.right", "arm", "-C", robot)
    assert (ran.status, robot.read_text(encoding="utf-8")) == (2, text)
    assert "elbow" in ran.err
    assert "nothing was written" in ran.err


def test_a_component_goes_inside_of_a_composed_one(run: Run, robot: Path) -> None:
    assert add(run, robot, "component", "body.head.ear").startswith("          ear:\n            title: Ear\n")
    assert check_sound(robot).architecture.shells["body.head"].children == ("body.head.eye", "body.head.ear")


def test_an_instance_goes_inside_of_a_composed_one_in_the_file_that_writes_it(run: Run, tmp_path: Path) -> None:
    start = ROBOT.index("      head:")
    (tmp_path / "archgen.yaml").write_text(f"{ROBOT[:start]}sources: ['*.yaml']\n", encoding="utf-8")
    (tmp_path / "head.yaml").write_text(f"groups:\n  body:\n    components:\n{ROBOT[start:]}", encoding="utf-8")
    before = contents(tmp_path)
    assert run("new", "instance", "body.head.neck", "motor", "-C", tmp_path).status == 0
    assert [file for file, data in contents(tmp_path).items() if data != before[file]] == ["head.yaml"]
    assert check_sound(tmp_path).architecture.components["body.head.neck"].parent == "body.head"


def test_a_type_goes_to_the_other_types(run: Run, robot: Path) -> None:
    assert add(run, robot, "type", "camera", "--generic", "T") == (
        "  camera:\n    title: Camera\n    generic: [T]\n    functionality:  # what it does, in a sentence or two\n"
        "    inputs:  # id: conceptual type\n    outputs:  # id: conceptual type\n"
    )
    assert check_sound(robot).architecture.component_types["camera"].generic == ("T",)


def test_a_type_made_from_a_type_keeps_its_ports(run: Run, robot: Path) -> None:
    assert add(run, robot, "type", "strong_motor", "--is", "motor") == (
        "  strong_motor:\n    is: motor\n    title: Strong Motor\n"
    )
    assert list(check_sound(robot).architecture.component_types["strong_motor"].inputs) == [
        "target",
        "current",
        "limit",
    ]


def test_the_first_type_gets_a_section_in_the_project_file(run: Run, first: Path) -> None:
    before = (first / "archgen.yaml").read_text(encoding="utf-8")
    assert run("new", "type", "camera", "-C", first).status == 0
    now = (first / "archgen.yaml").read_text(encoding="utf-8")
    assert now.startswith(before)
    assert now[len(before) :].lstrip("\n").startswith("component_types:\n  camera:\n    title: Camera\n")
    assert run("new", "instance", "devices.front", "camera", "-C", first).status == 0
    assert check_sound(first).architecture.components["devices.front"].component_type == "camera"


def test_a_type_that_instances_name_already_is_added(run: Run, robot: Path) -> None:
    robot.write_text(ROBOT + "      bell: {is: ringer}\n", encoding="utf-8")
    assert run("new", "type", "ringer", "-C", robot).status == 0
    assert check_sound(robot).architecture.components["body.bell"].component_type == "ringer"


def test_a_node_stands_in_the_place_of_the_one_that_its_component_brings(run: Run, robot: Path) -> None:
    assert run("new", "node", "elbow", "--implements", "left.elbow", "-C", robot).status == 0
    assert check_sound(robot).architecture.nodes["elbow"].implements == ("body.left.elbow",)
    again = run("new", "node", "elbow", "--implements", "left.elbow", "-C", robot)
    assert "there is a node 'elbow' already" in again.err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("instance body.x moter", "no component type named `moter`; did you mean `motor`?"),
        (
            "instance body.x tool",
            "there is no instance of the abstract component type `tool`; name a type that is made from it: `gripper`",
        ),
        (
            "instance body.x filter",
            "`filter` does not say for which type `filter<T>` stands; write `filter<T>` with types of the project",
        ),
        (
            "instance body.x filter<Goal,Image>",
            "`filter<Goal,Image>` does not say for which type `filter<T>` stands; write `filter<T>` with types of the project",
        ),
        (
            "instance body.x motor<Goal>",
            "the component type `motor` is not generic; write `motor`, or give the type `generic: [T]`",
        ),
        ("instance body.left motor", "there is a component 'left' already: robot.yaml:17:7"),
        ("instance body.head.eye motor", "there is a component 'eye' already: robot.yaml:24:11"),
        ("component body.head", "there is a component 'head' already: robot.yaml:22:7"),
        (
            "component body.left.hand",
            "'body.left' is an instance of the type 'arm', which says what is inside; add it to the type: robot.yaml:10:3",
        ),
        (
            "component body.left.elbow.nut",
            "'body.left.elbow' is an instance of the type 'motor', which says what is inside; add it to the type: robot.yaml:3:3",
        ),
        (
            "component body.planner.part",
            "'body.planner' holds no components yet; write `components:` with the first one below it: robot.yaml:20:7",
        ),
        ("component body.hed.ear", "there is no component 'body.hed'; did you mean `body.head`?"),
        ("component bdy.head.ear", "there is no group 'bdy'; did you mean `body`?"),
        ("type motor", "there is a component type 'motor' already: robot.yaml:3:3"),
        ("type fast --is moter", "no component type named `moter`; did you mean `motor`?"),
        ("type Fast", "'Fast' is no id: lower-case words joined by '_', at most 64 characters; write 'fast'"),
    ],
)
def test_what_is_wrong_is_said_and_nothing_is_written(run: Run, robot: Path, words: str, message: str) -> None:
    ran = run("new", *words.split(), "-C", robot)
    assert (ran.status, ran.err.rpartition("Error: ")[2]) == (2, f"{message}\n")
    assert robot.read_text(encoding="utf-8") == ROBOT


def test_an_output_and_a_component_of_one_id_are_not_written(run: Run, robot: Path) -> None:
    text = ROBOT.replace("      head:\n", "      head:\n        outputs: {image: {from: eye.image}}\n")
    robot.write_text(text, encoding="utf-8")
    ran = run("new", "component", "body.head.image", "-C", robot)
    assert "`image` is an output of `body.head` and a component inside of it" in ran.err
    assert robot.read_text(encoding="utf-8") == text


def test_components_in_a_list_are_refused_with_what_to_write(run: Run, tmp_path: Path) -> None:
    text = "archgen: 1\ncomponent_types: {motor: {outputs: {state: Goal}}}\ngroups: {body: {components: [motor]}}\n"
    (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
    ran = run("new", "instance", "body.wheel", "motor", "-C", tmp_path / "robot.yaml")
    assert ran.status == 2
    assert (
        "nothing was written\nWrite it by hand into robot.yaml, or into a file of its own:\n\n    groups:\n" in ran.err
    )
    assert (tmp_path / "robot.yaml").read_text(encoding="utf-8") == text


def test_a_hostile_type_of_an_input_stays_in_its_comment(run: Run, tmp_path: Path) -> None:
    text = (
        'archgen: 1\ncomponent_types:\n  motor:\n    inputs: {target: "Go\\nnodes: {a: b}\\e[31m"}\n'
        "groups:\n  body:\n    components:\n      a:\n        title: A\n"
    )
    (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
    assert run("new", "instance", "body.b", "motor", "-C", tmp_path / "robot.yaml").status == 0
    added = (tmp_path / "robot.yaml").read_text(encoding="utf-8").removeprefix(text)
    assert added.splitlines()[3:] == [
        "        inputs:",
        "          target:  # component.output of type Go␊nodes: {a: b}␛[31m",
    ]
