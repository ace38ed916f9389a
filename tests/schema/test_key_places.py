"""Keys at the wrong level, elements beside their section, and words that only look like a section."""

from __future__ import annotations

import pytest

from archgen.schema import key_wording
from archgen.schema.key_places import find_common_kind, find_key_home
from archgen.schema.language_schema import load_schema
from archgen.schema.schema_wording import ErrorPlace
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import MappingNode
from tests.schema.findings import find_mistakes


def _component(text: str) -> str:
    return f"groups: {{sensing: {{components: {{lidar: {{{text}}}}}}}}}"


@pytest.mark.parametrize(
    ("text", "help_line"),
    [
        (_component("rate: 10 Hz"), "write it below `timing`: `timing: {rate: ...}`"),
        (_component("accuracy: 3 cm"), "write it below `performance`: `performance: {accuracy: ...}`"),
        (_component("package: urg"), "write it below `node`: `node: {package: ...}`"),
        (_component("topic: /a"), "write it as `nodes: {NODE: {implements: sensing.lidar, publishes: {PORT: {topic: ...}}}}`"),
        (_component("outputs: {scan: {topic: /a}}"), "write it as `nodes: {NODE: {implements: sensing.lidar, publishes: {scan: {topic: ...}}}}`"),
        (_component("inputs: {scan: {qos: /a}}"), "write it as `nodes: {NODE: {implements: sensing.lidar, subscribes: {scan: {qos: ...}}}}`"),
        (_component("outputs: {scan: {message: a/msg/B}}"), "write it as `types: {TYPE: {message: ...}}`"),
        (_component("outputs: {scan: {rate: 1 Hz}}"), "write it below `promise`: `promise: {rate: ...}`"),
            (_component("inputs: {scan: {promise: }}"), "write it at the output that it is about: `outputs: {OUTPUT: {promise: ...}}`"),
        # Words of ROS where the language has ports.
        (_component("services: {reset: {type: std_srvs/srv/Trigger}}"), "what a component serves is an output whose type is a service or an action: `outputs: {NAME: PACKAGE/srv/TYPE}`"),
        (_component("calls: {reset: a.b.reset}"), "what a component calls is an input that reads it: `inputs: {NAME: GROUP.COMPONENT.OUTPUT}`"),
        (_component("publishes: {scan: /scan}"), "what a component gives is an output; topics stand at nodes: `outputs: {NAME: PACKAGE/msg/TYPE}`"),
        (_component("subscriptions: [scan]"), "what a component takes is an input; topics stand at nodes: `inputs: {NAME: GROUP.COMPONENT.OUTPUT}`"),
        # One letter too few or too many is a slip, wherever else the key belongs.
        ("hosts: {pc: {core: 4}}", "did you mean `cores`?"),
        ("nodes: {n: {hosts: pc}}", "did you mean `host`?"),
        (_component("hosts: {}"), "`hosts` is a section of its own: it begins in the first column"),
        ("nodes: {n: {depth: 3}}", "its keys are `implements`"),
        # Words of elsewhere, and keys of other elements, which say nothing where they have another meaning.
        ("links: {lan: {hosts: [pi, nuc]}}", "did you mean `connects`?"),
        ("chains: {stop: {latency: 5 ms}}", "did you mean `deadline`?"),
        ("types: {Scan: {srv: std_srvs/srv/Trigger}}", "did you mean `message`?"),
        ("hosts: {pc: {owner: acme}}", "its keys are `title`"),
        ("requirements: {R-1: {status: planned}}", "its keys are `title`"),
        (_component("latency: 5 ms"), "its keys are `title`"),
        (_component("frequency: 5 Hz"), "write it as `timing: {rate: ...}` of the component or of its node"),
        ("links: {lan: {nodes: {n: {package: urg}}}}", "`nodes` is a section of its own: it begins in the first column"),
        ("groups: {g: {inputs: {scan: }}}", "write it as `groups: {GROUP: {components: {COMPONENT: {inputs: ...}}}}`"),
        ("distro: jazzy", "write it below `ros`: `ros: {distro: ...}`"),
        ("components: {a: {role: sink}}", "write it as `groups: {GROUP: {components: ...}}`"),
        ("title: My robot", "write it below `project`: `project: {title: ...}`"),
        ("lidar: {package: urg, status: planned}", "put it below `nodes:`, indented"),
        ("perception: {components: {a: }}", "put it below `groups:`, indented"),
        ("modes: {flying: {speed: 3}}", "the sections are `archgen`"),
        ("node: {n: {package: urg}}", "did you mean `nodes`?"),
        ("node: {n: a.b}", "did you mean `nodes`?"),
        ("policy: {p: {title: P}}", "did you mean `policies`?"),
        ("groups: {g: {wheels: {role: sink}}}", "it looks like a component: indent it below `components:` of `g`"),
        (_component("wheels: {role: sink}"), "it looks like a component: begin it in the column of `lidar`"),
        ("variants: {v: {changes: {project: {title: T}}}}", "no variant changes `project`: it says what the project is"),
        ("variants: {v: {changes: {components: {a: A}}}}", "components are changed in their group: `groups: {GROUP: "),
        ("variants: {v: {changes: {without: lidar}}}", "`without` says something of the variant: begin it in the column"),
        ("variants: {v: {changes: {package: urg}}}", "write it as `nodes: {NODE: {package: ...}}`"),
        ("policies: {p: {forbid: {from: a, to: b, of: c}}}", "a flow has two ends: `forbid: {from: ..., to: ...}`; `of` "),
        ("policies: {p: {require: {of: a, inputs_from: b, from: c}}}", "`require` asks something of elements: `require: "),
        ("nodes: {n: {program: {package: urg, executable: x}}}", "write `package` and `executable` at `n` itself"),
        ("nodes: {n: {node: usb_cam_node_exe}}", "did you mean `executable`?"),
        ("nodes: {n: {topics: {image: /image}}}", "a node sends and hears: `publishes: {PORT: /topic}`"),
        ("nodes: {n: {depends: [opencv]}}", "on which packages it depends follows from what it publishes"),
        ("nodes: {n: {launch: arm.launch.py}}", "what a launch file starts is imported by `archgen import launch FILE`"),
        ("hosts: {pc: {runs: [n]}}", "a node says where it runs: `nodes: {NODE: {host: HOST}}`"),
        ("hosts: {pc: {gpu: true}}", "what nodes share beside the cores is a resource: `resources: {gpu: HOST}`"),
        ("chains: {c: {through: [a, b], max: 300}}", "did you mean `deadline`?"),
        ("generate: {ros2_python: }", "write it below `backends`: `backends: {ros2_python: ...}`"),
        ("generate: {backend: [start]}", "did you mean `backends`?"),
        ("nodes: {n: {m: {package: urg}}}", "it looks like a ROS node of its own: begin it in the column of `n`"),
    ],
)  # fmt: skip
def test_a_key_at_the_wrong_level_is_told_where_it_belongs(text: str, help_line: str) -> None:
    (mistake,) = find_mistakes(text)
    assert " unknown-key: " in mistake
    assert mistake.partition(" | ")[2].startswith(help_line)


