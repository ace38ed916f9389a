"""Which values a parameter may have."""

from __future__ import annotations

import pytest

from archgen.model.parameter import Parameter, format_parameter
from archgen.model.parameter_values import canonical_name, find_value_fault, is_ros_parameter


@pytest.mark.parametrize(
    ("parameter", "value", "fault"),
    [
        (Parameter("p", type="float"), 1, None),
        (Parameter("p", type="float"), True, "`true` is no `float`"),
        (Parameter("p", type="float"), float("nan"), "`nan` is no `float`"),
        (Parameter("p", type="integer"), 1.0, "`1.0` is no `integer`"),
        (Parameter("p", type="integer"), True, "`true` is no `integer`"),
        (Parameter("p", type="string"), 3, "`3` is no `string`"),
        (Parameter("p", type="float"), "$(var x)", None),
        (Parameter("p", type="float[]"), [1, 2.5], None),
        (Parameter("p", type="float[]"), [], None),
        (Parameter("p", type="float[]"), 1, "`1` is no `float[]`"),
        (Parameter("p", type="string[]"), ["a", "$(var x)"], None),
        (Parameter("p", type="string[]"), ["a", ["b"]], "`[a, [b]]` is no `string[]`"),
        (Parameter("p", value=1), 1.5, None),
        (Parameter("p", value=1), "a", '`"a"` is no number'),
        (Parameter("p", value="$(find x)"), 1, None),
        (Parameter("p", value=[1, "a"]), [True], None),
        (Parameter("p", value=[]), "a", None),
        (Parameter("p", value=[True]), ["a"], "`[a]` is no list of booleans"),
        (Parameter("p", value="a", choices=("a", 3)), 3, None),
        (Parameter("p", choices=(1, 0)), True, "`true` is none of its choices: `1`, `0`"),
        (Parameter("p", choices=tuple("abcdefghij")), "x", "`x` is none of its choices: `a`, `b`, `c`, `d`, `e`, `f`, `g`, `h`, ..."),
        (Parameter("p", type="string[]", choices=("a", "b")), ["a", "c"], "`[a, c]` is none of its choices: `a`, `b`"),
        (Parameter("p", range=(0, 1.5)), 1.5, None),
        (Parameter("p", range=(0, float("inf"))), 10**30, None),
        (Parameter("p", type="float[]", range=(0, 1)), [0.5, 2], "`2` is outside of its range, `0` to `1`"),
        (Parameter("p"), {"a": 1}, None),
        (Parameter("p", type="float"), {"a": 1}, "`{a: 1}` is no `float`"),
        (Parameter("p", type="float"), None, None),
        (Parameter("p", type="float"), "`" * 100, '`"' + "'" * 59 + '…"` is no `float`'),
    ],
)  # fmt: skip
def test_a_value_is_of_its_type_in_its_range_and_among_its_choices(
    parameter: Parameter, value: object, fault: str | None
) -> None:
    assert find_value_fault(parameter, value) == fault


@pytest.mark.parametrize(
    ("name", "ros_1", "is_known"),
    [
        ("use_sim_time", False, True),
        ("qos_overrides./scan.publisher.depth", False, True),
        ("qos_overridesx", False, False),
        ("start_type_description_service", False, True),
        ("start_type_description_service", True, False),
        (".image_raw.compressed.jpeg_quality", False, True),
        ("camera.image_raw.enable_pub_plugins", False, True),
        ("tf_prefix", True, True),
        ("image.compressed.jpeg_quality", True, True),
        ("gain", False, False),
    ],
)
def test_what_ros_declares_itself_is_known(name: str, *, ros_1: bool, is_known: bool) -> None:
    assert is_ros_parameter(name, ros_1=ros_1) is is_known


def test_slashes_divide_names_in_ros_1_only() -> None:
    assert canonical_name("~a/b", ros_1=True) == "a.b"
    assert canonical_name("a/b", ros_1=False) == "a/b"


def test_values_are_written_as_yaml_writes_them() -> None:
    assert format_parameter({"a": [1, True, None], "b": "x"}) == "{a: [1, true, ], b: x}"
