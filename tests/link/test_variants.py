"""How the project stands in its variants: what is laid over it, what goes, and what then serves nobody."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from archgen import pipeline
from archgen.checking.checked_packing import pack_checked_project
from archgen.findings.variant_findings import phrase_absence
from archgen.pipeline import CheckedProject
from archgen.schema.language_schema import load_schema
from archgen.syntax.yaml_writer import write_yaml

ROBOT = """\
archgen: 1
ros: {distro: jazzy, parameters: {use_sim_time: false, deep: {a: 1, b: 2}}}
groups:
  sensing:
    components:
      lidar: {title: Lidar, outputs: {scan: T}, tags: [hardware, fast]}
      camera: {title: Camera, outputs: {image: T}}
      fusion: {inputs: {scan: {from: [lidar.scan, camera]}, image: camera.image, all: sensing}, outputs: {pose: T}}
  power: {components: {battery: {title: Battery, tags: [hardware], outputs: {level: T}}}}
  driving: {components: {drive: {inputs: {pose: fusion.pose, level: battery}, timing: {rate: 10 Hz}, parameters: {speed: {type: float, value: 0.5, unit: m/s}}}}}
nodes:
  laser: {implements: [lidar], package: l, host: laser_pc}
  battery: {implements: battery, container: box}
  eyes: {implements: [camera, lidar], package: e, host: pc, publishes: {image: /i, lidar.scan: /s}, parameters: {deep: {a: 1}, x: 2}}
  drive: {implements: [fusion, drive], package: d, host: pc}
hosts: {pc: {cores: 4}, laser_pc: , box_pc: , spare: }
containers: {box: box_pc}
resources: {fpga: laser_pc}
links: {lan: [pc, laser_pc], three: [pc, box_pc, spare]}
views: {eyes: "lidar camera -battery", laser: "lidar+", rest: "-lidar"}
milestones: {m: {date: 2027-03-01, needs: "lidar camera"}, n: {needs: "lidar"}}
policies: {p: {forbid: {from: battery, to: "role:sink"}}, q: {forbid: {from: "lidar camera", to: drive}}}
types: {T: sensor_msgs/msg/LaserScan}
"""


def check(folder: Path, variants: str, robot: str = ROBOT) -> CheckedProject:
    """Check a robot with variants, given as the lines below `variants`."""
    file = folder / "robot.yaml"
    file.write_text(f"{robot}variants:\n{variants}", encoding="utf-8")
    return pipeline.check_project(file)


def write_packed(checked: CheckedProject) -> str:
    """Return the packed project as text."""
    packed = pack_checked_project(checked)
    return write_yaml(packed.data, packed.comments)


def pack(checked: CheckedProject) -> dict:  # type: ignore[type-arg]
    """Return the packed project as data."""
    return yaml.safe_load(write_packed(checked))  # type: ignore[no-any-return]


def test_what_serves_nobody_goes_with_what_is_taken_out(tmp_path: Path) -> None:
    checked = check(tmp_path, '  sim: {without: "tag:hardware"}\n')
    sim = checked.variants["sim"].architecture
    assert list(sim.components) == ["sensing.camera", "sensing.fusion", "driving.drive"]
    assert list(sim.groups) == ["sensing", "driving"]
    assert list(sim.nodes) == ["eyes", "drive"]
    assert list(sim.hosts) == ["pc", "spare"]
    assert (list(sim.containers), list(sim.resources)) == ([], [])
    data = pack(checked.variants["sim"])
    assert data["links"] == {"three": {"connects": ["pc", "spare"]}}
    assert data["nodes"]["eyes"]["implements"] == ["camera"]
    assert data["nodes"]["eyes"]["publishes"] == {"image": {"topic": ["/i"]}}
    fusion = data["groups"]["sensing"]["components"]["fusion"]["inputs"]
    assert fusion == {"scan": {"from": ["camera"]}, "image": {"from": ["camera.image"]}, "all": {"from": ["sensing"]}}
    assert "from" not in data["groups"]["driving"]["components"]["drive"]["inputs"].get("level", {})
    assert data["views"] == {"eyes": {"show": "camera"}, "rest": {"show": "*"}}
    assert data["milestones"] == {"m": {"date": "2027-03-01", "needs": "camera"}}
    assert data["policies"] == {"q": {"forbid": {"from": "camera", "to": "drive"}}}
    # The project itself is as it was.
    assert "sensing.lidar" in checked.architecture.components


def test_what_is_laid_over_wins_leaf_by_leaf(tmp_path: Path) -> None:
    checked = check(
        tmp_path,
        """\
  sim:
    drop: [nodes.laser.host, views]
    changes:
      ros: {parameters: {use_sim_time: true, deep: {b: 3}}}
      groups:
        driving: {components: {drive: {timing: {period: 50 ms}, parameters: {speed: 1.5}, tags: [fast]}}}
        sensing: {components: {lidar: {tags: [slow]}, sonar: {outputs: {range: T}}}}
      nodes: {eyes: {parameters: {deep: {c: 1}}, implements: camera}, sonar: sonar}
      types: {T: sensor_msgs/msg/Image}