def test_a_figure_of_performance_by_another_word_is_told_at_its_key() -> None:
    (mistake,) = find_mistakes(_component("performance: {latency: 120ms}"))
    assert " wrong-type: " in mistake
    assert mistake.partition(" | ")[2] == "did you mean `execution_time`?"


def test_several_keys_of_one_other_kind_are_one_mistake() -> None:
    assert find_mistakes("groups: {lidar: {role: source, outputs: {scan: }, inputs: {}}}") == [
        (
            "1:18 unknown-key: a functional group has no keys `role`, `outputs` or `inputs`"
            " | if `lidar` is a component, indent it below `components:` of its group"
        )
    ]
    assert find_mistakes(_component("package: urg, host: pc")) == [
        (
            "1:41 unknown-key: a component has no keys `package` or `host`"
            " | write it below `node`: `node: {package: ...}`"
        )
    ]
    assert len(find_mistakes(_component("package: urg, colour: red"))) == 2


def test_a_kind_is_common_only_to_several_keys() -> None:
    assert find_common_kind(("package", "host")) == "node"
    assert find_common_kind(("package",)) is None
    assert find_common_kind(("package", "cores")) is None


def test_what_every_element_has_has_no_home() -> None:
    assert find_key_home("description", ("links", "lan"), "Link") is None


def test_a_key_that_holds_an_odd_blank_is_no_guess() -> None:
    document, _ = yaml_parser.parse_yaml("f", "nodes: {n: {ti\u00a0tle: N}}")
    assert document is not None
    nodes = document.root.get("nodes")
    assert isinstance(nodes, MappingNode)
    place = ErrorPlace(("nodes", "n"), nodes.entries["n"].value, nodes, nodes.entries["n"])
    schema_part = load_schema()["$defs"]["node"]
    (mistake,) = key_wording.diagnose_unknown_keys(place, ("ti\u00a0tle",), schema_part)
    assert (mistake.span.column, mistake.help) == (15, "write `ti tle`")
