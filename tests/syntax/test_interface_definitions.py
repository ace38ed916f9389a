"""Interface definitions: what is read of them, what is refused and where, and what ROS itself says to the same text."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosbags.interfaces import Nodetype
from rosbags.typesys import get_types_from_msg

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import Span
from archgen.model.known_interfaces import InterfaceConstant, InterfaceField
from archgen.syntax.interface_definitions import InterfaceDefinition, parse_interface_definition
from tests.outside_tools import ask_ros_parsers

JUDGES = Path(__file__).resolve().parents[1] / "judges" / "ros_definitions.py"
Parts = list[list[list[str]]]


def read(text: str, kind: str = "msg", *, ros1: bool = False) -> InterfaceDefinition:
    return parse_interface_definition(text, f"demo_msgs/{kind}/Foo", "Foo", ros1=ros1)


def parts(definition: InterfaceDefinition) -> Parts:
    return [[[field.name, field.type, field.array] for field in part] for part in definition.interface.parts]


def brief(diagnostic: Diagnostic) -> str:
    """Write a finding as `line:column-end message (help)`."""
    span = diagnostic.span
    help_ = f" ({diagnostic.help})" if diagnostic.help else ""
    return f"{span.line}:{span.column}-{span.end_column} {diagnostic.message}{help_}"


def judged(cases: list[tuple[bool, str, str]]) -> list[Parts | None]:
    """Ask ROS's own parsers."""
    verdicts: list[Parts | None] = ask_ros_parsers(cases)
    return verdicts


VALID_2 = [
    ("", [[]]),
    ("# only a comment", [[]]),
    ("float64 x", [[["x", "float64", ""]]]),
    ("float64 x # metres", [[["x", "float64", ""]]]),
    ("float64\tx\r\nbool y\r\n", [[["x", "float64", ""], ["y", "bool", ""]]]),
    ("float64[] x", [[["x", "float64", "[]"]]]),
    ("float64[36] x", [[["x", "float64", "[36]"]]]),
    ("float64[<=3] x", [[["x", "float64", "[<=3]"]]]),
    ("string<=10 x", [[["x", "string<=10", ""]]]),
    ("wstring<=10[<=3] x", [[["x", "wstring<=10", "[<=3]"]]]),
    ("Pose x", [[["x", "demo_msgs/msg/Pose", ""]]]),
    ("geometry_msgs/Pose[2] x", [[["x", "geometry_msgs/msg/Pose", "[2]"]]]),
    ("time x", [[["x", "builtin_interfaces/msg/Time", ""]]]),
    ("uint8 LIMIT=3\nint8 LOW = -128", [[]]),
    ("uint8 MASK=0xff\nint32 BITS=-0b11", [[]]),
    ('string NAME="a b"\nstring OTHER=a b', [[]]),
    ("bool ON=true\nbool OFF=0\nbyte TOP=255\nchar C=255", [[]]),
    ("float32 X=1e-3\nfloat64 Y=nan", [[]]),
    ("int32 x 3\nbool y False\nfloat32 z .5", [[["x", "int32", ""], ["y", "bool", ""], ["z", "float32", ""]]]),
    ("int32[] x [1, 2]\nint32[2] y [1,2]", [[["x", "int32", "[]"], ["y", "int32", "[2]"]]]),
    ("int32[] x []", [[["x", "int32", "[]"]]]),
    ('string[] x [\'a, b\', "it\\"s"]', [[["x", "string", "[]"]]]),
    ("string<=2[] x ['ab', cd]", [[["x", "string<=2", "[]"]]]),
    ("string x 'it\\'s'", [[["x", "string", ""]]]),
]


@pytest.mark.parametrize(("text", "expected"), VALID_2)
def test_ros_2_reads(text: str, expected: Parts) -> None:
    definition = read(text)
    assert definition.diagnostics == ()
    assert parts(definition) == expected


