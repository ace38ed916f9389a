"""Ways round the gate: changes that take something from a partner without seeming to, and harmless ones that look like them.

The robot has three partners. What needs a repository (another folder, links) stands in tests/cli/test_gate.py. A row is what a pull request edits, and who is broken by it where every category is an error.
"""

from __future__ import annotations

import functools
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare import Comparison
from archgen.pipeline import CheckedProject
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from tests.property_sizes import try_some

Edit = tuple[str, str, str]
ROBOT = {
    "archgen.yaml": """\
archgen: 1
project: {id: crawler, title: Crawler}
sources: [aegir.yaml, ligur.yaml, tekna.yaml]
libraries: {lib: lib}
partners: {aegir: {title: Aegir}, ligur: {title: Ligur}, tekna: {title: Tekna}}
hosts: {pc: {cores: 4}, rescue: {cores: 4, environment: {ROS_DOMAIN_ID: "42"}}}
ros: {distro: jazzy, interfaces: ["msg/**/*.msg"]}
review: {breaking: {wire: error, promise: error, meaning: error, source: note}}
types: {Stop: std_msgs/msg/Bool, State: {fields: {level: uint8}}, Leak: {message: crawler_msgs/msg/Leak, comment: set if level != 0}, Reset: std_srvs/srv/Trigger, Pose: geometry_msgs/msg/Pose}
requirements: {R1: {title: It stops before an obstacle, verified_by: see}}
policies: {quiet: {title: Nothing talks back, forbid: {from: propulsion, to: cleaning}}}
chains: {see: {through: [detector, supervisor, thruster], deadline: 500 ms}}
variants:
  deep: {changes: {nodes: {leak_detector: {publishes: {leak: {qos: {depth: 5}}}}, brush: {timing: {wcet: 2 ms}}}}}
""",
    "msg/crawler_msgs/msg/Leak.msg": "# In metres\\nfloat32 level\\nuint8 compartment\\n".replace("\\n", "\n"),
    "lib/types.yaml": """\
types: {Depth: {message: std_msgs/msg/Float32, comment: in m}, Echo: {fields: {strength: float32}}}
component_types:
  sonar: {outputs: {depth: {type: Depth, promise: {rate: 10 Hz, unit: m}}, echo: Echo}, timing: {rate: 10 Hz, wcet: 1 ms}, node: {package: sonar_driver, executable: sonar}}
""",
    "aegir.yaml": """\
component_types:
  motor: {inputs: {stop: Stop}, outputs: {pose: Pose, raw: Pose}, timing: {rate: 20 Hz, wcet: 1 ms}, node: {package: aegir_arm, executable: motor, parameters: {frame_id: base}}}
  rig: {components: {m: {is: motor, inputs: {stop: {external: Switch, medium: physical}}}}, outputs: {pose: {from: m.pose}}}
groups:
  safety:
    owner: aegir
    components:
      supervisor: {inputs: {leak: detector.leak}, outputs: {safety: {type: Stop, description: "false while in [0, 1)"}, reset: Reset, state: State}, requirements: [R1]}
      console: {inputs: {depth: sonar.depth, echo: sonar.echo}}
  arm: {owner: aegir, components: {left: {is: rig}}}
nodes:
  safety_supervisor:
    implements: supervisor
    package: aegir_safety
    executable: supervisor
    status: existing
    kind: lifecycle
    host: pc
    timing: {rate: 20 Hz, wcet: 2 ms}
    parameter_files: [safety.yaml]
    publishes: {safety: {topic: /safety, qos: {reliability: reliable, durability: transient_local}}}
    serves: {reset: /reset}
    subscribes: {leak: /leak}
  manager: {package: nav2_lifecycle_manager, executable: lifecycle_manager, status: existing, host: pc, parameters: {node_names: [safety_supervisor], autostart: true}}
  console: {implements: console, host: pc}
""",
    "safety.yaml": "/**:\\n  ros__parameters: {frame_id: hull}\\n".replace("\\n", "\n"),
    "ligur.yaml": """\
groups:
  propulsion:
    owner: ligur
    autoconnect: ports
    components:
      thruster: {inputs: {safety: supervisor.safety, reset: supervisor.reset, pose: left.pose, state: supervisor.state}}
      beacon: {outputs: {beat: {type: Stop}}}
      lamp: {owner: tekna, inputs: {beat: {type: Stop}}}
nodes:
  thruster:
    implements: thruster
    package: ligur_thruster
    executable: thruster
    status: existing
    host: pc
    timing: {wcet: 1 ms}
    subscribes: {safety: {topic: /safety, qos: {reliability: reliable, durability: transient_local}}, pose: {topic: /arm/left/m/pose, qos: {reliability: reliable}}}
    calls: {reset: /reset}
""",
    "tekna.yaml": """\
groups:
  cleaning:
    owner: tekna
    components:
      detector: {timing: {rate: 10 Hz, wcet: 1 ms}, outputs: {leak: {type: Leak, promise: {rate: 10 Hz}}}}
      sonar: {is: lib.sonar}
      brush: {inputs: {safety: supervisor.safety}}
nodes:
  leak_detector: {implements: detector, package: tekna_leak, executable: leak, status: existing, host: pc, publishes: {leak: {topic: /leak}}}
  brush: {implements: brush, package: tekna_brush, executable: brush, status: existing, host: pc, timing: {wcet: 1 ms}, subscribes: {safety: {topic: /safety, qos: {reliability: reliable}}}}
""",
}