""",
    )
    data = pack(checked.variants["sim"])
    assert data["ros"]["parameters"] == {"use_sim_time": True, "deep": {"b": 3}}
    drive = data["groups"]["driving"]["components"]["drive"]
    assert drive["timing"] == {"period": "50 ms"}
    assert drive["parameters"] == {"speed": {"type": "float", "value": 1.5, "unit": "m/s"}}
    assert data["groups"]["sensing"]["components"]["lidar"]["tags"] == ["hardware", "fast", "slow"]
    assert data["nodes"]["eyes"]["parameters"] == {"deep": {"c": 1}, "x": 2}
    assert data["nodes"]["eyes"]["implements"] == ["camera"]
    assert "host" not in data["nodes"]["laser"]
    assert "views" not in data
    assert "variants" not in data
    assert checked.variants["sim"].architecture.message_of(
        checked.variants["sim"].architecture.outputs["sensing.sonar.range"]
    ) == ("sensor_msgs/msg/Image")


def test_variants_are_built_on_one_another_once_and_the_later_wins(tmp_path: Path) -> None:
    checked = check(
        tmp_path,
        """\
  low: {changes: {hosts: {pc: {cores: 1}}, nodes: {laser: {package: low}}}}
  a: {of: low, changes: {hosts: {pc: {cores: 2}}}}
  b: {of: low, changes: {hosts: {spare: {cores: 3}}}}
  both: {of: [a, b], changes: {nodes: {drive: {package: both}}}}
  other: {of: [b, a]}
""",
    )
    both = checked.variants["both"]
    assert both.steps == ("low", "a", "b", "both")
    assert [both.architecture.hosts[name].cores for name in ("pc", "spare")] == [2, 3]
    assert [both.architecture.nodes[name].package for name in ("laser", "drive")] == ["low", "both"]
    together = pipeline.stand_in_variants(checked, ["b", "a"])
    assert together.steps == checked.variants["other"].steps[:-1]
    assert together.architecture.hosts == checked.variants["other"].architecture.hosts
    assert pipeline.stand_in_variants(checked, ["base"]).architecture.hosts["pc"].cores == 4


def test_what_is_declared_anew_stays(tmp_path: Path) -> None:
    variants = (
        '  sim: {without: "tag:hardware", changes: {groups: {sensing: {components: {lidar: {title: Simulated}}}}}}\n'
    )
    sim = check(tmp_path, variants).variants["sim"].architecture
    assert "sensing.lidar" in sim.components
    assert "power.battery" not in sim.components


TYPES = """\
archgen: 1
groups:
  g:
    components:
      left: {is: arm}
      right: {is: arm}
      user: {inputs: {state: right.state, end: {from: g.right.gripper.state, optional: true}}}
      joined: {autoconnect: ports, components: {a: {outputs: {x: T}}, b: {outputs: {x: T}, tags: [spare]}, c: {inputs: {x: {type: T}}}}}
component_types:
  arm:
    outputs: {state: {type: T, from: motor.state}}
    tags: [limb]
    components:
      motor: {inputs: {grip: {from: gripper, optional: true}}, outputs: {state: T}, tags: [motor]}
      gripper: {is: hand}
  hand: {title: Hand, outputs: {state: T}, tags: [hand]}