FIELD_NAMES = "(small letters, digits and single underscores, a letter first, as in `gripper_width`)"
CONSTANT_NAMES = "(capitals, digits and single underscores, a capital first, as in `MAX_WIDTH`)"
STRINGS = "(the strings of an array are separated by commas, and quotes are closed)"
INVALID_2 = [
    ("float64", "1:1-8 `float64` is no definition: a type and a name are needed (for instance `float64 width`)"),
    ("  float64 x", "1:1-3 a definition of ROS 2 begins in the first column"),
    ("float x", "1:1-6 there is no type `float` in ROS (did you mean `float32`?)"),
    ("flaot32 x", "1:1-8 `flaot32` is no type (did you mean `float32`?)"),
    (
        "geometry_msgs/msg/Pose x",
        "1:1-23 inside definitions a message has two parts, not `geometry_msgs/msg/Pose` (write `geometry_msgs/Pose`)",
    ),
    ("int32[0] x", "1:1-9 `[0]` is no size of an array (an array is written `[]`, `[3]` or `[<=3]`)"),
    ("int32[<=0] x", "1:1-11 `[<=0]` is no size of an array (an array is written `[]`, `[3]` or `[<=3]`)"),
    ("int32[n] x", "1:1-9 `[n]` is no size of an array (an array is written `[]`, `[3]` or `[<=3]`)"),
    (
        "int32[2][2] x",
        "1:1-12 arrays have one dimension only (put the inner array into a message of its own)",
    ),
    ("string<=0 x", "1:1-10 `string<=0` is no bounded string (it is written `string<=10`, with a length above 0)"),
    (
        "int32 Xy",
        f"1:7-9 `Xy` is no name of a field {FIELD_NAMES}",
    ),
    (
        "int32 a__b",
        f"1:7-11 `a__b` is no name of a field {FIELD_NAMES}",
    ),
    (
        "int32 low=1",
        f"1:7-10 `low` is no name of a constant {CONSTANT_NAMES}",
    ),
    ("uint8 A=256", "1:9-12 `256` is no value of `uint8` (uint8 holds 0 to 255)"),
    ("byte A=-1", "1:8-10 `-1` is no value of `byte` (byte holds 0 to 255)"),
    ("int64 A=9223372036854775808", None),
    ("uint8 A=1.5", "1:9-12 `1.5` is no value of `uint8` (an integer is needed)"),
    ("uint8 A=", "1:9-10 `` is no value of `uint8` (an integer is needed)"),
    ("bool A=yes", "1:8-11 `yes` is no value of `bool` (a bool is `true` or `false`)"),
    ("float32 A=1,5", "1:11-14 `1,5` is no value of `float32` (a number is needed, with a point for the decimals)"),
    ("Pose A=1", "1:1-5 a constant has a builtin type, not `Pose`"),
    ("string<=3 A=abc", "1:1-10 a constant has a builtin type, not `string<=3` (did you mean `string`?)"),
    ("int8 x 128", "1:8-11 `128` is no value of `int8` (int8 holds -128 to 127)"),
    ("Pose x 1", "1:8-9 only a field of a builtin type has a default"),
    ("int32[] x 1", "1:11-12 `1` is no value of `int32[]` (an array's value stands in brackets, as in `[1, 2]`)"),
    ("int32[2] x [1]", "1:12-15 `[1]` is no value of `int32[2]` (1 values for an array of exactly 2)"),
    ("int32[<=1] x [1,2]", "1:14-19 `[1,2]` is no value of `int32[<=1]` (2 values for an array of at most 1)"),
    ("int8[] x [1,200]", "1:10-17 `[1,200]` is no value of `int8[]` (int8 holds -128 to 127)"),
    (
        "string[] x ['a]",
        f"1:12-16 `['a]` is no value of `string[]` {STRINGS}",
    ),
    ("string<=2 x abc", "1:13-16 `abc` is no value of `string<=2` (3 characters for a string of at most 2)"),
    ('string x "a"b"', '1:10-15 `"a"b"` is no value of `string` (a quote inside is written `\\"`)'),
    ("int32 x\nbool x", "2:6-7 there are two fields `x`"),
    ("int32 X=1\nint32 X=2", "2:7-8 there are two constants `X`"),
    ("int32 x\n---\nint32 y", "2:1-4 the definition of a message has no line `---`"),
    (
        "@topic int32 x",
        "1:1-7 `@topic` is no type (a message is written `Name` or `package/Name`, letters and digits, a capital first)",
    ),
]


@pytest.mark.parametrize(("text", "expected"), INVALID_2)
def test_ros_2_refuses(text: str, expected: str | None) -> None:
    found = [brief(diagnostic) for diagnostic in read(text).diagnostics]
    assert found[0:1] == ([expected] if expected else found[0:1])
    assert found