def at_supervisor(words: str) -> Edit:
    return (
        "aegir.yaml",
        "    timing: {rate: 20 Hz, wcet: 2 ms}\n",
        f"    timing: {{rate: 20 Hz, wcet: 2 ms}}\n    {words}\n",
    )


def at_detector(words: str) -> Edit:
    return ("tekna.yaml", "executable: leak,", f"executable: leak, {words},")


def compare(folder: Path, *edits: Edit) -> Comparison:
    """Compare the robot with an edited one; a text that is nowhere adds a file."""
    after = dict(ROBOT)
    for file, old, new in edits:
        assert not old or old in after[file], (file, old)
        after[file] = after[file].replace(old, new) if old else new
    return compare_named_versions(_judge_robot(), ProjectVersion("after", _judge(folder / "after", after)))


@functools.cache
def _judge_robot() -> ProjectVersion:
    """Judge the robot without an edit, once for all tests."""
    return ProjectVersion("before", _judge(Path(tempfile.mkdtemp(dir=os.environ["XDG_CACHE_HOME"])), ROBOT))


def _judge(folder: Path, files: Mapping[str, str]) -> CheckedProject:
    for file, text in files.items():
        path = folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode("utf-16") if text.startswith("# utf-16") else text.encode())
    return pipeline.check_project(folder)


