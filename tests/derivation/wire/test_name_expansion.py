"""Each row of the rules of names: what a node `n` in `/a` gets for what its program says, in both generations of ROS."""

from __future__ import annotations

import pytest

from archgen.derivation.wire.wire_names import expand_name, find_name_fault, find_node_name_fault

REFUSED = None


@pytest.mark.parametrize(
    ("written", "in_ros_2", "in_ros_1"),
    [
        ("x", "/a/x", "/a/x"),
        ("/x", "/x", "/x"),
        ("~/x", "/a/n/x", "/a/n/x"),
        ("~", "/a/n", "/a/n"),
        ("~x", "/a/nx", "/a/n/x"),  # by rcl as it runs; `find_name_fault` tells that nobody means it
        ("{node}/x", "/a/n/x", "/a/{node}/x"),
        ("/{node}/x", "/n/x", "/{node}/x"),
        ("{ns}/x", "/a/x", "/a/{ns}/x"),
        ("{namespace}/x", "/a/x", "/a/{namespace}/x"),
        ("x/{ns}", REFUSED, "/a/x/{ns}"),
        ("/{ns}/x", REFUSED, "/{ns}/x"),
        ("{foo}/x", REFUSED, "/a/{foo}/x"),
        ("a//b", REFUSED, "/a/a/b"),
        ("x/", REFUSED, "/a/x"),
        ("//x", REFUSED, "/x"),
        ("1a", REFUSED, "/a/1a"),
        ("a-b", REFUSED, "/a/a-b"),
        ("a b", REFUSED, "/a/a b"),
        ("a__b", "/a/a__b", "/a/a__b"),
        ("_x", "/a/_x", "/a/_x"),
        ("x_", "/a/x_", "/a/x_"),
        ("X", "/a/X", "/a/X"),
        ("", REFUSED, REFUSED),
        ("/", REFUSED, REFUSED),
    ],
)
def test_a_name_is_absolute_as_ros_makes_it(written: str, in_ros_2: str | None, in_ros_1: str | None) -> None:
    assert expand_name(written, "/a", "n", ros_1=False) == in_ros_2
    assert expand_name(written, "/a", "n", ros_1=True) == in_ros_1


@pytest.mark.parametrize(
    ("written", "name"),
    [("x", "/x"), ("~/x", "/n/x"), ("{ns}/x", REFUSED), ("{ns}x", "/x"), ("{node}/x", "/n/x"), ("~", "/n")],
)
def test_in_the_root_the_namespace_is_a_slash_of_its_own(written: str, name: str | None) -> None:
    assert expand_name(written, "/", "n", ros_1=False) == name


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("{ns}/x", None),
        ("x/{ns}", "the namespace begins with a `/` of its own, so that two `/` follow one another"),
        ("/{namespace}/x", "the namespace begins with a `/` of its own, so that two `/` follow one another"),
        ("{foo}/x", "it holds `{`, and only letters (a to z), digits and `_` are allowed"),
    ],
)
def test_braces_that_ros_2_refuses_are_faults(name: str, fault: str | None) -> None:
    assert find_name_fault(name) == fault


def test_ros_1_cleans_slashes_and_has_no_braces() -> None:
    assert find_name_fault("a//b", ros_1=True) is None
    assert find_name_fault("x/", ros_1=True) is None
    assert (
        find_name_fault("{node}/x", ros_1=True) == "it holds `{`, and only letters (a to z), digits and `_` are allowed"
    )


def test_a_node_has_no_slash_in_its_name() -> None:
    assert find_node_name_fault("a/b") == "it holds `/`: what stands before the name belongs into `namespace`"
    assert find_node_name_fault("n") is None