VALID_1 = [
    ("Header header\ntime t", [[["header", "std_msgs/msg/Header", ""], ["t", "time", ""]]]),
    ("Header[] old", [[["old", "demo_msgs/msg/Header", "[]"]]]),
    ("  int32 X  # indented", [[["X", "int32", ""]]]),
    ("duration[3] myX\nchar c\nbyte b", [[["myX", "duration", "[3]"], ["c", "char", ""], ["b", "byte", ""]]]),
    ("byte LOW=-128\nchar HIGH=255\nbool ON=True", [[]]),
    ("string TEXT= a # b = c", [[]]),
    ("sensor_msgs/Image image", [[["image", "sensor_msgs/msg/Image", ""]]]),
]


@pytest.mark.parametrize(("text", "expected"), VALID_1)
def test_ros_1_reads(text: str, expected: Parts) -> None:
    definition = read(text, ros1=True)
    assert definition.diagnostics == ()
    assert parts(definition) == expected


INVALID_1 = [
    ("int32\tx", "1:1-8 in ROS 1 a blank stands between type and name, not a tab"),
    ("int32 x 3", "1:9-10 a field of ROS 1 has no default (a comment begins with `#`; a constant is `uint8 NAME=3`)"),
    ("int32[<=3] x", "1:1-11 `[<=3]` is no size of an array (an array is written `[]` or `[3]`)"),
    ("string<=3 x", "1:1-10 ROS 1 has no bounded strings (write `string`)"),
    ("int32 A=0x10", "1:9-13 `0x10` is no value of `int32` (an integer is needed, in base ten)"),
    ("bool A=true", "1:8-12 `true` is no value of `bool` (a bool is `True` or `False`)"),
    ("byte A=128", "1:8-11 `128` is no value of `byte` (byte holds -128 to 127)"),
    ("time A=1", "1:1-5 a constant has a builtin type, not `time`"),
    ("int32 _x", "1:7-9 `_x` is no name of a field (letters, digits and underscores, a letter first)"),
    ("int32 x\nint32 x", "2:7-8 there are two fields `x`"),
]


@pytest.mark.parametrize(("text", "expected"), INVALID_1)
def test_ros_1_refuses(text: str, expected: str) -> None:
    assert [brief(diagnostic) for diagnostic in read(text, ros1=True).diagnostics] == [expected]


def test_all_errors_at_once_and_the_sound_fields_stay() -> None:
    definition = read("int23 x\nfloat64 width\nuint8 A=300\nbool  Open\nfloat64 width")
    assert [brief(diagnostic).split(" (")[0] for diagnostic in definition.diagnostics] == [
        "1:1-6 `int23` is no type",
        "3:9-12 `300` is no value of `uint8`",
        "4:7-11 `Open` is no name of a field",
        "5:9-14 there are two fields `width`",
    ]
    assert definition.interface.parts == ((InterfaceField("width", "float64"),),)
    assert definition.diagnostics[3].labels == ((Span("Foo", 2, 9, 2, 14), "the first one"),)


def test_optional_fields_of_newer_distributions() -> None:
    """The judge at hand is older than this; it refuses them."""
    definition = read("@optional int32 x\n@optional\nbool y\n@optional float z")
    assert parts(definition) == [[["x", "int32", ""], ["y", "bool", ""]]]
    assert [brief(diagnostic) for diagnostic in definition.diagnostics] == [
        "4:11-16 there is no type `float` in ROS (did you mean `float32`?)"
    ]


def test_references_carry_their_places() -> None:
    definition = read("geometry_msgs/Pose[] a\nGrasp b")
    assert definition.references == (
        ("geometry_msgs/msg/Pose", Span("Foo", 1, 1, 1, 21)),
        ("demo_msgs/msg/Grasp", Span("Foo", 2, 1, 2, 6)),
    )