AEGIR, LIGUR, TEKNA = "aegir", "ligur", "tekna"
WEAKER = ("qos: {depth: 5}", "qos: {depth: 5, reliability: best_effort}")
# In the order of breaking_changes.md: those that held, those that passed, those in steps; then others of the same kinds.
EVASIONS: dict[str, tuple[list[Edit], set[str]]] = {
    "a message file is replaced by a type with fields": (
        [
            (
                "archgen.yaml",
                "message: crawler_msgs/msg/Leak, ",
                "message: crawler_msgs/msg/Leak, fields: {level: float32}, ",
            ),
            ("msg/crawler_msgs/msg/Leak.msg", "float32 level\nuint8 compartment\n", "float32 level\n"),
        ],
        {AEGIR},
    ),
    "an instance writes over a rate inside a composed component": (
        [("aegir.yaml", "left: {is: rig}", "left: {is: rig, components: {m: {timing: {rate: 1 Hz}}}}")],
        {LIGUR},
    ),
    "an instance of a weaker type": (
        [
            ("aegir.yaml", "  rig: {", "  slow: {is: motor, timing: {rate: 1 Hz}}\n  rig: {"),
            ("aegir.yaml", "m: {is: motor", "m: {is: slow"),
        ],
        {LIGUR},
    ),
    "quality of service in a variant that is there": ([("archgen.yaml", *WEAKER)], {AEGIR}),
    "interfaces of the project narrowed": (
        [("archgen.yaml", '"msg/**/*.msg"', '"msg/none/*.msg"')],
        {AEGIR},
    ),
    "a comment that silences": (
        [
            ("tekna.yaml", "nodes:\n", "# archgen: ignore\nnodes:\n"),
            at_detector("start: {environment: {ROS_DOMAIN_ID: '42'}}"),
        ],
        {AEGIR},
    ),
    "a partner renamed who agrees in the new file": (
        [
            ("archgen.yaml", "aegir: {title: Aegir}", "aegir2: {title: Aegir}"),
            ("aegir.yaml", "owner: aegir", "owner: aegir2"),
            (
                "review/aegir2.yaml",
                "",
                "review: {accepted: {leak_detector: {key: start.environment.ROS_DOMAIN_ID, reason: ok}}}\n",
            ),
            at_detector("start: {environment: {ROS_DOMAIN_ID: '42'}}"),
        ],
        {"aegir2"},
    ),
    "a partner deleted and his parts grabbed": (
        [
            ("archgen.yaml", "aegir: {title: Aegir}, ", ""),
            ("aegir.yaml", "owner: aegir", "owner: tekna"),
            at_detector("start: {environment: {ROS_DOMAIN_ID: '42'}}"),
        ],
        {AEGIR},
    ),
    "a frame in a parameter file": ([("safety.yaml", "frame_id: hull", "frame_id: bow")], {LIGUR, TEKNA}),
    "another folder of the library": (
        [
            ("archgen.yaml", "{lib: lib}", "{lib: lib2}"),
            ("lib2/types.yaml", "", ROBOT["lib/types.yaml"].replace("promise: {rate: 10 Hz", "promise: {rate: 1 Hz")),
        ],
        {AEGIR},
    ),
    "the library copied into the project, with a difference": (
        [
            (
                "tekna.yaml",
                "groups:\n",
                ROBOT["lib/types.yaml"]
                .partition("component_types:")[2]
                .join(["component_types:", ""])
                .replace("rate: 10 Hz, unit", "rate: 1 Hz, unit")
                .replace("type: Depth", "type: lib.Depth")
                + "groups:\n",
            ),
            ("tekna.yaml", "is: lib.sonar", "is: sonar"),
        ],
        {AEGIR},
    ),
    "topics that all share": (
        [
            ("archgen.yaml", "ros: {distro", "ros: {shared_topics: [/safety], distro"),
            at_supervisor("remaps: {/safety: /safety_raw}"),
        ],
        {LIGUR, TEKNA},
    ),
    "a type of the project over the library's": (
        [("archgen.yaml", "types: {", "types: {Depth: std_msgs/msg/Float64, ")],
        set(),
    ),
    "a port of a composed component passes on another output": (
        [("aegir.yaml", "{pose: {from: m.pose}}", "{pose: {from: m.raw}}")],
        {LIGUR},
    ),
    "a unit in a library": ([("lib/types.yaml", "unit: m}", "unit: mm}")], {AEGIR}),
    "a service taken off ROS": (
        [
            ("aegir.yaml", "reset: Reset, ", "reset: {type: Reset, medium: physical, external: Hand}, "),
            ("aegir.yaml", "    serves: {reset: /reset}\n", ""),
        ],
        {LIGUR},
    ),
    "a rule that is off": (
        [
            ("archgen.yaml", "policies:", "rules: {two-domains: 'off'}\npolicies:"),
            at_detector("start: {environment: {ROS_DOMAIN_ID: '42'}}"),
        ],
        {AEGIR},
    ),
    "UTF-16": ([("tekna.yaml", "groups:\n", "# utf-16\ngroups:\n"), at_detector("remaps: {/leak: /x}")], set()),
    "UTF-8 with a mark": (
        [("tekna.yaml", "groups:\n", "\ufeffgroups:\n"), at_detector("remaps: {/leak: /x}")],
        {AEGIR},
    ),
    "the id of the project": ([("archgen.yaml", "id: crawler", "id: walker")], {LIGUR}),
    "the package of a library": ([("archgen.yaml", "{lib: lib}", "{lib: {path: lib, package: other_msgs}}")], {AEGIR}),
    "a softer policy": (
        [
            ("archgen.yaml", "{wire: error, promise: error, meaning: error, source: note}", "'off'"),
            at_supervisor("remaps: {/safety: /x}"),
        ],
        {LIGUR, TEKNA},
    ),
    # What the launch does.
    "a remap": ([at_supervisor("remaps: {/safety: /safety_raw}")], {LIGUR, TEKNA}),
    "a remap in arguments": ([at_supervisor("arguments: [--ros-args, -r, '/safety:=/safety_raw']")], {LIGUR, TEKNA}),
    "an override of quality of service": (
        [
            at_supervisor(
                "parameters: {qos_overrides: {/safety: {publisher: {durability: volatile, reliability: best_effort}}}}"
            )
        ],
        {LIGUR, TEKNA},
    ),
    "another domain": ([at_detector("start: {environment: {ROS_DOMAIN_ID: '42'}}")], {AEGIR}),
    "simulated time for the real robot": (
        [("archgen.yaml", "ros: {distro", "ros: {parameters: {use_sim_time: true}, distro")],
        {AEGIR, LIGUR, TEKNA},
    ),
    "a life cycle that stops short": ([at_supervisor("start: {state: unconfigured}")], {LIGUR, TEKNA}),
    "one more output where connections make themselves": (
        [("ligur.yaml", "      beacon:", "      beacon2: {outputs: {beat: {type: Stop}}}\n      beacon:")],
        {TEKNA},
    ),
    "connections no longer make themselves": ([("ligur.yaml", "    autoconnect: ports\n", "")], {TEKNA}),
    "a variant renamed in the same change": (
        [("archgen.yaml", "  deep: {", "  deep_sea: {"), ("archgen.yaml", *WEAKER)],
        {AEGIR},
    ),
    "another sign in a text": ([("archgen.yaml", "level != 0", "level = 0")], {AEGIR}),
    # In steps; on a chain.
    "made optional and removed": (
        [
            ("aegir.yaml", "inputs: {leak: detector.leak}", "inputs: {leak: {optional: true, external: Nobody}}"),
            ("tekna.yaml", "{leak: {type: Leak, promise: {rate: 10 Hz}}}", "{}"),
            ("tekna.yaml", ", publishes: {leak: {topic: /leak}}", ""),
        ],
        {AEGIR},
    ),
    "a co-owner": (
        [("tekna.yaml", "owner: tekna", "owner: [tekna, aegir]"), at_detector("remaps: {/leak: /x}")],
        {AEGIR},
    ),
    "the reader removed, then the output": (
        [
            ("aegir.yaml", "inputs: {leak: detector.leak}, ", ""),
            ("aegir.yaml", "    subscribes: {leak: /leak}\n", ""),
            ("tekna.yaml", "{leak: {type: Leak, promise: {rate: 10 Hz}}}", "{}"),
            ("tekna.yaml", ", publishes: {leak: {topic: /leak}}", ""),
        ],
        {AEGIR},
    ),
    # Of the same kinds.
    "a remap for topics alone": (
        [at_supervisor("arguments: [--ros-args, -r, 'rostopic:///safety:=/x']")],
        {LIGUR, TEKNA},
    ),
    "a remap for one node alone": (
        [at_supervisor("arguments: [--ros-args, -r, 'safety_supervisor:/safety:=/x']")],
        {LIGUR, TEKNA},
    ),
    "a remap of the days of ROS 1": ([at_supervisor("arguments: ['/safety:=/x']")], {LIGUR, TEKNA}),
    "names that change places": ([at_supervisor("remaps: {/safety: /reset, /reset: /safety}")], {LIGUR, TEKNA}),
    "an override in a parameter file": (
        [
            (
                "safety.yaml",
                "{frame_id: hull}",
                "{frame_id: hull, qos_overrides: {/safety: {publisher: {reliability: best_effort}}}}",
            )
        ],
        {LIGUR, TEKNA},
    ),
    "a parameter of the project makes a reader ask for more": (
        [
            (
                "archgen.yaml",
                "ros: {distro",
                "ros: {parameters: {qos_overrides: {/leak: {subscription: {durability: transient_local}}}}, distro",
            )
        ],
        {AEGIR},
    ),
    "a parameter of the project, while the reader keeps his clock": (
        [
            ("archgen.yaml", "ros: {distro", "ros: {parameters: {use_sim_time: true}, distro"),
            ("tekna.yaml", "executable: brush,", "executable: brush, parameters: {use_sim_time: false},"),
        ],
        {TEKNA},
    ),
    "a host in another domain": (
        [("aegir.yaml", "    host: pc\n    timing", "    host: rescue\n    timing")],
        {LIGUR, TEKNA},
    ),
    "a container on a host in another domain": (
        [
            ("archgen.yaml", "hosts:", "containers: {box: {host: rescue}}\nhosts:"),
            ("aegir.yaml", "    host: pc\n    timing", "    container: box\n    timing"),
        ],
        {LIGUR, TEKNA},
    ),
    "a domain that the launch fills in": (
        [at_detector("start: {environment: {ROS_DOMAIN_ID: $(arg domain)}}")],
        {AEGIR},
    ),
    "simulated time in arguments": (
        [at_supervisor("arguments: [--ros-args, -p, 'use_sim_time:=true']")],
        {LIGUR, TEKNA},
    ),
    "simulated time at a component": (
        [("aegir.yaml", "supervisor: {inputs", "supervisor: {parameters: {use_sim_time: true}, inputs")],
        {LIGUR, TEKNA},
    ),
    "simulated time in a parameter file": (
        [("safety.yaml", "{frame_id", "{use_sim_time: true, frame_id")],
        {LIGUR, TEKNA},
    ),
    "a manager that lists another node": (
        [("aegir.yaml", "node_names: [safety_supervisor]", "node_names: [somebody_else]")],
        {LIGUR, TEKNA},
    ),
    "a manager that waits": ([("aegir.yaml", "autostart: true", "autostart: false")], {LIGUR, TEKNA}),
    "a name space where its manager does not find it": (
        [at_supervisor("arguments: [--ros-args, -r, '__ns:=/deck']")],
        {LIGUR, TEKNA},
    ),
    "a launch argument that switches it off": ([at_supervisor("hints: {launch: {by_default: 'off'}}")], {LIGUR, TEKNA}),
    "another node in its place, in another domain": (
        [
            ("aegir.yaml", "  safety_supervisor:\n", "  guard:\n    name: safety_supervisor\n"),
            at_supervisor("start: {environment: {ROS_DOMAIN_ID: '42'}}"),
        ],
        {LIGUR, TEKNA},
    ),
    "a stub under the id of a variant": (
        [
            (
                "archgen.yaml",
                "  deep: {",
                "  deep: {changes: {nodes: {console: {timing: {wcet: 3 ms}}}}}\n  deep_sea: {",
            ),
            ("archgen.yaml", *WEAKER),
        ],
        {AEGIR},
    ),
    "a remap in a variant": (
        [("archgen.yaml", "qos: {depth: 5}}}}", "qos: {depth: 5}}}}, safety_supervisor: {remaps: {/safety: /x}}")],
        {LIGUR, TEKNA},
    ),
    "a source moved out of the group that joins it": (
        [
            ("ligur.yaml", "      beacon: {outputs: {beat: {type: Stop}}}\n", ""),
            (
                "ligur.yaml",
                "groups:\n",
                "groups:\n  deck: {owner: ligur, components: {beacon: {outputs: {beat: {type: Stop}}}}}\n",
            ),
        ],
        {TEKNA},
    ),
    "brackets of an interval": ([("aegir.yaml", "[0, 1)", "(0, 1]")], {LIGUR, TEKNA}),
    "another requirement in other words": (
        [("archgen.yaml", "It stops before", "It may slow down before")],
        {AEGIR, LIGUR, TEKNA},
    ),
    "a rule of the project taken away": (
        [
            (
                "archgen.yaml",
                "policies: {quiet: {title: Nothing talks back, forbid: {from: propulsion, to: cleaning}}}\n",
                "",
            )
        ],
        {LIGUR, TEKNA},
    ),
}
HARMLESS: dict[str, list[Edit]] = {
    "a remap at both ends alike": [
        at_supervisor("remaps: {/safety: /safety_raw}"),
        ("ligur.yaml", "    status: existing\n", "    status: existing\n    remaps: {/safety: /safety_raw}\n"),
        ("tekna.yaml", "executable: brush,", "executable: brush, remaps: {/safety: /safety_raw},"),
    ],
    "a remap that fits nothing": [at_supervisor("remaps: {/safe: /safety_raw}")],
    "a name space for absolute names": [
        ("tekna.yaml", "executable: brush,", "executable: brush, arguments: [--ros-args, -r, '__ns:=/deck'],")
    ],
    "an override that fits nothing": [
        at_supervisor("parameters: {qos_overrides: {/safe: {publisher: {durability: volatile}}}}")
    ],
    "an override of what a reader asks for": [
        (
            "tekna.yaml",
            "executable: brush,",
            "executable: brush, parameters: {qos_overrides: {/safety: {subscription: {reliability: best_effort}}}},",
        )
    ],
    "the usual domain by its number": [at_supervisor("start: {environment: {ROS_DOMAIN_ID: '0'}}")],
    "another domain for all": [("archgen.yaml", "ros: {distro", "ros: {environment: {ROS_DOMAIN_ID: '7'}, distro")],
    "simulated time that is false": [at_supervisor("parameters: {use_sim_time: false}")],
    "a reader who turns away": [
        ("ligur.yaml", "    status: existing\n", "    status: existing\n    remaps: {/safety: /x}\n")
    ],
    "a reader in another domain": [
        ("tekna.yaml", "executable: brush,", "executable: brush, start: {environment: {ROS_DOMAIN_ID: '42'}},")
    ],
    "a variant with another id": [("archgen.yaml", "  deep: {", "  deep_sea: {")],
    "a parameter of an own component type": [("aegir.yaml", "frame_id: base}", "frame_id: base, gain: 2}")],
    "a comment written otherwise": [("archgen.yaml", "set if level", "Set - if level")],
}


@pytest.mark.parametrize(("edits", "broken"), try_some(EVASIONS.values(), 20), ids=EVASIONS.keys())
def test_an_evasion_is_refused(tmp_path: Path, edits: list[Edit], broken: set[str]) -> None:
    comparison = compare(tmp_path, *edits)
    assert comparison.is_refused
    assert broken <= {partner for change in comparison.changes for partner in change.unheard_partners}


@pytest.mark.parametrize("edits", HARMLESS.values(), ids=HARMLESS.keys())
def test_what_is_harmless_passes(tmp_path: Path, edits: list[Edit]) -> None:
    comparison = compare(tmp_path, *edits)
    assert not comparison.is_refused
    assert [each for change in comparison.changes for each in change.breaks if each.category != "source"] == []