nodes: {left: {implements: left}, right: {implements: right}, user: user, joined: {implements: joined}}
types: {T: std_msgs/msg/Bool}
"""


def test_an_instance_of_which_something_goes_is_written_out_and_the_other_stays(tmp_path: Path) -> None:
    checked = check(tmp_path, '  sim: {without: "g.right.gripper"}\n', TYPES)
    sim = checked.variants["sim"]
    assert "g.right.gripper" not in sim.architecture.components
    assert "g.left.gripper" in sim.architecture.components
    assert [edge.output for edge in sim.architecture.edges if edge.input == "g.user.state"] == ["g.right.motor.state"]
    assert [edge for edge in sim.architecture.edges if edge.input in {"g.user.end", "g.right.motor.grip"}] == []
    assert sim.architecture.shells["g.right"].tags == ("limb",)
    # Its packed file is a project of its own, with the same elements.
    file = tmp_path / "packed.yaml"
    file.write_text(write_packed(sim), encoding="utf-8")
    again = pipeline.check_project(file)
    assert again.architecture.components == sim.architecture.components
    assert again.architecture.edges == sim.architecture.edges


def test_autoconnect_joins_what_stays(tmp_path: Path) -> None:
    checked = check(tmp_path, '  sim: {without: "tag:spare"}\n', TYPES)
    assert [edge for edge in checked.architecture.edges if edge.input == "g.joined.c.x"] == []
    sim = checked.variants["sim"].architecture
    assert [edge.output for edge in sim.edges if edge.input == "g.joined.c.x"] == ["g.joined.a.x"]


def test_parts_of_instances_are_changed_by_dotted_paths(tmp_path: Path) -> None:
    variants = "  sim: {changes: {groups: {g: {components: {left.motor: {title: Simulated motor}}}}}}\n"
    sim = check(tmp_path, variants, TYPES).variants["sim"].architecture
    assert sim.components["g.left.motor"].title == "Simulated motor"
    assert sim.components["g.right.motor"].title == "Motor"


def test_types_of_libraries_are_changed_by_their_names(tmp_path: Path) -> None:
    robot = """\
archgen: 1
groups: {g: {components: {eye: {is: common.laser}}}}
libraries: {common: {component_types: {laser: {outputs: {scan: T}, title: Laser}}, types: {T: sensor_msgs/msg/LaserScan}}}
nodes: {eye: eye}
"""
    checked = check(tmp_path, "  sim: {changes: {component_types: {common.laser: {tags: [simulated]}}}}\n", robot)
    assert checked.variants["sim"].architecture.components["g.eye"].tags == ("simulated",)
    assert checked.architecture.components["g.eye"].tags == ()


@pytest.mark.parametrize(
    ("variants", "held"),
    [
        # In the project itself and in every variant: told once.
        ("  a: \n  b: \n", [()]),
        # What every variant gives is not missing in the project itself.
        ("  a: {changes: &c {groups: {g: {components: {a: {parameters: {speed: 1}}}}}}}\n  b: {changes: *c}\n", []),
        ("  a: {changes: {groups: {g: {components: {a: {parameters: {speed: 1}}}}}}}\n  b: \n", [("base", "b")]),
    ],
)
def test_findings_say_where_they_hold(tmp_path: Path, variants: str, held: list[tuple[str, ...]]) -> None:
    robot = (
        "archgen: 1\ngroups: {g: {components: {a: {title: A, parameters: {speed: {type: float}}}}}}\nnodes: {a: a}\n"
    )
    findings = check(tmp_path, variants, robot).findings
    assert [each.variants for each in findings if each.rule == "unset-parameter"] == held


def test_a_comment_that_one_variant_needs_is_not_unused(tmp_path: Path) -> None:
    robot = """\
archgen: 1
groups:
  g:
    components:
      a: {outputs: {x: T}}
      b: {inputs: {x: a.x}}  # archgen: ignore[unfed-input] the simulator gives it
