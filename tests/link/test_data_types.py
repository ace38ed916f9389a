"""Types with fields are messages of the project, as if their files were there."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.checking.checked_packing import pack_checked_project
from archgen.link.data_types import field_types, message_definitions
from archgen.link.data_types.field_types import FieldTypeReader, TypeSources
from archgen.link.declare.type_declaration import drop_circular_fields
from archgen.model.known_interfaces import Interface
from archgen.model.message_types import ConceptualType, DataField
from archgen.pipeline import CheckedProject
from archgen.syntax.yaml_writer import write_yaml
from tests.property_sizes import try_some

Checked = Callable[[str], CheckedProject]
HEAD = """\
archgen: 1
project: {id: robot}
ros: {distro: jazzy}
groups: {g: {components: {a: {outputs: OUTPUTS}}}}
types:
"""


@pytest.fixture
def checked(tmp_path: Path) -> Checked:
    """Check a project whose component gives an output of each type that is named."""

    def run(text: str) -> CheckedProject:
        (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
        return pipeline.check_project(tmp_path / "robot.yaml")

    return run


def project(types: str, *outputs: str) -> str:
    ports = ", ".join(f'o{number}: "{name}"' for number, name in enumerate(outputs))
    return HEAD.replace("OUTPUTS", f"{{{ports}}}") + types


def definition_lines(interface: Interface) -> list[str]:
    """Give a definition as ROS writes it."""
    lines = list[str]()
    for number, fields in enumerate(interface.parts):
        lines += ["---"] if number else []
        for constants in interface.constants[number : number + 1]:
            lines += [f"{each.type} {each.name}={each.value}" for each in constants]
        lines += [
            " ".join(
                filter(
                    None, (f"{each.type}{each.array} {each.name}", each.default, each.comment and "# " + each.comment)
                )
            )
            for each in fields
        ]
    return lines


@pytest.mark.parametrize(
    ("types", "output", "message", "lines"),
    [
        (
            "  Robot pose: {fields: {position: geometry_msgs/Point, covariance: 'float64[36]', stamp: time}}",
            "Robot pose",
            "robot_msgs/msg/RobotPose",
            ["geometry_msgs/msg/Point position", "float64[36] covariance", "builtin_interfaces/msg/Time stamp"],
        ),
        (
            "  speed_limit: {fields: {v: {type: float32, default: 0.5, unit: m/s, comment: Never more.}}}",
            "speed_limit",
            "robot_msgs/msg/SpeedLimit",
            ["float32 v 0.5 # [m/s] Never more."],
        ),
        (
            "  Names: {fields: {a: {type: 'string<=9', default: 'say \"so\"'}, b: {type: 'string[<=3]', default: [x, 'y, z']}}}",
            "Names",
            "robot_msgs/msg/Names",
            ['string<=9 a "say \\"so\\""', 'string[<=3] b ["x", "y, z"]'],
        ),
        (
            "  Limits: {fields: {}, constants: {MAX: {type: uint8, value: 32}, WHO: {type: string, value: me}}}",
            "Limits",
            "robot_msgs/msg/Limits",
            ["uint8 MAX=32", 'string WHO="me"'],
        ),
        (
            "  Mode: {values: [IDLE, RUN], constants: {LEVELS: {type: int8, value: 2}}}",
            "Mode",
            "robot_msgs/msg/Mode",
            ["uint8 IDLE=0", "uint8 RUN=1", "int8 LEVELS=2", "uint8 value"],
        ),
        (
            "  Here: {message: nav_msgs_of_ours/msg/There, fields: {x: bool}}",
            "Here",
            "nav_msgs_of_ours/msg/There",
            ["bool x"],
        ),
        ("  our_msgs/msg/Own: {fields: {x: bool}}", "our_msgs/Own", "our_msgs/msg/Own", ["bool x"]),
        (
            "  Outer: {fields: {all: 'Inner[<=3]', wide: Laser scan}}\n  Inner: {fields: {mode: Mode}}\n  Mode: {values: [A]}",
            "Outer",
            "robot_msgs/msg/Outer",
            ["robot_msgs/msg/Inner[<=3] all", "sensor_msgs/msg/LaserScan wide"],
        ),
        (
            "  Outer: {fields: {later: 'Undecided[]'}}\n  Undecided: {comment: not mapped yet}",
            "Outer",
            "robot_msgs/msg/Outer",
            ["Undecided[] later"],
        ),
        (
            "  Set gain: {request: {gain: float64}, response: {ok: bool}}",
            "Set gain",
            "robot_msgs/srv/SetGain",
            ["float64 gain", "---", "bool ok"],
        ),
        (
            "  Fetch: {request: {what: string}, response: {}, feedback: {share: {type: float32, unit: '%'}}}",
            "Fetch",
            "robot_msgs/action/Fetch",
            ["string what", "---", "---", "float32 share # [%]"],
        ),
        (
            "  Ask: {request: Question, response: {answer: string}}\n  Question: {fields: {text: string}, constants: {MAX: {type: int8, value: 1}}}",
            "Ask",
            "robot_msgs/srv/Ask",
            ["int8 MAX=1", "string text", "---", "string answer"],
        ),
        (
            "  Ask: {request: Question, response: Answer}\n  Question: {fields: {text: string}}\n  Answer: {fields: {}}",
            "Ask",
            "robot_msgs/srv/Ask",
            ["string text", "---"],
        ),
        (
            "  Envelope: {generic: [T], fields: {sender: string, payload: T, more: 'T[]'}}\n  Robot pose: {fields: {x: float64}}",
            "Envelope< Robot pose >",
            "robot_msgs/msg/EnvelopeRobotPose",
            ["string sender", "robot_msgs/msg/RobotPose payload", "robot_msgs/msg/RobotPose[] more"],
        ),
        (
            "  Pair: {generic: [A, B], fields: {a: A, b: B}}\n  List: {generic: [T], fields: {all: 'T[]', pair: 'Pair<T, uint8>'}}",
            "List<Pair<geometry_msgs/msg/Point,List<bool>>>",
            "robot_msgs/msg/ListPairPointListBool",
            ["robot_msgs/msg/PairPointListBool[] all", "robot_msgs/msg/PairPairPointListBoolUint8 pair"],
        ),
        (
            "  Box: {generic: [T], size: 1 kB, fields: {in: T}}\n  Box<Pose>: {message: box_msgs/msg/PoseBox}",
            "Box<Pose>",
            "box_msgs/msg/PoseBox",
            ["geometry_msgs/msg/PoseStamped in"],
        ),
        (
            "  Get: {generic: [T], request: {id: uint8}, response: {found: T}}",
            "Get<uint16>",
            "robot_msgs/srv/GetUint16",
            ["uint8 id", "---", "uint16 found"],
        ),
        ("  Map <5: {fields: {x: bool}}", "Map <5", "robot_msgs/msg/Map5", ["bool x"]),
    ],
)  # fmt: skip
def test_a_type_with_fields_is_a_message_of_the_project(
    checked: Checked, types: str, output: str, message: str, lines: list[str]
) -> None:
    result = checked(project(types, output))
    architecture = result.architecture
    assert [str(finding) for finding in result.findings if finding.severity == "error"] == []
    assert architecture.message_of(architecture.outputs["g.a.o0"]) == message
    assert definition_lines(architecture.interfaces.definitions[message]) == lines
    assert architecture.interfaces.status_of(message) == "known"


@pytest.mark.parametrize(("count", "value_type"), [(1, "uint8"), (256, "uint8"), (257, "uint16"), (65_537, "uint32")])
def test_an_enumeration_takes_the_smallest_type_that_holds_its_values(
    checked: Checked, count: int, value_type: str
) -> None:
    names = ", ".join(f"A{number}" for number in range(count))
    result = checked(project(f"  Mode: {{values: [{names}]}}", "Mode"))
    definition = result.architecture.interfaces.definitions["robot_msgs/msg/Mode"]
    assert [(field.name, field.type) for field in definition.parts[0]] == [("value", value_type)]
    assert (definition.constants[0][-1].value, definition.constants[0][-1].type) == (str(count - 1), value_type)


def test_a_definition_elsewhere_counts_where_a_service_only_names_its_types(checked: Checked) -> None:
    types = """\
  Find: {message: robot_msgs/srv/Find, request: Question, response: Question}
  Shipped: {message: std_srvs/srv/Trigger, request: Question}
  Question: {fields: {text: string}}
