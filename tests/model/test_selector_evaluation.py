"""Selectors: each form, each key, and where they are wrong."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.model.architecture import Architecture
from archgen.model.path_resolver import ElementRef
from archgen.model.selector_evaluation import evaluate_selector
from archgen.model.selector_keys import matches_wildcard

Derived = Callable[[str], Architecture]

ROBOT = """
partners: {certh: , tum: }
requirements: {R-1: {title: Safe, tags: [law]}, R-2: }
hosts: {pc: , board: {tags: [gpu]}}
groups:
  sensing:
    owner: certh
    tags: [perception]
    components:
      camera:
        role: source
        inputs: {light: {external: Light, medium: physical}}
        outputs: {image: Colour image, info: T}
      lidar: {outputs: {scan: Laser scan}, requirements: [R-1], tags: [safety]}
  planning:
    owner: tum
    components:
      detector: {inputs: {image: camera.image}, outputs: {objects: T}, timing: {behaviour: event}}
      fusion: {inputs: {any_of: [lidar, detector, camera.info]}, outputs: {world: T}}
      solver: {inputs: {world: fusion}, outputs: {solve: std_srvs/srv/Trigger}}
      executor: {inputs: {ask: solver.solve}, outputs: {command: T}, requirements: [R-2, "R-2 in the dark"]}
  driving:
    components:
      base: {role: sink, inputs: {command: executor.command, stop: lidar}, outputs: {log: T}}
      camera: {title: Rear Camera}
      odd: {inputs: {x: stub}}
      stub:
nodes:
  cam: {implements: sensing.camera, package: usb_cam, host: board, status: existing}
  eyes: {implements: [detector, fusion], package: our_vision, host: pc, tags: [certified], owner: certh, publishes: {world: }}
  eyes_too: {implements: fusion, subscribes: {any_of: }}
  relay: {package: topic_tools}