@pytest.mark.parametrize(
    ("kind", "text", "expected"),
    [
        ("srv", "int32 a", "1:1-1 the definition of a service needs a line `---` between request and response"),
        ("srv", "---\n---", "2:1-4 the definition of a service has one line `---`"),
        ("srv", "int32 a\n--- \nint32 a", "2:1-4 a separating line is `---` and nothing else"),
        (
            "action",
            "---",
            "1:1-1 the definition of an action needs a line `---` after the goal and one after the result",
        ),
        ("action", "---\n---\n---", "3:1-4 the definition of an action has two lines `---`"),
    ],
)
def test_separators_are_counted(kind: str, text: str, expected: str) -> None:
    assert brief(read(text, kind).diagnostics[0]).split(" (")[0] == expected


def test_parts_have_their_own_names() -> None:
    definition = read("int32 a\n---\nint32 a\nbool ok\n---\n", "action")
    assert definition.diagnostics == ()
    assert parts(definition) == [[["a", "int32", ""]], [["a", "int32", ""], ["ok", "bool", ""]], []]


@pytest.mark.ros
def test_ros_agrees_with_the_tables() -> None:
    cases = [(False, "demo_msgs/msg/Foo", text) for text, _ in (*VALID_2, *INVALID_2)]
    cases += [(True, "demo_msgs/msg/Foo", text) for text, _ in (*VALID_1, *INVALID_1)]
    expected = [parts for _, parts in VALID_2] + [None] * len(INVALID_2)
    expected += [parts for _, parts in VALID_1] + [None] * len(INVALID_1)
    for case, wanted, verdict in zip(cases, expected, judged(cases), strict=True):
        assert verdict == wanted, case


_TYPES = (
    "int32 uint8 int64 string wstring float64 bool byte char time duration Header Pose geometry_msgs/Pose string<=5 "
    "wstring<=3 string<=0 int23 _x 1x int8<=3 /Pose Geo_msgs/Pose geo__m/Pose g_/Pose Pose_Request Foo_Bar a/b/c/d"
)
TYPES = _TYPES.split()
ARRAYS = ["", "", "", "[]", "[3]", "[<=3]", "[0]", "[x]", "[3", "3]", "[3][4]"]
NAMES = ["x", "y", "my_x", "X", "MY_X", "X__Y", "X_", "x__y", "x_", "1x", "myX", "x-y", "X1", "é"]
_VALUES = (
    "|1|-1|255|256|-128|-129|0x10|1.5|nan|1e5|true|True|2|'a'|\"a\"|abc|\"a|[1,2,3]|[1, 2]|[]|[1,]|['a','b']|['a', 'b,c']|"
    "[a,b]|['a' 'b']|[,]|'a\\'b'|'a'b'|hello world|-0|0b1|1 2|é|=|18446744073709551615|9223372036854775808|+1|a#b"
)
VALUES = _VALUES.split("|")


def made_up(source: random.Random) -> tuple[bool, str, str]:
    """Put a definition together that may be right or wrong in many ways."""
    ros1, kind = source.random() < 0.4, source.choice(("msg", "msg", "msg", "srv", "action"))
    if ros1 and kind == "action":
        kind = "srv"
    count = {"msg": 1, "srv": 2, "action": 3}[kind]
    count = count if ros1 or source.random() < 0.9 else 2  # genmsg does not count separators
    blocks = ["\n".join(made_up_line(source) for _ in range(source.choice((0, 1, 1, 2)))) for _ in range(count)]
    return ros1, f"demo_msgs/{kind}/Foo", "\n---\n".join(blocks)


def made_up_line(source: random.Random) -> str:
    """Put one line together."""
    gap, comment = source.choice((" ", " ", "  ", "\t")), source.choice(("", "", "", " # a=b"))
    if source.random() < 0.5:
        default = source.choice(("", "", " " + source.choice(VALUES)))
        return source.choice(TYPES) + source.choice(ARRAYS) + gap + source.choice(NAMES) + default + comment
    equals = source.choice(("=", " = "))
    return source.choice(TYPES) + gap + source.choice(NAMES) + equals + source.choice(VALUES) + comment


@pytest.mark.ros
def test_ros_agrees_on_made_up_definitions() -> None:
    """ROS 2: the same in every case. ROS 1: what genmsg refuses we refuse, and what we take it reads the same.

    genmsg takes more: names that no language can compile, bools that are lists, types with three parts.
    """
    source = random.Random(20)  # noqa: S311  # no secret
    cases = [made_up(source) for _ in range(4000)]
    taken = 0
    for (ros1, name, text), verdict in zip(cases, judged(cases), strict=True):
        definition = parse_interface_definition(text, name, "Foo", ros1=ros1)
        ours = None if definition.diagnostics else parts(definition)
        taken += ours is not None
        if not ros1 or ours is not None:
            assert ours == verdict, (ros1, name, text, definition.diagnostics)
    assert taken > 400