"""
    text = project(types, "Find", "Shipped").replace(
        "ros: {distro: jazzy}", 'ros: {distro: jazzy, definitions: {robot_msgs/srv/Find: "bool x\\n---\\nbool y"}}'
    )
    result = checked(text)
    assert [str(finding) for finding in result.findings if finding.severity == "error"] == []
    assert definition_lines(result.architecture.interfaces.definitions["robot_msgs/srv/Find"]) == [
        "bool x",
        "---",
        "bool y",
    ]


def test_definitions_may_name_the_messages_of_types_and_back(checked: Checked) -> None:
    text = project("  Pose: {fields: {x: float64}}\n  Outer: {fields: {grasp: robot_msgs/Grasp}}", "Outer").replace(
        "ros: {distro: jazzy}",
        'ros: {distro: jazzy, definitions: {robot_msgs/msg/Grasp: "Pose pose", robot_msgs/msg/Ring: "Outer2 o"}}',
    )
    result = checked(text)
    assert [finding.message for finding in result.findings if finding.severity == "error"] == [
        "there is no message `robot_msgs/msg/Outer2`"
    ]


def test_a_circle_through_a_definition_is_found(checked: Checked) -> None:
    text = project("  Outer: {fields: {grasp: robot_msgs/Grasp}}", "Outer").replace(
        "ros: {distro: jazzy}", 'ros: {distro: jazzy, definitions: {robot_msgs/msg/Grasp: "Outer o"}}'
    )
    assert [finding.message for finding in checked(text).findings if finding.severity == "error"] == [
        "`robot_msgs/msg/Grasp` holds itself, through `robot_msgs/msg/Outer`"
    ]


def test_what_could_not_be_read_may_declare_a_type(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(project("  Pose: {fields: {x: Point of view}}", "Pose"), encoding="utf-8")
    (tmp_path / "broken.yaml").write_text("types: {Point of view: {fields: {x: [}\n", encoding="utf-8")
    rules = {finding.rule for finding in pipeline.check_project(tmp_path).findings}
    assert "unknown-field-type" not in rules
    assert "syntax-error" in rules


def test_fields_of_one_type_may_stand_in_two_files(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(project("  Pose: {fields: {x: float64}}", "Pose"), encoding="utf-8")
    (tmp_path / "more.yaml").write_text(
        "types: {Pose: {fields: {x: {unit: m}, y: {type: float64}}, constants: {A: {type: int8, value: 1}}}}\n",
        encoding="utf-8",
    )
    checked_project = pipeline.check_project(tmp_path)
    definition = checked_project.architecture.interfaces.definitions["robot_msgs/msg/Pose"]
    assert definition_lines(definition) == ["int8 A=1", "float64 x # [m]", "float64 y"]
    assert [str(finding) for finding in checked_project.findings if finding.severity == "error"] == []


def test_packing_keeps_fields_where_they_are_and_makes_no_definitions_of_them(checked: Checked, tmp_path: Path) -> None:
    types = """\
  Pose: {fields: {x: {type: float64, default: 1.10, unit: m}, n: {type: "int8[2]", default: [1, 2]}, t: {type: string, default: "no"}}}
  Mode: {values: [ON, OFF], constants: {MAX: {type: float32, value: 1.50}}}
  Envelope: {generic: [T], fields: {payload: T, scan: Laser scan}}
  Set gain: {request: {gain: float64}, response: {}}