types: {T: std_msgs/msg/Bool}
nodes: {a: a, b: b}
"""
    rules = {each.rule for each in check(tmp_path, '  sim: {without: "g.a"}\n', robot).findings}
    assert rules.isdisjoint({"unused-ignore", "unfed-input"})
    assert "unused-ignore" in {each.rule for each in check(tmp_path, "  sim: \n", robot).findings}


def test_settings_of_rules_hold_in_the_variant_that_writes_them(tmp_path: Path) -> None:
    variants = '  sim: {without: "g.a", changes: {rules: {unfed-input: off}}}\n  other: {without: "g.a"}\n'
    robot = "archgen: 1\ngroups: {g: {components: {a: {outputs: {x: T}}, b: {inputs: {x: a.x}}}}}\ntypes: {T: std_msgs/msg/Bool}\nnodes: {a: a, b: b}\n"
    findings = check(tmp_path, variants, robot).findings
    assert [each.variants for each in findings if each.rule == "unfed-input"] == [("other",)]
    assert next(each.message for each in findings if each.rule == "unfed-input").endswith("(in the variant `other`)")


def test_unknown_variants_are_refused(tmp_path: Path) -> None:
    checked = check(tmp_path, "  simulation: \n")
    with pytest.raises(pipeline.UnknownVariantError, match="did you mean `simulation`"):
        pipeline.stand_in_variants(checked, ["simulaton"])
    with pytest.raises(pipeline.UnknownVariantError, match="there are `base` and `simulation`"):
        pipeline.keep_variant_findings(checked, ["xyzzy"])


def test_variants_change_every_section_but_those_that_say_what_the_project_is() -> None:
    schema = load_schema()
    changed = schema["$defs"]["variant_changes"]["properties"]
    kept = {"archgen", "project", "sources", "libraries", "variants", "review", "conform", "agreements"}
    # A new section goes into `variant_changes`, as it stands among the properties of the schema.
    assert set(changed) == set(schema["properties"]) - kept
    for name in set(changed) - {"component_types"}:  # where types of libraries are named, too
        assert changed[name] == schema["properties"][name], name


@pytest.mark.parametrize(("of", "count"), [("", 150), ("of: [v1, v2, v3, v4], ", 30)])
def test_a_strangers_thousand_variants_are_not_all_judged(tmp_path: Path, of: str, count: int) -> None:
    variants = "".join(f"  v{number}: {{{of if number > 4 else ''}without: g.a}}\n" for number in range(1000))
    robot = "archgen: 1\ngroups: {g: {components: {a: A}}}\nnodes: {a: a}\n"
    checked = check(tmp_path, variants, robot)
    assert len(checked.variants) == pytest.approx(count, abs=5)
    assert [each.message for each in checked.findings if each.rule == "too-large"] == [
        f"all variants together have more than 150 layers: of 1,000 only the first {len(checked.variants)} are judged"
    ]


def test_a_variant_on_a_thousand_others_is_not_judged(tmp_path: Path) -> None:
    variants = "".join(f"  v{number}: {{of: [v{number + 1}], without: g.a}}\n" for number in range(3000))
    checked = check(tmp_path, variants, "archgen: 1\ngroups: {g: {components: {a: A}}}\nnodes: {a: a}\n")
    assert list(checked.variants) == []
    assert "too-large" in {each.rule for each in checked.findings}


def test_what_starts_after_what_is_gone_or_is_activated_by_it_names_it_no_more(tmp_path: Path) -> None:
    robot = """\
archgen: 1
groups: {g: {components: {m: {outputs: {x: T}, tags: [gone]}, a: {outputs: {y: T}, node: {package: p, executable: a, kind: lifecycle, start: {after: [m, b], by: m}}}, b: {outputs: {z: T}}}}}
types: {T: std_msgs/msg/String}
nodes:
  manager: {implements: m, package: nav2_lifecycle_manager, executable: lifecycle_manager}
  other: {implements: b, kind: lifecycle, start: {state: active, by: manager, after: [manager, a]}}
  last: {kind: lifecycle, start: {by: manager, after: manager}}
"""
    packed = pack(check(tmp_path, "  v: {without: 'tag:gone'}\n", robot).variants["v"])
    assert packed["groups"]["g"]["components"]["a"]["node"]["start"] == {"after": ["b"]}
    assert packed["nodes"]["other"]["start"] == {"state": "active", "after": ["a"]}
    assert packed["nodes"]["last"].get("start") is None


def test_what_waits_for_something_in_its_own_type_waits_for_no_other(tmp_path: Path) -> None:
    robot = """\
archgen: 1
component_types:
  arm:
    components:
      motor: {outputs: {angle: T}, node: {package: p, executable: m}}
      watch: {inputs: {angle: motor.angle}, node: {package: p, executable: w, start: motor}}