def test_rosbags_reads_the_same() -> None:
    """A second judge: rosbags, which writes ROS 1's times as messages and knows no bounded wide strings."""
    for ros1, table in ((False, VALID_2), (True, VALID_1)):
        for text, _ in table:
            if "wstring" in text or "=" in text.split("#")[0].replace("<=", "") or "it" in text or "\r" in text:
                continue
            ours = read(text, ros1=ros1).interface.parts[0]
            theirs = get_types_from_msg(text + "\n", "demo_msgs/msg/Foo")["demo_msgs/msg/Foo"][1]
            assert [field.name for field in ours] == [name for name, _ in theirs], text
            assert [_shape(field) for field in ours] == [_their_shape(node) for _, node in theirs], text


def _shape(field: InterfaceField) -> tuple[str, str]:
    times = {"time": "builtin_interfaces/msg/Time", "duration": "builtin_interfaces/msg/Duration"}
    name = times.get(field.type, field.type).replace("demo_msgs/msg/Header", "std_msgs/msg/Header")
    return name, field.array


def _their_shape(node: tuple[int, Any]) -> tuple[str, str]:
    kind, details = node
    if kind == Nodetype.BASE:
        return details[0] + (f"<={details[1]}" if details[1] else ""), ""
    if kind == Nodetype.NAME:
        return details, ""
    element, size = details
    limit = str(size) if kind == Nodetype.ARRAY else f"<={size}" if size else ""
    return _their_shape(element)[0], f"[{limit}]"


@given(st.text(), st.sampled_from(["msg", "srv", "action"]), st.booleans())
def test_no_text_raises(text: str, kind: str, ros1: bool) -> None:  # noqa: FBT001  # hypothesis gives it
    definition = read(text, kind, ros1=ros1)
    assert len(definition.interface.parts) == {"msg": 1, "srv": 2, "action": 3}[kind]
    lines = text.count("\n") + text.count("\r") + 1
    assert all(1 <= diagnostic.span.line <= lines for diagnostic in definition.diagnostics)


@given(st.lists(st.sampled_from([*TYPES, *ARRAYS, *NAMES, *VALUES, " ", "=", "#", "\n", "---\n", "\t", "\\", "'"])))
def test_no_likely_text_raises(pieces: list[str]) -> None:
    for ros1 in (False, True):
        read("".join(pieces), "srv", ros1=ros1)


def test_comments_belong_to_what_they_stand_above_and_behind() -> None:
    text = """\
# How the arm stands.

# In radians,
# counted from the stretched arm.
float64 elbow  # positive upwards
float64 wrist
uint8 LEFT=0   # seen from behind
# The last word.
"""
    interface = parse_interface_definition(text, "m/msg/Arm", "Arm.msg", ros1=False).interface
    assert interface.parts == (
        (
            InterfaceField("elbow", "float64", "", "", "In radians, counted from the stretched arm. positive upwards"),
            InterfaceField("wrist", "float64"),
        ),
    )
    assert interface.constants == ((InterfaceConstant("LEFT", "uint8", "0", "seen from behind"),),)
    assert interface.comment == "How the arm stands.\nThe last word."


def test_constants_and_defaults_are_as_written() -> None:
    text = 'uint8 A=1 # one\nstring B="x # y"\nint32[] c [1, 2]\n---\nuint8 A = 2\n'
    interface = parse_interface_definition(text, "m/srv/Do", "Do.srv", ros1=False).interface
    assert [[(constant.name, constant.value) for constant in part] for part in interface.constants][1] == [("A", "2")]
    assert interface.constants[0][0] == InterfaceConstant("A", "uint8", "1", "one")
    assert interface.parts[0] == (InterfaceField("c", "int32", "[]", "[1, 2]"),)
    # In ROS 1 a text goes on to the end of the line.
    old = parse_interface_definition("string B=x # y\n", "m/msg/Old", "Old.msg", ros1=True).interface
    assert old.constants == ((InterfaceConstant("B", "string", "x # y"),),)