"""
    first = checked(project(types, "Pose", "Mode", "Envelope<Pose>", "Set gain"))
    packed = pack_checked_project(first)
    text = write_yaml(packed.data, packed.comments)
    assert packed.data["ros"] == {"distro": "jazzy"}
    (tmp_path / "packed.yaml").write_text(text, encoding="utf-8")
    second = pipeline.check_project(tmp_path / "packed.yaml")
    again = pack_checked_project(second)
    assert write_yaml(again.data, again.comments) == text
    names = [name for name in first.architecture.interfaces.names if name.startswith("robot_msgs/")]
    assert sorted(names) == [
        "robot_msgs/msg/EnvelopePose",
        "robot_msgs/msg/Mode",
        "robot_msgs/msg/Pose",
        "robot_msgs/srv/SetGain",
    ]
    for name in names:
        definitions = [each.architecture.interfaces.definitions[name] for each in (first, second)]
        assert definitions[0] == definitions[1]


@pytest.mark.parametrize(
    ("types", "output", "message"),
    try_some([
        (
            "".join(f"  L{i}: {{generic: [T], fields: {{a: 'L{i + 1}<P<T>>', b: 'L{i + 1}<Q<T>>'}}}}\n" for i in range(20))
            + "  L20: {generic: [T], fields: {x: T}}\n  P: {generic: [T], fields: {x: T}}\n  Q: {generic: [T], fields: {x: T}}",
            "L0<bool>",
            "`L0<bool>` and other generic types make more than 20,000 fields",
        ),
        (
            "".join(f"  L{i}: {{generic: [T], fields: {{a: 'L{i + 1}<P<T, T>>'}}}}\n" for i in range(20))
            + "  L20: {generic: [T], fields: {x: T}}\n  P: {generic: [A, B], fields: {x: A}}",
            "L0<bool>",
            "`L0<bool>` makes types with names of more than 200 characters",
        ),
        (
            "  Wide: {fields: {" + ", ".join(f"f{i}: bool" for i in range(11_000)) + "}}\n  A: {request: Wide}\n  B: {request: Wide}",
            "Wide",
            "`B` and others take more than 20,000 fields from the types they name",
        ),
    ], 2),
)  # fmt: skip
def test_types_that_multiply_have_a_limit(checked: Checked, types: str, output: str, message: str) -> None:
    findings = [finding for finding in checked(project(types, output)).findings if finding.severity == "error"]
    assert message in [finding.message for finding in findings if finding.rule == "too-large"]


def test_only_generic_types_are_bound() -> None:
    types = {
        "Box": ConceptualType("Box", fields=(DataField("x", "T"),), generic=("T",)),
        "Plain": ConceptualType("Plain", fields=()),
    }
    bound_type = field_types.make_bound_type("Box<Plain>", types)
    assert bound_type is not None
    assert bound_type.fields == (DataField("x", "Plain"),)
    assert field_types.make_bound_type("Plain<Box>", types) is None
    assert field_types.make_bound_type("Box<Plain, Plain>", types) is None
    assert field_types.add_used_types(types, ["Box<Plain>"], {}) == []
    assert list(types) == ["Box", "Plain", "Box<Plain>"]
    assert message_definitions.defines_message(types["Box<Plain>"], types)
    reader = FieldTypeReader(types, TypeSources("r", {}))
    maker = message_definitions.DefinitionMaker(types, reader, [])
    assert maker.make_definition(types["Plain"], types["Plain"].at).definition.interface.parts == ((),)
    diagnostics: list[object] = []
    drop_circular_fields(types, diagnostics)  # type: ignore[arg-type]
    assert diagnostics == []


def test_a_text_of_ros_1_goes_on_to_the_end_of_its_line() -> None:
    assert message_definitions.write_literal("string", "a # b", ros1=True) == "a # b"
    assert message_definitions.explain_bad_text("string", "a # b", ros1=True) is None
    assert message_definitions.explain_bad_text("string", "a # b", ros1=False) is not None