"""


def names(derived: Derived, text: str) -> str:
    """Give the selected components by their names, in order."""
    architecture = derived(ROBOT)
    selection, problems = evaluate_selector(text, architecture, {"unread-output": frozenset({"driving.base", "eyes"})})
    assert problems == ()
    return " ".join(
        c.name if c.group != "driving" else f"d.{c.name}"
        for c in architecture.components.values()
        if c.id in selection.components
    )


@pytest.mark.parametrize(
    ("text", "selected"),
    [
        ("sensing", "camera lidar"),
        ("sensing.camera", "camera"),
        ("lidar", "lidar"),
        ("camera.image", "camera"),
        ("fusion.any_of", "fusion"),  # an input
        ("relay", ""),  # a node without component
        ("cam", "camera"),  # a node's component
        ("lidar solver", "lidar solver"),
        ("sensing -lidar", "camera"),
        ("-sensing -driving", "detector fusion solver executor"),
        ("-tag:safety sensing", "camera"),
        ("+fusion", "camera lidar detector fusion"),
        ("1+fusion", "camera lidar detector fusion"),
        ("1+solver", "fusion solver executor"),
        ("2+solver+0", "camera lidar detector fusion solver executor"),
        ("lidar+1", "lidar fusion d.base"),
        ("lidar+", "lidar fusion solver executor d.base"),
        ("1+detector+1", "camera detector fusion"),
        ("camera.image+1", "camera detector"),  # only what this output feeds
        ("executor+1", "solver executor d.base"),  # a service carries data both ways
        ("driving.stub+", "d.odd d.stub"),  # of which nobody knows yet what it sends
        ("camera.image..fusion", "camera detector fusion"),
        ("lidar..base", "lidar fusion solver executor d.base"),
        ("detector..tag:perception", ""),
        ("-camera.image..fusion", "lidar solver executor d.base d.camera d.odd d.stub"),
        ("*.camera", "camera d.camera"),
        ("sensing.*", "camera lidar"),
        ("*s*", "camera lidar detector fusion solver d.base d.stub"),
        ("*.ima*", "camera"),
        ("tag:perception", "camera lidar"),
        ("tag:safety", "lidar"),
        ("tag:law", "lidar"),  # of a requirement
        ("tag:gpu", "camera"),  # of a host
        ("tag:certified", "detector fusion"),  # of a node
        ("owner:certh", "camera lidar"),
        ("status:existing", "camera"),
        ("status:planned", "lidar solver executor d.base d.camera d.odd d.stub"),
        ('type:"Colour  image"', "camera detector"),
        ("type:sensor_msgs/msg/LaserScan", "lidar fusion d.base"),
        ("medium:physical", "camera"),
        ("role:sink", "d.base"),
        ("host:pc", "detector fusion"),
        ("package:usb_*", "camera"),
        ("requirement:R-2", "executor"),
        ("behaviour:event", "detector fusion"),
        ("finding:unread-output", "detector fusion d.base"),
        ("node:eyes", "detector fusion"),
        ("node:eyes*", "detector fusion"),
        ("+role:sink -sensing", "detector fusion solver executor d.base"),
        ("host:pc..base", "detector fusion solver executor d.base"),
    ],
)
def test_what_is_selected(derived: Derived, text: str, selected: str) -> None:
    assert names(derived, text) == selected


@pytest.mark.parametrize(
    ("text", "nodes"),
    [
        ("sensing.camera", ["cam"]),
        ("fusion", ["eyes", "eyes_too"]),  # a component's selection is also its nodes
        ("node:eyes", ["eyes"]),
        ("node:relay", ["relay"]),
        ("1+node:eyes", ["cam", "eyes"]),  # steps between nodes
        ("node:cam+1", ["cam", "eyes", "eyes_too"]),
        ("node:cam..node:solver", ["cam", "executor", "eyes", "solver"]),
        ("planning -node:eyes", ["executor", "solver"]),
        ("detector -fusion", ["eyes"]),  # still needed for the detector
        ("owner:certh", ["cam", "eyes", "lidar"]),
        ("driving -driving.camera", ["base", "odd", "stub"]),
    ],
)
def test_which_nodes_are_selected(derived: Derived, text: str, nodes: list[str]) -> None:
    selection, problems = evaluate_selector(text, derived(ROBOT))
    assert problems == ()
    assert sorted(selection.nodes) == nodes


def test_what_paths_name(derived: Derived) -> None:
    assert evaluate_selector("lidar sensing camera.image -planning", derived(ROBOT))[0].named_elements == (
        ElementRef("component", "sensing.lidar"),
        ElementRef("group", "sensing"),
        ElementRef("output", "sensing.camera.image"),
    )


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "0-0 the selector is empty"),
        ("lidar, base", "5-6 `,` is reserved; words are separated by blanks | None"),
        ("lidar camra", "6-11 nothing is called `camra` | did you mean `camera`?"),
        (
            "camera",
            (
                "0-6 `camera` can mean `sensing.camera` or `driving.camera`"
                " | write more of the path, such as `sensing.camera`"
            ),
        ),
        ("colour:x", "0-6 no key `colour` | keys are tag, owner, status, type, medium, role, host, package, "),
        ("lidar tga:safety", "6-9 no key `tga` | did you mean `tag:`?"),
        ('type:"Colour image', '0-18 the quote is not closed | write `type:"Point cloud"`'),
        ("lidar +", "6-7 a path or `key:value` is missing"),
        ("x..", "2-3 a path or `key:value` is missing"),
        ("..x", "0-3 a path or `key:value` is expected, not `..x`"),
        ("tag:", "0-4 `tag:` needs a value"),
        ("lidar+base", "6-10 `base` is more than a word can hold"),
        ("2+lidar..base", "7-13 `..base` is more than a word can hold"),
        ("99999999+lidar", "0-14 `99999999` steps are too many"),
    ],
)
def test_what_is_wrong(derived: Derived, text: str, problem: str) -> None:
    selection, problems = evaluate_selector(text, derived(ROBOT))
    (only,) = problems
    assert only.severity == "error"
    assert f"{only.start}-{only.end} {only.message} | {only.help}".startswith(problem)
    assert selection.components == selection.nodes == frozenset()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("lidar tag:nothing", "6-17 nothing has `tag:nothing`"),
        ("lidar *_x", "6-9 nothing fits `*_x`"),
    ],
)
def test_what_selects_nothing_is_a_warning(derived: Derived, text: str, message: str) -> None:
    selection, (only,) = evaluate_selector(text, derived(ROBOT))
    assert (only.severity, f"{only.start}-{only.end} {only.message}") == ("warning", message)
    assert selection.components == {"sensing.lidar"}


@pytest.mark.parametrize(
    ("pattern", "text", "fits"),
    [
        ("a", "a", True),
        ("a", "ab", False),
        ("a*", "ab", True),
        ("*b", "ab", True),
        ("a*a", "a", False),
        ("*b*d*", "abcde", True),
        ("*d*b*", "abcde", False),
        ("a*b*a", "aba", True),
        ("*a" * 50 + "b", "a" * 2000, False),
    ],
)
def test_wildcards(pattern: str, text: str, fits: bool) -> None:  # noqa: FBT001
    assert matches_wildcard(pattern, text) is fits