groups: {g: {components: {left: {is: arm}, right: {is: arm}, m: {title: M, tags: [gone]}, use: {title: U, node: {package: p, executable: u, start: manager}}}}}
nodes: {manager: {implements: m, package: p, executable: m}}
types: {T: std_msgs/msg/String}
"""
    checked = check(tmp_path, "  v: {without: 'g.left.motor tag:gone'}\n", robot)
    assert [str(each) for each in checked.findings if each.severity == "error"] == []
    starts = {
        name: node.start and [each.id for each in node.start.after]
        for name, node in checked.variants["v"].architecture.nodes.items()
    }
    assert starts == {"left_watch": None, "right_watch": ["g.right.motor"], "motor": None, "use": None}


@pytest.mark.parametrize(
    ("variants", "words"),
    [
        ("a b c d", "in every variant)"),
        ("a b c", "in every variant but `d`)"),
        ("a b", "in the variants `a` and `b`)"),
        ("d", "in the variant `d`)"),
    ],
)
def test_the_shorter_list_of_variants_is_told(tmp_path: Path, variants: str, words: str) -> None:
    lines = "".join(
        f"  {name}: {{{'without: tag:hardware' if name in variants.split() else 'title: V'}}}\n" for name in "abcd"
    )
    (finding,) = (
        each for each in check(tmp_path, lines).findings if each.rule == "unfed-input" and "level" in each.message
    )
    assert finding.message.endswith(words)
    assert finding.variants == tuple(variants.split())
    assert finding.absent_variants == tuple(name for name in "abcd" if name not in finding.variants)


@pytest.mark.parametrize(
    ("removing", "note"),
    [
        ("a", "it does not hold in the variant `a`"),
        ("a b c", "of the variants it holds in `d` only"),
        ("a b", "of the variants it holds in `c` and `d`"),
        ("a b c d", "it holds in no variant"),
    ],
)
def test_where_a_finding_of_the_project_does_not_hold_is_a_note(tmp_path: Path, removing: str, note: str) -> None:
    lines = "".join(
        f"  {name}: {{{'without: drive' if name in removing.split() else 'title: V'}}}\n" for name in "abcd"
    )
    robot = "archgen: 1\ngroups: {driving: {components: {drive: {outputs: {log: T}}, other: {inputs: {log: {from: drive.log, optional: true}}}}}}\ntypes: {T: std_msgs/msg/String}\n"
    checked = check(tmp_path, lines, robot)
    found = [each for each in checked.findings if each.rule == "missing-detail" and "driving.drive" in each.message]
    assert [phrase_absence(each) for each in found] == ([note] if removing != "a b c d" else [])


@pytest.mark.parametrize(
    ("body", "removal"),
    [
        ("changes: {nodes: {laser: ~}}", "`drop: [nodes.laser]`"),
        ("changes: {nodes: {laser: {}}}", "`drop: [nodes.laser]`"),
        ("changes: {hosts: {spare: }}", "`drop: [hosts.spare]`"),
        ("changes: {groups: {sensing: {components: {lidar: ~}}}}", "`without: sensing.lidar`"),
        ("changes: {nodes: {laser: {host: ~}}}", "`drop: [nodes.laser.host]`"),
        ("changes: {groups: {sensing: {components: {lidar: {title: }}}}}", "`drop: [groups.sensing.components.lidar.title]`"),
    ],
)  # fmt: skip
def test_what_is_empty_changes_nothing_and_is_told_with_what_takes_it_out(
    tmp_path: Path, body: str, removal: str
) -> None:
    findings = [
        each for each in check(tmp_path, f"  sim: {{{body}}}\n").findings if each.rule == "missing-variant-part"
    ]
    assert [each.help and removal in each.help for each in findings] == [True]
    key, _, written = removal.strip("`").partition(": ")
    followed = check(tmp_path, f"  sim: {{{key}: {written}}}\n").findings
    assert [each for each in followed if each.rule in {"missing-variant-part", "empty-variant-selector"}] == []


@pytest.mark.parametrize(
    "body",
    [
        "without: tag:hardware, changes: {groups: {sensing: {components: {lidar: ~}}}}",
        "changes: {nodes: {laser: {parameters: {x: ~}}, another: {implements: lidar}}, hosts: {new_pc: }}",
    ],
)
def test_what_is_empty_and_says_something_is_not_told(tmp_path: Path, body: str) -> None:
    """A component that stays, a parameter without a value, an element of its own."""
    findings = check(tmp_path, f"  sim: {{{body}}}\n").findings
    assert [each.message for each in findings if each.rule == "missing-variant-part"] == []
